#include "libdb/build/color_texel.h"

#include <algorithm>
#include <cmath>

#include "libdb/access/color.h"

namespace deltaz {

Texel storedTexel(const CoveredColor& color) {
  const double cover = std::clamp(color.cover, 0.0, 1.0);
  const auto code = static_cast<std::uint8_t>(std::floor(cover * 255 + 0.5));
  if (code == 0) return {};
  return {encodeSrgb(color.red / color.cover), encodeSrgb(color.green / color.cover),
          encodeSrgb(color.blue / color.cover), code};
}

Texel meanTexel(const Texel& sw, const Texel& se, const Texel& nw, const Texel& ne) {
  const unsigned total = unsigned{sw[3]} + se[3] + nw[3] + ne[3];
  const unsigned cover = (total + 2) / 4;
  if (cover == 0) return {};
  Texel mean{0, 0, 0, static_cast<std::uint8_t>(cover)};
  for (std::size_t band = 0; band < 3; ++band) {
    // Equal codes stay themselves, whatever the rounding of the sums.
    double sum = 0;
    for (const Texel* texel : {&sw, &se, &nw, &ne}) sum += (*texel)[3] * linearOfSrgb((*texel)[band]);
    mean[band] = encodeSrgb(sum / total);
  }
  return mean;
}

}  // namespace deltaz
