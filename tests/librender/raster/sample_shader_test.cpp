#include "librender/raster/sample_shader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "libdb/access/simd_target.h"
#include "librender/raster/texture_sampler.h"
#include "tests/librender/textured_area.h"

namespace deltaz {
namespace {

constexpr int kLeafCells = 16;

// Texels of all colours, some with little cover or none.
MemoryDatabase patchwork() {
  return makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, -1, [](auto, double c, double r) {
    const auto x = static_cast<int>(std::floor(c * 4)), y = static_cast<int>(std::floor(r * 4));
    return std::array<std::uint8_t, 4>{
        static_cast<std::uint8_t>(x * 37), static_cast<std::uint8_t>(y * 91),
        static_cast<std::uint8_t>(static_cast<unsigned>(x) * static_cast<unsigned>(y) * 13U),
        static_cast<std::uint8_t>((x / 9 + y / 7) % 3 == 0 ? 0
                                  : (x * 5 + y) % 3 == 0   ? 120
                                                           : 255)};
  });
}

struct Expected {
  Surface surface = Surface::kSky;
  double u = std::numeric_limits<double>::infinity();
  LinearColor color;
};

// The definition, in scalar code and double.
Expected expectedAt(const Environment& environment, TextureReader& reader, const FacePlanes* face, double j,
                    double i) {
  const Vector3 ray = environment.view.ray(j, i);
  const double sea_u = environment.sea.depth(ray);
  // Beside the face, what is nearest to there.
  double dj = 0, di = 0, inverse_u = 0;
  if (face != nullptr) {
    dj = j - face->anchor_j;
    di = i - face->anchor_i;
    const double beside_second = face->weight1.at(dj, di), beside_third = face->weight2.at(dj, di);
    if (std::min({beside_second, beside_third, face->inverse_u.at(dj, di) - beside_second - beside_third}) <
        0)
      moveInside(faceLanes(*face, 0), dj, di);
    inverse_u = std::clamp(face->inverse_u.at(dj, di), face->least, face->greatest);
  }
  if (face == nullptr || 1 / inverse_u > sea_u) {
    if (std::isinf(sea_u)) return {Surface::kSky, sea_u, environment.atmosphere.sky(ray)};
    return {Surface::kSea, sea_u,
            environment.atmosphere.throughHaze(environment.sea.color(ray, sea_u), ray, sea_u)};
  }
  const double u = 1 / inverse_u;
  double second = std::clamp(face->weight1.at(dj, di) * u, 0.0, 1.0);
  double third = std::clamp(face->weight2.at(dj, di) * u, 0.0, 1.0);
  const double sum = std::max(1.0, second + third);
  second /= sum;
  third /= sum;
  const auto mixed = [&](double a, double b, double c) {
    return a * std::max(0.0, 1 - second - third) + b * second + c * third;
  };
  const auto channel = [&](std::size_t c) {
    return mixed(face->color[0][c], face->color[1][c], face->color[2][c]);
  };
  LinearColor color{channel(0), channel(1), channel(2)};
  const double intensity = mixed(face->intensity[0], face->intensity[1], face->intensity[2]);
  const auto request = textureRequest(
      *environment.color_map, 0, footprintAt(*face, face->anchor_j + dj, face->anchor_i + di, inverse_u));
  if (request && face->surface == Surface::kTerrain) {
    const TextureSample texture = trilinearSample(reader, *request);
    color = color * (1 - texture.cover) + texture.color * intensity;
  }
  return {face->surface, u, environment.atmosphere.throughHaze(color, ray, u)};
}

// A face in view at a random distance, mapped to a random place at a random scale.
FacePlanes randomFace(const Environment& environment, const GridHeader& header, std::mt19937& random) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  const ViewTransform& view = environment.view;
  PretiledNode node;
  node.surface = uniform(0, 1) < 0.9 ? Surface::kTerrain : Surface::kModel;
  const double u = std::exp(uniform(std::log(50.0), std::log(60000.0)));
  const GridCoordinates middle{static_cast<double>(header.x_axis.first) + uniform(0, 120),
                               static_cast<double>(header.y_axis.first) + uniform(0, 120)};
  const double scale = std::exp(uniform(-4, 4));
  TerrainVertices vertices;
  for (const auto& [j, i] : {std::array{0.0, 190.0}, std::array{310.0, 180.0}, std::array{150.0, 5.0}}) {
    const double depth = u * uniform(0.7, 1.3);
    vertices.append(
        {{depth, (j + uniform(-9, 9) - view.centre_j) * depth, (i + uniform(-9, 9) - view.centre_i) * depth},
         {uniform(0, 1), uniform(0, 1), uniform(0, 1)},
         uniform(0.2, 1.4),
         {middle.column + uniform(-1, 1) * scale, middle.row + uniform(-1, 1) * scale}});
  }
  ModelFaces model;
  model.position = vertices.position;
  ModelFace part;
  part.vertex = {0, 1, 2};
  for (std::size_t k = 0; k < 3; ++k) part.color[k] = vertices.at(k).color;
  model.front.push_back(part);
  return facePlanes(view,
                    node.surface == Surface::kModel
                        ? PretiledNode::ofModel(3, model)
                        : PretiledNode::ofTerrain(0, 1, vertices, std::vector<TerrainFace>{{{0, 1, 2}, 0}}),
                    0);
}

