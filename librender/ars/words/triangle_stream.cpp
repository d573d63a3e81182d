#include "librender/ars/words/triangle_stream.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <new>
#include <tuple>

#include "formats/bytes.h"
#include "formats/hash.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'D', 'Z', 'T', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kHeaderBytes = 64, kChecksumBytes = 8, kBatchBytes = 16;
constexpr std::size_t kTriangleBytes = sizeof(TriangleWords), kSourceBytes = sizeof(double) * 4 * 3;
constexpr std::uint16_t kSourcesFeature = 1;
constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 32;

Error invalid(const std::string& where, const char* what, const char* why = "") {
  return invalidError(IssueCode::kNone, where, what, why, "Record the stream anew");
}

auto orderOf(const TriangleBatch& batch) {
  return std::make_tuple(batch.sub_image, batch.pass, batch.phase);
}

bool isFinite(const ProjectedTriangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [](const ProjectedVertex& v) {
    return std::isfinite(v.i) && std::isfinite(v.j) && std::isfinite(v.depth) && std::isfinite(v.color);
  });
}

// What writer and reader both hold a stream to; kInvalid.
Status checkStream(const TriangleStream& stream, const std::string& where) {
  if (stream.picture_width < 1 || stream.picture_width > kLargestPicture || stream.picture_height < 1 ||
      stream.picture_height > kLargestPicture)
    return invalid(where, "the picture size is out of range", "Sides are 1 to 16384 pixels");
  if (stream.passes < 1 || stream.passes > kLargestPassCount)
    return invalid(where, "there are no such passes", "1 to 3");
  if (const Status profile = checkNumberProfile(stream.profile); !profile.ok())
    return invalid(where, "the number formats are out of range", profile.error().what.c_str());
  if (!stream.profile.fitsTriangleWords())
    return invalid(where, "the number formats do not fit the words", "Words have Table 8's widths");
  const auto parts = static_cast<std::uint32_t>(subImageCount(stream.picture_width, stream.picture_height));
  for (std::size_t b = 0; b < stream.batches.size(); ++b) {
    const TriangleBatch& batch = stream.batches[b];
    const std::string batch_where = fmt::format("{}, batch {}", where, b);
    if (batch.sub_image >= parts) return invalid(batch_where, "there is no such sub-image");
    if (batch.pass >= stream.passes) return invalid(batch_where, "there is no such pass");
    if (batch.phase > DrawPhase::kOverlay) return invalid(batch_where, "there is no such phase");
    if (b > 0 && orderOf(stream.batches[b - 1]) >= orderOf(batch))
      return invalid(batch_where, "batches are out of order",
                     "They follow by sub-image, pass and phase, each once");
    if (batch.sources.size() != (stream.has_sources ? batch.triangles.size() : 0))
      return invalid(batch_where, "words and projected triangles differ in number");
    for (std::size_t t = 0; t < batch.triangles.size(); ++t) {
      const bool sound = (batch.triangles[t][3] & kUnstatedBits) == 0 &&
                         isTileable(decodeTriangleWords(batch.triangles[t], stream.profile),
                                    stream.profile.vertex_fraction_bits);
      if (sound && (!stream.has_sources || isFinite(batch.sources[t]))) continue;
      // Names are only made for what is refused.
      const std::string triangle_where = fmt::format("{}, triangle {}", batch_where, t);
      DELTAZ_TRY(checkTriangleWords(batch.triangles[t], stream.profile, triangle_where));
      return invalid(triangle_where, "a projected vertex is no finite number");
    }
  }
  return Success{};
}

template <typename Enumeration>
void putEnumeration(ByteWriter& out, Enumeration value) {
  out.put(static_cast<std::uint8_t>(value));
}

void putFloatForms(ByteWriter& out, const FloatFormat& format) {
  putEnumeration(out, format.leading_one);
  putEnumeration(out, format.exponent_sign);
  putEnumeration(out, format.mantissa_sign);
}

void putProfile(ByteWriter& out, const NumberProfile& profile) {
  putEnumeration(out, profile.fixed_point_sign);
  putFloatForms(out, profile.color);
  putFloatForms(out, profile.depth_plane);
  out.put(static_cast<std::uint8_t>(profile.dot_product_fraction_bits));
  out.put(static_cast<std::uint8_t>(profile.depth.exponent_bits));
  out.put(static_cast<std::uint8_t>(profile.depth.mantissa_bits));
  putEnumeration(out, profile.depth.leading_one);
  out.put(static_cast<std::int16_t>(profile.depth.exponent_bias));
  out.put(static_cast<std::uint8_t>(profile.color_accumulator_bits));
  out.put(static_cast<std::uint8_t>(profile.depth_accumulator_bits));
  putEnumeration(out, profile.arithmetic);
  putEnumeration(out, profile.output);
}

