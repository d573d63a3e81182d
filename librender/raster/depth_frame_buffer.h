// The depth/frame buffer: per pixel the nearest 1/U so far and which face it belongs to. Visibility is
// settled first; colours are computed once, afterwards.
//
// Depth is 1/U in single precision, nearer = larger; a strictly greater value wins, so that of equal ones the
// first submitted stays (report 4.1). Resolution U 2^-24. Thread-safety: different pixels from different
// threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace deltaz {

class DepthFrameBuffer {
 public:
  // Empty: 1/U = 0 everywhere.
  DepthFrameBuffer(int width, int height);

  struct Pixel {
    float inverse_u = 0;
    std::uint32_t node = 0, face = 0;  // index into the frame's nodes, and of the face in its node
    bool empty() const { return inverse_u == 0; }
  };

  int width() const { return width_; }
  int height() const { return height_; }
  const Pixel& at(int j, int i) const { return pixels_[index(j, i)]; }

  // True if the sample was nearer than what was there. Pre: inverse_u > 0.
  bool write(int j, int i, float inverse_u, std::uint32_t node, std::uint32_t face) {
    Pixel& pixel = pixels_[index(j, i)];
    if (!(inverse_u > pixel.inverse_u)) return false;
    pixel = {inverse_u, node, face};
    return true;
  }

 private:
  std::size_t index(int j, int i) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(j);
  }
  int width_, height_;
  std::vector<Pixel> pixels_;
};

}  // namespace deltaz