TEST(SampleShader, gives_what_the_scalar_definitions_give_on_every_vector_width) {
  const MemoryDatabase area = patchwork();
  const GridHeader& header = area.database.grid(0).header();
  std::array<int, 4> seen{};
  for (const double above : {2.0, 900.0, 60000.0}) {
    RenderOptions options;
    options.camera = cameraOver(area.database, 0.4, 0.2, above, 20, above > 1000 ? -25 : -2, 320, 200);
    const Result<Environment> environment = makeEnvironment(area.database, options);
    ASSERT_TRUE(environment.ok());
    TextureStore store(environment.value().color_map);
    TextureReader reader(store);
    std::mt19937 random(5);
    for (int round = 0; round < 60; ++round) {
      const FacePlanes planes = randomFace(environment.value(), header, random);
      const FaceLanes lanes = faceLanes(planes, 0);
      SampleBatch batch;
      std::array<const FacePlanes*, SampleBatch::kMost> face{};
      std::array<double, SampleBatch::kMost> first_red{};
      batch.count = 1 + random() % SampleBatch::kMost;
      for (std::size_t n = 0; n < batch.count; ++n) {
        batch.j[n] = static_cast<double>(random() % 320);
        batch.i[n] = static_cast<double>(random() % 200);
        face[n] = random() % 4 == 0 ? nullptr : &planes;
      }
      for (const SimdTarget target : simdTargets()) {
        SCOPED_TRACE(simdTargetName(target));
        ASSERT_TRUE(limitSimdTarget(target));
        SampleShader shader(environment.value(), store);
        for (std::size_t n = 0; n < batch.count; ++n) batch.face[n] = face[n] == nullptr ? nullptr : &lanes;
        shader.shade(batch);
        for (std::size_t n = 0; n < batch.count; ++n) {
          const Expected expected = expectedAt(environment.value(), reader, face[n], batch.j[n], batch.i[n]);
          ASSERT_EQ(batch.surface[n], expected.surface);
          ASSERT_EQ(batch.u[n], expected.u);
          ASSERT_NEAR(batch.red[n], expected.color.red, kShadingError);
          ASSERT_NEAR(batch.green[n], expected.color.green, kShadingError);
          ASSERT_NEAR(batch.blue[n], expected.color.blue, kShadingError);
          ++seen[static_cast<std::size_t>(expected.surface)];
          if (target == simdTargets().front()) first_red[n] = batch.red[n];
          ASSERT_EQ(batch.red[n], first_red[n]);
        }
      }
    }
    EXPECT_TRUE(store.status().ok());
  }
  limitSimdTarget(std::nullopt);
  for (const Surface surface : {Surface::kSky, Surface::kSea, Surface::kTerrain, Surface::kModel})
    EXPECT_GT(seen[static_cast<std::size_t>(surface)], 100) << static_cast<int>(surface);
}

TEST(TextureCache, keeps_the_tiles_used_last_within_its_capacity) {
  const auto tile = [](int x) {
    auto made = std::make_shared<TextureTile>();
    made->square = {0, 0, x, 0};
    made->texels.resize(100);
    return made;
  };
  TextureCache cache(350);
  const FileIdentity file{10, {}};
  for (int x = 0; x < 3; ++x) cache.add(file, tile(x));
  EXPECT_NE(cache.find(file, {0, 0, 0, 0}), nullptr);
  cache.add(file, tile(3));
  EXPECT_LE(cache.bytes(), 350u);
  EXPECT_NE(cache.find(file, {0, 0, 0, 0}), nullptr);
  EXPECT_EQ(cache.find(file, {0, 0, 1, 0}), nullptr);
  EXPECT_NE(cache.find(file, {0, 0, 3, 0}), nullptr);
  FileIdentity other = file;
  other.id.bytes[3] = std::byte{1};
  EXPECT_EQ(cache.find(other, {0, 0, 0, 0}), nullptr);
}

TEST(TextureStore, reads_nothing_that_a_cache_has) {
  const MemoryDatabase area = patchwork();
  const ColorMap& map = area.database.colorMaps().front();
  const GridHeader& header = area.database.grid(0).header();
  const TextureSquare square{0, 0, colorNodeAt(static_cast<double>(header.x_axis.first) + 60, kLeafCells, 0),
                             colorNodeAt(static_cast<double>(header.y_axis.first) + 60, kLeafCells, 0)};
  TextureCache cache;
  const TextureTile* first = nullptr;
  {
    TextureStore store(&map, &cache);
    first = store.find(square);
    ASSERT_NE(first, nullptr);
  }
  const std::uint64_t before = area.database.bytesRead();
  TextureStore store(&map, &cache);
  EXPECT_EQ(store.find(square), first);
  EXPECT_EQ(store.tileCount(), 1u);
  EXPECT_EQ(area.database.bytesRead(), before);
}

}  // namespace
}  // namespace deltaz