// Reads one of two forms and remembers whether any was neither.
class FormReader {
 public:
  explicit FormReader(ByteReader& in) : in_(in) {}
  template <typename Enumeration>
  void get(Enumeration& value) {
    const auto byte = in_.get<std::uint8_t>();
    known_ = known_ && byte <= 1;
    value = static_cast<Enumeration>(byte & 1);
  }
  void get(FloatFormat& format) {
    get(format.leading_one);
    get(format.exponent_sign);
    get(format.mantissa_sign);
  }
  bool known() const { return known_; }

 private:
  ByteReader& in_;
  bool known_ = true;
};

Result<NumberProfile> getProfile(ByteReader& in, const std::string& where) {
  NumberProfile profile;
  FormReader forms(in);
  forms.get(profile.fixed_point_sign);
  forms.get(profile.color);
  forms.get(profile.depth_plane);
  profile.dot_product_fraction_bits = in.get<std::uint8_t>();
  profile.depth.exponent_bits = in.get<std::uint8_t>();
  profile.depth.mantissa_bits = in.get<std::uint8_t>();
  forms.get(profile.depth.leading_one);
  profile.depth.exponent_bias = in.get<std::int16_t>();
  profile.color_accumulator_bits = in.get<std::uint8_t>();
  profile.depth_accumulator_bits = in.get<std::uint8_t>();
  forms.get(profile.arithmetic);
  forms.get(profile.output);
  if (!forms.known()) return invalid(where, "a number format has an unknown form", "Forms are 0 or 1");
  return profile;
}

struct Counts {
  std::uint64_t triangles = 0;
  std::uint32_t batches = 0;
};

Result<Counts> getHeader(ByteReader in, TriangleStream& stream, const std::string& where) {
  for (const std::uint8_t byte : kMagic) {
    if (in.get<std::uint8_t>() != byte) return invalid(where, "this is no recorded triangle stream");
  }
  const auto version = in.get<std::uint16_t>();
  if (version > kTriangleStreamVersion)
    return newerFormatError(IssueCode::kNone, where, fmt::format("the stream has version {}", version),
                            "Use a newer version of deltaz");
  const auto features = in.get<std::uint16_t>();
  const auto width = in.get<std::uint32_t>(), height = in.get<std::uint32_t>();
  stream.passes = in.get<std::uint8_t>();
  DELTAZ_TRY_ASSIGN(stream.profile, getProfile(in, where));
  const auto reserved = in.get<std::uint16_t>();
  Counts counts;
  counts.triangles = in.get<std::uint64_t>();
  counts.batches = in.get<std::uint32_t>();
  if (version < 1 || (features & ~kSourcesFeature) != 0 || reserved != 0 || in.get<std::uint32_t>() != 0)
    return invalid(where, "a field of the header has an unknown value");
  if (width > kLargestPicture || height > kLargestPicture)
    return invalid(where, "the picture size is out of range", "Sides are 1 to 16384 pixels");
  stream.has_sources = features == kSourcesFeature;
  stream.picture_width = static_cast<int>(width);
  stream.picture_height = static_cast<int>(height);
  return counts;
}

// The caller has checked that all batches and triangles are there in number; a batch may still claim more
// than are left.
Status getBatches(ByteReader in, const Counts& counts, TriangleStream& stream, const std::string& where) {
  const std::size_t each = kTriangleBytes + (stream.has_sources ? kSourceBytes : 0);
  stream.batches.reserve(counts.batches);
  for (std::uint32_t b = 0; b < counts.batches; ++b) {
    const std::size_t later = (counts.batches - b) * kBatchBytes;
    if (in.remaining() < later) return invalid(where, "batches have more triangles than the header says");
    TriangleBatch batch;
    batch.sub_image = in.get<std::uint32_t>();
    batch.pass = in.get<std::uint8_t>();
    batch.phase = static_cast<DrawPhase>(in.get<std::uint8_t>());
    const auto reserved = in.get<std::uint16_t>();
    const std::size_t triangles = in.get<std::uint32_t>();
    if (reserved != 0 || in.get<std::uint32_t>() != 0)
      return invalid(where, fmt::format("batch {} has an unknown field", b).c_str());
    if (triangles > in.remaining() / each)
      return invalid(where, "batches have more triangles than the header says");
    batch.triangles.resize(triangles);
    for (TriangleWords& words : batch.triangles) {
      for (std::uint32_t& word : words) word = in.get<std::uint32_t>();
    }
    batch.sources.resize(stream.has_sources ? triangles : 0);
    for (ProjectedTriangle& source : batch.sources) {
      for (ProjectedVertex& vertex : source) {
        for (double* value : {&vertex.i, &vertex.j, &vertex.depth, &vertex.color}) *value = in.get<double>();
      }
    }
    stream.batches.push_back(std::move(batch));
  }
  if (in.remaining() != 0) return invalid(where, "batches have fewer triangles than the header says");
  return Success{};
}

}  // namespace

