#include "librender/ars/tiler/tiling_cursor.h"

namespace deltaz::ars {

TilingCursor::TilingCursor(const TilerSetup& setup, const NumberProfile& numbers)
    : setup_(setup),
      numbers_(&numbers),
      done_(false),
      i_(setup.i_start),
      j_(setup.j_start),
      p_(setup.p_start),
      p_save_(setup.p_start) {}

std::optional<PixelPacket> TilingCursor::sample() {
  ++sampled_;
  const bool valid = p_[0] >= 0 && p_[1] >= 0 && p_[2] >= 0;  // E0
  std::optional<PixelPacket> packet;
  if (valid) {
    ++tiled_;
    if (!line_has_valid_) {
      line_has_valid_ = true;
      first_pixel_ = pixel_;
      p_save_ = p_;
      saved_displacement_ = pixel_displacement_;
    }
    const PixelValues values =
        ProfileAccumulator(setup_, *numbers_).values(line_displacement_, pixel_displacement_);
    packet = PixelPacket{.i = static_cast<std::uint16_t>(i_),
                         .j = static_cast<std::uint16_t>(j_),
                         .color = values.color,
                         .background = setup_.background,
                         .depth = values.depth};
  }
  if (pixel_ == setup_.pixels || (before_valid_ && !valid)) {
    nextLine();
  } else {
    before_valid_ = valid;
    nextPixel();
  }
  return packet;
}

void TilingCursor::nextPixel() {
  ++pixel_;
  j_ += setup_.j_step;
  for (std::size_t k = 0; k < 3; ++k) p_[k] += setup_.p_pixel[k];
  pixel_displacement_.depth += setup_.depth.pixel;
  pixel_displacement_.color += setup_.color.pixel;
  pixel_displacement_.color_over_depth += setup_.color_over_depth.pixel;
}

void TilingCursor::nextLine() {
  if (line_ == setup_.lines) {
    done_ = true;
    return;
  }
  ++line_;
  i_ += setup_.i_step;
  pixel_ = first_pixel_;
  j_ = setup_.j_start + first_pixel_ * setup_.j_step;
  for (std::size_t k = 0; k < 3; ++k) p_save_[k] += setup_.p_line[k];
  p_ = p_save_;
  pixel_displacement_ = saved_displacement_;
  line_displacement_.depth += setup_.depth.line;
  line_displacement_.color += setup_.color.line;
  line_displacement_.color_over_depth += setup_.color_over_depth.line;
  before_valid_ = line_has_valid_ = false;
}

}  // namespace deltaz::ars
