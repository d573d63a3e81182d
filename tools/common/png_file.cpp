#include "tools/common/png_file.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <png.h>

#include "formats/file_system.h"
#include "librender/scene/environment.h"
#include "tools/common/command_line.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1}
                                       << 30;  // more than the largest picture takes, packed or not
// Of filters and levels for drawn ground the smallest files in the shortest time.
constexpr int kCompressionLevel = 6;
constexpr int kRowFilters = PNG_FILTER_SUB;

// What libpng writes to and complains to. It is called from C, so nothing is thrown here.
struct Sink {
  std::vector<std::byte> bytes;
  std::array<char, 160> message{};
};

void appendBytes(png_structp png, png_bytep data, std::size_t count) {
  auto* const sink = static_cast<Sink*>(png_get_io_ptr(png));
  const std::byte* const begin = reinterpret_cast<const std::byte*>(data);
  bool done = true;
  try {
    sink->bytes.insert(sink->bytes.end(), begin, begin + count);
  } catch (...) {
    done = false;
  }
  if (!done) png_error(png, "out of memory");
}

void flushNothing(png_structp) {}

[[noreturn]] void leave(png_structp png, png_const_charp message) {
  auto* const sink = static_cast<Sink*>(png_get_error_ptr(png));
  const std::size_t length = std::min(std::strlen(message), sink->message.size() - 1);
  std::copy_n(message, length, sink->message.begin());
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

// libpng leaves by longjmp: no object with a destructor lives in here.
bool writeAll(png_structp png, png_infop info, const Picture& picture, const char* software) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const auto width = static_cast<png_uint_32>(picture.width),
             height = static_cast<png_uint_32>(picture.height);
  png_set_user_limits(png, std::max(width, 1u), std::max(height, 1u));
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_text text = {};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = const_cast<char*>("Software");
  text.text = const_cast<char*>(software);
  png_set_text(png, info, &text, 1);
  png_set_compression_level(png, kCompressionLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, kRowFilters);
  png_write_info(png, info);
  for (int row = 0; row < picture.height; ++row)
    png_write_row(png, picture.rgb.data() +
                           3 * static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width));
  png_write_end(png, info);
  return true;
}

// The reader that libpng has for whole pictures, which leaves by return values.
struct Reader {
  png_image image{};
  Reader() { image.version = PNG_IMAGE_VERSION; }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_image_free(&image); }
};

}  // namespace

Result<std::vector<std::byte>> encodePng(const Picture& picture) {
  Sink sink;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, leave, ignoreWarning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const std::string software = std::string("deltaz ") + toolVersion();
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &sink, appendBytes, flushNothing);
    written = writeAll(png, info, picture, software.c_str());
  }
  png_destroy_write_struct(&png, &info);
  if (!written)
    return internalError("picture.png", "libpng cannot encode it: " + std::string(sink.message.data()));
  return std::move(sink.bytes);
}

Result<PictureColors> readPng(const std::string& path) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(localFileSystem(), path, kLargestFile));
  Reader reader;
  if (png_image_begin_read_from_memory(&reader.image, bytes.data(), bytes.size()) == 0)
    return invalidError(IssueCode::kNone, path, "this is no picture", reader.image.message,
                        "Give a PNG file");
  const auto width = static_cast<std::size_t>(reader.image.width),
             height = static_cast<std::size_t>(reader.image.height);
  if (reader.image.format != PNG_FORMAT_RGB || width > kLargestPicture || height > kLargestPicture) {
    return invalidError(IssueCode::kNone, path, "its pixels are not red, green and blue of 8 bits", {},
                        "Give a picture that dbview wrote");
  }
  PictureColors picture{static_cast<int>(width), static_cast<int>(height),
                        std::vector<std::uint8_t>(3 * width * height)};
  if (png_image_finish_read(&reader.image, nullptr, picture.rgb.data(), 0, nullptr) == 0)
    return invalidError(IssueCode::kNone, path, "the picture is damaged", reader.image.message,
                        "Write it again");
  return picture;
}

}  // namespace deltaz
