#include "tools/common/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <memory>

#include "formats/file_system.h"
#include "librender/scene/environment.h"
#include "tools/common/command_line.h"

namespace deltaz {

namespace {

// `name` only tells OpenImageIO which encoder to take; the bytes stay in memory.
Result<std::vector<std::byte>> encode(const std::string& name, const OIIO::ImageSpec& spec,
                                      const void* pixels) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) return internalError(name, "OpenImageIO cannot write this kind of file: " + OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(name, spec) ||
      !output->write_image(spec.format, pixels) || !output->close()) {
    return internalError(name, "OpenImageIO cannot encode it: " + output->geterror());
  }
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  return std::vector<std::byte>(begin, begin + bytes.size());
}

}  // namespace

Result<std::vector<std::byte>> encodePng(const Picture& picture) {
  OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Software", std::string("deltaz ") + toolVersion());
  return encode("picture.png", spec, picture.rgb.data());
}

Result<std::vector<std::byte>> encodeDepthTiff(const Picture& picture, const std::string& description) {
  OIIO::ImageSpec spec(picture.width, picture.height, 1, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("ImageDescription", description);
  spec.attribute("Software", std::string("deltaz ") + toolVersion());
  // Without a date OpenImageIO would put in today's.
  spec.attribute("DateTime", "1970:01:01 00:00:00");
  return encode("depth.tif", spec, picture.depth.data());
}

Result<PictureColors> readPicture(const std::string& path) {
  // Whether it can be read at all is the file system's to say.
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<ReadableFile> file, localFileSystem().open(path));
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input)
    return invalidError(IssueCode::kNone, path, "this is no picture", OIIO::geterror(), "Give a PNG file");
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.format != OIIO::TypeDesc::UINT8 || spec.nchannels != 3 || spec.width < 1 || spec.height < 1 ||
      spec.width > kLargestPicture || spec.height > kLargestPicture) {
    return invalidError(IssueCode::kNone, path, "its pixels are not red, green and blue of 8 bits", {},
                        "Give a picture that dbview wrote");
  }
  PictureColors picture{spec.width, spec.height, {}};
  picture.rgb.resize(3 * static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
  if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.rgb.data()))
    return invalidError(IssueCode::kNone, path, "the picture is damaged", input->geterror(),
                        "Write it again");
  return picture;
}

}  // namespace deltaz
