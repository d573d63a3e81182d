#include "librender/raster/depth_frame_buffer.h"

namespace deltaz {

DepthFrameBuffer::DepthFrameBuffer(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

}  // namespace deltaz
