// Pictures that materials of meshes refer to, through GDAL, and the mean colour of one under a triangle.
// Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"
#include "libdb/access/color.h"

namespace deltaz {

class MeshTexture {
 public:
  // PNG, JPEG and the like, from the bytes of such a file. kInvalid if they are none.
  static Result<MeshTexture> decode(std::span<const std::byte> bytes, const std::string& where);

  // The mean in linear light of the texels under a triangle of texture coordinates (u to the right, v
  // upwards, the picture repeated). Long triangles are sampled at kMostSteps steps a side.
  LinearColor mean(const std::array<std::array<double, 2>, 3>& corners) const;

 private:
  static constexpr int kMostSteps = 96;
  LinearColor texel(double u, double v) const;

  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> codes_;  // red, green, blue, row by row from the top
};

}  // namespace deltaz