int subImagesAcross(int picture_width) {
  return (picture_width + kScreenPixels - 1) / kScreenPixels;
}

int subImageCount(int picture_width, int picture_height) {
  return subImagesAcross(picture_width) * ((picture_height + kScreenLines - 1) / kScreenLines);
}

SubImageOrigin subImageOrigin(std::uint32_t sub_image, int picture_width) {
  const int across = subImagesAcross(picture_width), part = static_cast<int>(sub_image);
  return {.i = part / across * kScreenLines, .j = part % across * kScreenPixels};
}

Result<std::vector<std::byte>> encodeTriangleStream(const TriangleStream& stream) {
  if (const Status sound = checkStream(stream, "triangle stream"); !sound.ok()) {
    Error error = sound.error();
    error.kind = ErrorKind::kUsage;
    return error;
  }
  std::uint64_t triangles = 0;
  for (const TriangleBatch& batch : stream.batches) triangles += batch.triangles.size();

  ByteWriter out;
  for (const std::uint8_t byte : kMagic) out.put(byte);
  out.put(kTriangleStreamVersion);
  out.put(static_cast<std::uint16_t>(stream.has_sources ? kSourcesFeature : 0));
  out.put(static_cast<std::uint32_t>(stream.picture_width));
  out.put(static_cast<std::uint32_t>(stream.picture_height));
  out.put(static_cast<std::uint8_t>(stream.passes));
  putProfile(out, stream.profile);
  out.putZeros(2);
  out.put(triangles);
  out.put(static_cast<std::uint32_t>(stream.batches.size()));
  out.putZeros(4);
  out.put(hash64(out.view()));
  for (const TriangleBatch& batch : stream.batches) {
    out.put(batch.sub_image);
    out.put(batch.pass);
    putEnumeration(out, batch.phase);
    out.putZeros(2);
    out.put(static_cast<std::uint32_t>(batch.triangles.size()));
    out.putZeros(4);
    for (const TriangleWords& words : batch.triangles) {
      for (const std::uint32_t word : words) out.put(word);
    }
    for (const ProjectedTriangle& source : batch.sources) {
      for (const ProjectedVertex& vertex : source) {
        for (const double value : {vertex.i, vertex.j, vertex.depth, vertex.color}) out.put(value);
      }
    }
  }
  out.put(hash64(out.view().subspan(kHeaderBytes)));
  return out.take();
}

Result<TriangleStream> decodeTriangleStream(std::span<const std::byte> bytes, const std::string& where) {
  if (bytes.size() < kHeaderBytes + kChecksumBytes)
    return invalid(where, "this is no recorded triangle stream", "It is too short");
  TriangleStream stream;
  DELTAZ_TRY_ASSIGN(const Counts counts, getHeader(ByteReader(bytes), stream, where));
  if (hash64(bytes.first(kHeaderBytes - kChecksumBytes)) !=
      loadLittleEndian<std::uint64_t>(bytes, kHeaderBytes - kChecksumBytes))
    return invalid(where, "the header does not match its checksum",
                   "The bytes were changed after they were written");

  const std::uint64_t each = kTriangleBytes + (stream.has_sources ? kSourceBytes : 0);
  const std::uint64_t rest = bytes.size() - kHeaderBytes - kChecksumBytes;
  if (counts.triangles > rest / each || counts.batches > rest / kBatchBytes ||
      counts.triangles * each + counts.batches * kBatchBytes != rest)
    return invalid(where, "the file is not as long as its header says", "It may have been cut off");
  const std::span<const std::byte> body = bytes.subspan(kHeaderBytes, rest);
  if (hash64(body) != loadLittleEndian<std::uint64_t>(bytes, bytes.size() - kChecksumBytes))
    return invalid(where, "the triangles do not match their checksum",
                   "The bytes were changed after they were written");
  try {
    DELTAZ_TRY(getBatches(ByteReader(body), counts, stream, where));
  } catch (const std::bad_alloc&) {
    return accessError(where, "there is not enough memory for the triangles");
  }
  DELTAZ_TRY(checkStream(stream, where));
  return stream;
}

Status writeTriangleStream(const FileSystem& files, const std::string& path, const TriangleStream& stream) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, encodeTriangleStream(stream));
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<WritableFile> file, files.create(path));
  Status written = file->append(bytes);
  if (written.ok()) written = file->sync();
  const Status closed = file->close();
  if (written.ok()) written = closed;
  // Half a stream is of no use, and would stand in the way of the next.
  if (!written.ok()) (void)files.removeFile(path);
  return written;
}

Result<TriangleStream> readTriangleStream(const FileSystem& files, const std::string& path) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(files, path, kLargestFile));
  return decodeTriangleStream(bytes, path);
}

}  // namespace deltaz::ars
