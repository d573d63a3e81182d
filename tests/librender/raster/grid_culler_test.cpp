#include "librender/raster/grid_culler.h"

#include <array>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

constexpr int kWidth = 300, kHeight = 200;
constexpr std::size_t kVertices = 250;

struct KeptFaces {
  std::vector<std::uint32_t> face, tiles;
  CullCounts counts;
};

struct RandomFaces {
  std::vector<std::int32_t> x, y;
  std::array<std::vector<std::uint8_t>, 3> corner;  // clockwise on the screen
  std::size_t count;

  explicit RandomFaces(std::size_t faces, std::mt19937& random) : count(faces) {
    std::uniform_int_distribution<std::int32_t> place(-70 * kSubPixels, 90 * kSubPixels);
    for (std::size_t n = 0; n < kVertices; ++n) {
      const bool before_hither = n % 50 == 0;
      x.push_back(before_hither ? kBeforeHitherCoordinate : place(random));
      y.push_back(before_hither ? kBeforeHitherCoordinate : place(random));
    }
    std::uniform_int_distribution<int> vertex(0, kVertices - 1);
    for (std::vector<std::uint8_t>& corners : corner) {
      for (std::size_t n = 0; n < faces; ++n) corners.push_back(static_cast<std::uint8_t>(vertex(random)));
      corners.resize(faces + kRowPadding);
    }
  }

  KeptFaces byBytes(std::size_t first, std::size_t faces) const {
    return kept(faces, [&](CulledFaces& out, CullCounts& counts) {
      cullIndexedFaces({corner[0].data() + first, corner[1].data() + first, corner[2].data() + first, faces,
                        x.data(), y.data()},
                       kWidth, kHeight, out, counts);
    });
  }

  // Words name corners the other way round.
  KeptFaces byWords() const {
    std::vector<std::uint32_t> words;
    for (std::size_t n = 0; n < count; ++n)
      words.insert(words.end(), {corner[0][n], corner[2][n], corner[1][n], 0xFFFFFFFF});
    return kept(count, [&](CulledFaces& out, CullCounts& counts) {
      cullCornerFaces({words.data(), count, x.data(), y.data()}, kWidth, kHeight, out, counts);
    });
  }

 private:
  template <class Cull>
  static KeptFaces kept(std::size_t faces, Cull cull) {
    KeptFaces result;
    result.face.resize(faces + kRowPadding);
    result.tiles.resize(faces + kRowPadding);
    CulledFaces out{result.face.data(), result.tiles.data(), 0};
    cull(out, result.counts);
    result.face.resize(out.count);
    result.tiles.resize(out.count);
    return result;
  }
};

TEST(grid_culler, a_list_of_faces_is_culled_as_each_of_them_alone) {
  onEverySimdTarget([] {
    std::mt19937 random(5);
    for (const std::size_t count : {1, 15, 16, 63, 64, 65, 128, 200}) {
      const RandomFaces faces(count, random);
      const KeptFaces together = faces.byBytes(0, count);
      KeptFaces alone;
      for (std::size_t n = 0; n < count; ++n) {
        const KeptFaces one = faces.byBytes(n, 1);
        if (!one.face.empty()) {
          alone.face.push_back(static_cast<std::uint32_t>(n));
          alone.tiles.push_back(one.tiles[0]);
        }
        alone.counts.outside += one.counts.outside;
        alone.counts.back_facing += one.counts.back_facing;
        alone.counts.no_sample += one.counts.no_sample;
      }
      EXPECT_EQ(together.face, alone.face) << count;
      EXPECT_EQ(together.tiles, alone.tiles) << count;
      EXPECT_EQ(together.counts.in, count);
      EXPECT_EQ(together.counts.outside, alone.counts.outside);
      EXPECT_EQ(together.counts.back_facing, alone.counts.back_facing);
      EXPECT_EQ(together.counts.no_sample, alone.counts.no_sample);
    }
  });
}

TEST(grid_culler, corners_of_words_and_of_bytes_say_the_same) {
  onEverySimdTarget([] {
    std::mt19937 random(6);
    const RandomFaces faces(200, random);
    const KeptFaces bytes = faces.byBytes(0, faces.count), words = faces.byWords();
    EXPECT_GT(bytes.face.size(), 20U);
    EXPECT_LT(bytes.face.size(), 180U);
    EXPECT_EQ(bytes.face, words.face);
    EXPECT_EQ(bytes.tiles, words.tiles);
  });
}

}  // namespace
}  // namespace deltaz
