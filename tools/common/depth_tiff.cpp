#include "tools/common/depth_tiff.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <tiffio.h>

#include "tools/common/command_line.h"

namespace deltaz {

namespace {

// A file in memory, as libtiff writes one: places written to may lie before the end. It is called from C, so
// nothing is thrown here.
struct MemoryFile {
  std::vector<std::byte> bytes;
  std::size_t place = 0;
  std::array<char, 160> message{};
};

tmsize_t readBytes(thandle_t handle, void* out, tmsize_t count) {
  auto* const file = static_cast<MemoryFile*>(handle);
  const std::size_t left = file->bytes.size() - std::min(file->place, file->bytes.size());
  const std::size_t taken = std::min(static_cast<std::size_t>(count), left);
  if (taken > 0) std::memcpy(out, file->bytes.data() + file->place, taken);
  file->place += taken;
  return static_cast<tmsize_t>(taken);
}

tmsize_t writeBytes(thandle_t handle, void* data, tmsize_t count) {
  auto* const file = static_cast<MemoryFile*>(handle);
  const std::size_t end = file->place + static_cast<std::size_t>(count);
  try {
    if (end > file->bytes.size()) file->bytes.resize(end);
  } catch (...) {
    return -1;
  }
  if (count > 0) std::memcpy(file->bytes.data() + file->place, data, static_cast<std::size_t>(count));
  file->place = end;
  return count;
}

toff_t seek(thandle_t handle, toff_t offset, int whence) {
  auto* const file = static_cast<MemoryFile*>(handle);
  const toff_t base = whence == SEEK_CUR ? file->place : whence == SEEK_END ? file->bytes.size() : 0;
  file->place = static_cast<std::size_t>(base + offset);
  return file->place;
}

int closeNothing(thandle_t) {
  return 0;
}

toff_t sizeOf(thandle_t handle) {
  return static_cast<MemoryFile*>(handle)->bytes.size();
}

int keepMessage(TIFF*, void* file, const char*, const char* format, va_list arguments) {
  auto& message = static_cast<MemoryFile*>(file)->message;
  std::vsnprintf(message.data(), message.size(), format, arguments);
  return 1;
}

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFCleanup(tiff); }
};
struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

// About 64 kB a strip, which readers take as a whole.
std::uint32_t rowsOfStrip(int width) {
  return static_cast<std::uint32_t>(std::max(1, (1 << 14) / std::max(width, 1)));
}

bool writeAll(TIFF* tiff, const Picture& picture, const std::string& description,
              const std::string& software) {
  const auto width = static_cast<std::uint32_t>(picture.width),
             height = static_cast<std::uint32_t>(picture.height);
  const std::uint32_t rows = rowsOfStrip(picture.width);
  bool done = TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width) == 1 &&
              TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height) == 1 &&
              TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32) == 1 &&
              TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) == 1 &&
              TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP) == 1 &&
              TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == 1 &&
              TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT) == 1 &&
              TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE) == 1 &&
              TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_FLOATINGPOINT) == 1 &&
              TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows) == 1 &&
              TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str()) == 1 &&
              TIFFSetField(tiff, TIFFTAG_SOFTWARE, software.c_str()) == 1;
  std::vector<float> strip(static_cast<std::size_t>(rows) * width);
  for (std::uint32_t row = 0, index = 0; done && row < height; row += rows, ++index) {
    // libtiff may change what it is given, so each strip is a copy.
    const std::size_t count = static_cast<std::size_t>(std::min(rows, height - row)) * width;
    std::copy_n(picture.depth.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * width), count,
                strip.begin());
    done =
        TIFFWriteEncodedStrip(tiff, index, strip.data(), static_cast<tmsize_t>(count * sizeof(float))) >= 0;
  }
  return done && TIFFWriteDirectory(tiff) == 1;
}

}  // namespace

Result<std::vector<std::byte>> encodeDepthTiff(const Picture& picture, const std::string& description) {
  MemoryFile file;
  const std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  bool written = false;
  if (options) {
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepMessage, &file);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keepMessage, &file);
    const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFClientOpenExt("depth.tif", "wl", &file, readBytes,
                                                                  writeBytes, seek, closeNothing, sizeOf,
                                                                  nullptr, nullptr, options.get()));
    written =
        tiff != nullptr && writeAll(tiff.get(), picture, description, std::string("deltaz ") + toolVersion());
  }
  if (!written)
    return internalError("depth.tif", "libtiff cannot encode it: " + std::string(file.message.data()));
  return std::move(file.bytes);
}

}  // namespace deltaz
