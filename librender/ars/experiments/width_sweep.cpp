#include "librender/ars/experiments/width_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {

namespace {

// A triangle as it came, and which pixels it covers, its edges included.
class ExactTriangle {
 public:
  explicit ExactTriangle(const ProjectedTriangle& triangle) : v_(triangle) {
    const double area = edge(0, v_[2].i, v_[2].j);
    sign_ = area < 0 ? -1 : 1;
  }
  bool covers(int i, int j) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (sign_ * edge(k, i, j) < 0) return false;
    }
    return true;
  }
  std::int64_t coveredPixels() const {
    const auto [i_least, i_greatest] = std::minmax({v_[0].i, v_[1].i, v_[2].i});
    const auto [j_least, j_greatest] = std::minmax({v_[0].j, v_[1].j, v_[2].j});
    std::int64_t count = 0;
    for (int i = static_cast<int>(std::ceil(i_least)); i <= i_greatest; ++i) {
      for (int j = static_cast<int>(std::ceil(j_least)); j <= j_greatest; ++j) count += covers(i, j) ? 1 : 0;
    }
    return count;
  }

 private:
  double edge(std::size_t k, double i, double j) const {
    const ProjectedVertex &a = v_[k], &b = v_[(k + 1) % 3];
    return (b.i - a.i) * (j - a.j) - (b.j - a.j) * (i - a.i);
  }
  const ProjectedTriangle& v_;
  double sign_ = 1;
};

// One width and how a profile gets it.
struct Width {
  const char* name;
  NumberProfile (*with)(NumberProfile profile, int bits);
  int table_8;
  std::initializer_list<int> bits;
};

}  // namespace

FormatError measureFormats(std::span<const ProjectedTriangle> triangles, const NumberProfile& numbers) {
  const TilerConfiguration configuration{.numbers = numbers, .corrections = {}};
  std::vector<PixelPacket> pixels;
  std::int64_t exact = 0, both = 0, extra = 0;
  FormatError error;
  double depth_sum = 0, color_sum = 0;
  for (const ProjectedTriangle& triangle : triangles) {
    const ExactTriangle exact_triangle(triangle);
    const TrianglePlanes planes = planesOf(triangle, 0);
    const TriangleVariables variables = encodeTriangle(triangle, planes, numbers, {}).variables;
    pixels.clear();
    tileTriangle(setUpTriangle(variables, configuration), numbers, pixels);
    exact += exact_triangle.coveredPixels();
    for (const PixelPacket& pixel : pixels) {
      if (!exact_triangle.covers(pixel.i, pixel.j)) {
        ++extra;
        continue;
      }
      ++both;
      const double di = pixel.i - planes.i, dj = pixel.j - planes.j, depth = planes.depth.at(di, dj);
      const double depth_off = std::abs(numbers.depth.decode(pixel.depth) / depth - 1);
      const double color_off = std::abs(pixel.color - planes.color.at(di, dj));
      depth_sum += depth_off;
      color_sum += color_off;
      error.depth_largest = std::max(error.depth_largest, depth_off);
      error.color_largest = std::max(error.color_largest, color_off);
    }
  }
  const auto share = [](double part, std::int64_t whole) {
    return whole == 0 ? 0 : part / static_cast<double>(whole);
  };
  error.extra = 100 * share(static_cast<double>(extra), exact);
  error.missing = 100 * share(static_cast<double>(exact - both), exact);
  error.depth_mean = share(depth_sum, both);
  error.color_mean = share(color_sum, both);
  return error;
}

std::vector<WidthPoint> sweepWidths(std::span<const ProjectedTriangle> triangles,
                                    const NumberProfile& numbers) {
  const std::array<Width, 4> widths{{{"vertex fraction",
                                      withVertexFractionBits,
                                      kVertexFormat.fraction_bits,
                                      {0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12}},
                                     {"colour mantissa",
                                      withColorMantissaBits,
                                      kColorFormat.mantissa_bits,
                                      {4, 5, 6, 7, 8, 9, 10, 11, 12, 14, 16}},
                                     {"plane mantissa",
                                      withPlaneMantissaBits,
                                      kDepthPlaneFormat.mantissa_bits,
                                      {8, 10, 12, 14, 16, 18, 20, 22, 24}},
                                     {"depth mantissa",
                                      withDepthMantissaBits,
                                      DepthFormat{}.mantissa_bits,
                                      {3, 7, 11, 13, 15, 17, 19, 21, 23, 27}}}};
  std::vector<WidthPoint> points;
  for (const Width& width : widths) {
    for (const int bits : width.bits) {
      const NumberProfile profile = width.with(numbers, bits);
      points.push_back({.width = width.name,
                        .bits = bits,
                        .table_8 = bits == width.table_8,
                        .triangle_bits = triangleBits(profile),
                        .pixel_bits = pixelBits(profile),
                        .error = measureFormats(triangles, profile)});
    }
  }
  return points;
}

}  // namespace deltaz::ars
