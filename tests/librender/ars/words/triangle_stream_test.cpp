#include "librender/ars/words/triangle_stream.h"

#include <gtest/gtest.h>
#include <limits>

#include "formats/hash.h"
#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "tests/librender/ars/tiler/mixed_triangles.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/memory_file_system.h"

namespace deltaz::ars {
namespace {

// Two sub-images, three passes, all phases.
TriangleStream exampleStream(bool sources) {
  TriangleStream stream;
  stream.picture_width = 700;
  stream.picture_height = 300;
  stream.passes = 3;
  stream.has_sources = sources;
  stream.profile.depth.exponent_bias = 29;
  stream.profile.arithmetic = Rounding::kTruncate;
  stream.profile.color.mantissa_sign = SignForm::kTwosComplement;
  RandomNumbers random(3);
  for (const std::uint32_t part : {0u, 1u}) {
    for (std::uint8_t pass = 0; pass < 3; ++pass) {
      for (const DrawPhase phase : {DrawPhase::kBackground, DrawPhase::kForeground, DrawPhase::kOverlay}) {
        TriangleBatch batch;
        batch.sub_image = part;
        batch.pass = pass;
        batch.phase = phase;
        for (int n = 0; n < 5; ++n) {
          const ProjectedTriangle triangle = mixedTriangle(random);
          const bool background = phase != DrawPhase::kForeground;
          const EncodedTriangle encoded =
              encodeTriangle(triangle, stream.profile, {.background = background});
          batch.triangles.push_back(encodeTriangleWords(encoded.variables, stream.profile));
          if (sources) batch.sources.push_back(triangle);
        }
        stream.batches.push_back(batch);
      }
    }
  }
  return stream;
}

void expectEqual(const TriangleStream& a, const TriangleStream& b) {
  EXPECT_EQ(a.picture_width, b.picture_width);
  EXPECT_EQ(a.picture_height, b.picture_height);
  EXPECT_EQ(a.passes, b.passes);
  EXPECT_EQ(a.profile, b.profile);
  EXPECT_EQ(a.has_sources, b.has_sources);
  ASSERT_EQ(a.batches.size(), b.batches.size());
  for (std::size_t n = 0; n < a.batches.size(); ++n) {
    EXPECT_EQ(a.batches[n].sub_image, b.batches[n].sub_image);
    EXPECT_EQ(a.batches[n].pass, b.batches[n].pass);
    EXPECT_EQ(a.batches[n].phase, b.batches[n].phase);
    EXPECT_EQ(a.batches[n].triangles, b.batches[n].triangles);
    EXPECT_EQ(a.batches[n].sources, b.batches[n].sources);
  }
}

void seal(std::vector<std::byte>& bytes) {
  const auto put = [&](std::size_t at, std::uint64_t hash) {
    for (std::size_t k = 0; k < 8; ++k) bytes[at + k] = static_cast<std::byte>(hash >> (8 * k) & 0xFF);
  };
  const std::span<const std::byte> all = bytes;
  put(56, hash64(all.first(56)));
  put(bytes.size() - 8, hash64(all.subspan(64, bytes.size() - 72)));
}

TEST(TriangleStream, comes_back_with_and_without_sources) {
  for (const bool sources : {false, true}) {
    const TriangleStream stream = exampleStream(sources);
    const auto bytes = encodeTriangleStream(stream);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message();
    EXPECT_EQ(bytes.value().size(), 64 + 18 * 16 + 90 * (sources ? 128 : 32) + 8u);
    const auto back = decodeTriangleStream(bytes.value(), "stream");
    ASSERT_TRUE(back.ok()) << back.error().message();
    expectEqual(back.value(), stream);
  }
}

TEST(TriangleStream, an_empty_stream_comes_back) {
  const auto bytes = encodeTriangleStream(TriangleStream{});
  ASSERT_TRUE(bytes.ok());
  const auto back = decodeTriangleStream(bytes.value(), "stream");
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(back.value().batches.empty());
}

TEST(TriangleStream, every_changed_bit_and_every_cut_is_refused) {
  const std::vector<std::byte> sound = encodeTriangleStream(exampleStream(true)).value();
  std::vector<std::byte> bytes = sound;
  for (std::size_t at = 0; at < bytes.size(); at += bytes.size() < 100 || at < 400 ? 1 : 7) {
    const auto bit = static_cast<std::byte>(1u << at % 8);
    bytes[at] ^= bit;
    EXPECT_FALSE(decodeTriangleStream(bytes, "stream").ok()) << "byte " << at;
    bytes[at] ^= bit;
  }
  for (std::size_t length = 0; length < sound.size(); length += 13) {
    EXPECT_FALSE(decodeTriangleStream(std::span(sound).first(length), "stream").ok()) << length << " bytes";
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decodeTriangleStream(bytes, "stream").ok());
}

// Under right checksums.
TEST(TriangleStream, unknown_values_are_refused_with_their_place) {
  const std::vector<std::byte> sound = encodeTriangleStream(exampleStream(true)).value();
  const auto refusal = [&](std::size_t at, unsigned value, std::size_t width = 1) {
    std::vector<std::byte> bytes = sound;
    for (std::size_t k = 0; k < width; ++k) bytes[at + k] = static_cast<std::byte>(value >> 8 * k & 0xFF);
    seal(bytes);
    const auto stream = decodeTriangleStream(bytes, "stream");
    return stream.ok() ? std::string() : stream.error().message();
  };
  EXPECT_EQ(refusal(21, 1), "");  // two's complement, as it was
  EXPECT_NE(refusal(8, 2).find("version 2"), std::string::npos);
  EXPECT_NE(refusal(8, 0).find("header"), std::string::npos);
  EXPECT_NE(refusal(10, 3).find("header"), std::string::npos);
  EXPECT_NE(refusal(14, 1).find("picture size"), std::string::npos);
  EXPECT_NE(refusal(20, 4).find("passes"), std::string::npos);
  EXPECT_NE(refusal(20, 2).find("batch 6"), std::string::npos);
  EXPECT_NE(refusal(28, 14).find("number formats"), std::string::npos);
  EXPECT_NE(refusal(37, 2).find("form"), std::string::npos);
  EXPECT_NE(refusal(38, 1).find("header"), std::string::npos);
  EXPECT_NE(refusal(64, 1).find("batch 1"), std::string::npos);  // out of order
  EXPECT_NE(refusal(64, 2).find("batch 0"), std::string::npos);  // no such sub-image
  EXPECT_NE(refusal(69, 3).find("batch 0"), std::string::npos);  // no such phase
  EXPECT_NE(refusal(72, 200).find("header says"), std::string::npos);
  EXPECT_NE(refusal(80 + 15, 0xFF).find("batch 0, triangle 0"),
            std::string::npos);  // unstated bits of word 4
  EXPECT_NE(refusal(80 + 5 * 32 + 6, 0x7FF0, 2).find("batch 0, triangle 0: a projected vertex"),
            std::string::npos);
}

TEST(TriangleStream, newer_versions_are_told_from_damage) {
  std::vector<std::byte> bytes = encodeTriangleStream(exampleStream(false)).value();
  bytes[8] = std::byte{2};
  EXPECT_EQ(decodeTriangleStream(bytes, "stream").error().kind, ErrorKind::kNewerFormat);
}

TEST(TriangleStream, writer_refuses_what_readers_would) {
  const auto refused = [](const TriangleStream& stream) {
    const auto bytes = encodeTriangleStream(stream);
    return !bytes.ok() && bytes.error().kind == ErrorKind::kUsage;
  };
  TriangleStream stream = exampleStream(true);
  stream.batches[3].sources.pop_back();
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(true);
  stream.batches[3].sources[2][1].depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(false);
  std::swap(stream.batches[0], stream.batches[1]);
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(false);
  stream.batches[1] = stream.batches[0];
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(false);
  stream.profile = withVertexFractionBits(stream.profile, 5);
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(false);
  stream.batches[0].triangles[0][3] |= 1u << 31;
  EXPECT_TRUE(refused(stream));
  stream = exampleStream(false);
  stream.picture_width = 512;
  EXPECT_TRUE(refused(stream));
}

TEST(TriangleStream, larger_pictures_are_cut_into_parts) {
  EXPECT_EQ(subImageCount(512, 512), 1);
  EXPECT_EQ(subImageCount(513, 512), 2);
  EXPECT_EQ(subImageCount(2048, 2048), 16);
  EXPECT_EQ(subImageOrigin(5, 2048).i, 512);
  EXPECT_EQ(subImageOrigin(5, 2048).j, 512);
}

TEST(TriangleStream, files_come_back_and_are_not_replaced) {
  MemoryFileSystem files;
  const TriangleStream stream = exampleStream(true);
  ASSERT_TRUE(files.makeDirectory("folder").ok());
  ASSERT_TRUE(writeTriangleStream(files, "folder/frame.dzt", stream).ok());
  const auto back = readTriangleStream(files, "folder/frame.dzt");
  ASSERT_TRUE(back.ok()) << back.error().message();
  expectEqual(back.value(), stream);
  EXPECT_FALSE(writeTriangleStream(files, "folder/frame.dzt", stream).ok());
  EXPECT_TRUE(readTriangleStream(files, "folder/frame.dzt").ok());
  EXPECT_EQ(readTriangleStream(files, "folder/none.dzt").error().kind, ErrorKind::kCannotAccess);
}

}  // namespace
}  // namespace deltaz::ars
