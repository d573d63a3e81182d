// Recorded triangle streams: what the hardware-software interface would send for a frame, captured once and
// replayed into any configuration. The bytes are specified in triangle_stream.md.
//
// A stream is a list of batches. Between two batches the machine drains: every pixel of one has reached its
// memory before the first of the next leaves a tiler. So background is there before the foreground, and the
// foreground before overlays. Words can be replayed in any machine of Table 8's widths; with the projected
// triangles beside them they can be encoded again in other widths. Thread-safety: plain values; the functions
// may be called from several threads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/file_system.h"
#include "librender/ars/words/number_profile.h"
#include "librender/ars/words/projected_triangle.h"
#include "librender/ars/words/triangle_words.h"

namespace deltaz::ars {

inline constexpr std::uint16_t kTriangleStreamVersion = 1;
inline constexpr int kLargestPicture = 16384;  // pixels a side
inline constexpr int kLargestPassCount = 3;

enum class DrawPhase : std::uint8_t { kBackground, kForeground, kOverlay };

struct TriangleBatch {
  std::uint32_t sub_image = 0;  // see subImageOrigin
  std::uint8_t pass = 0;        // which primary, below passes
  DrawPhase phase = DrawPhase::kForeground;
  std::vector<TriangleWords> triangles;
  std::vector<ProjectedTriangle> sources;  // none, or those of the triangles, in the sub-image's coordinates
};

struct TriangleStream {
  int picture_width = 512, picture_height = 512;  // pixels
  int passes = 1;         // a picture in colour takes three: the machine has one colour word a pixel
  NumberProfile profile;  // of the words; fits them
  bool has_sources = false;
  std::vector<TriangleBatch> batches;  // by sub-image, then pass, then phase; each at most once
};

// A picture larger than the machine's 512 x 512 is drawn in parts, from left to right and from top to bottom.
int subImagesAcross(int picture_width);
int subImageCount(int picture_width, int picture_height);
struct SubImageOrigin {
  int i = 0, j = 0;
};
SubImageOrigin subImageOrigin(std::uint32_t sub_image, int picture_width);

// kUsage for a stream that readers would refuse.
Result<std::vector<std::byte>> encodeTriangleStream(const TriangleStream& stream);
// Safe on any bytes; refuses all that encodeTriangleStream does not write. kInvalid, or kNewerFormat. `where`
// names the bytes.
Result<TriangleStream> decodeTriangleStream(std::span<const std::byte> bytes, const std::string& where);

// An existing file is not replaced (kUsage).
Status writeTriangleStream(const FileSystem& files, const std::string& path, const TriangleStream& stream);
Result<TriangleStream> readTriangleStream(const FileSystem& files, const std::string& path);

}  // namespace deltaz::ars
