// Colour maps as both engines draw them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "libdb/access/color.h"
#include "librender/scene/camera.h"
#include "tests/librender/picture_comparison.h"
#include "tests/librender/textured_area.h"
#include "tests/support/projected_grid.h"

namespace deltaz {
namespace {

constexpr int kLeafCells = 16;

RenderOptions optionsOf(const Camera& camera) {
  RenderOptions options;
  options.camera = camera;
  options.tolerance = 0;
  options.keep_triangle_ids = true;
  return options;
}

std::uint8_t wave(double phase, double middle, double amplitude) {
  return static_cast<std::uint8_t>(std::lround(middle + amplitude * std::sin(phase)));
}

// Details of a few texels, and slower ones, different in each grid.
ColorFunction busyColors(int finest_level) {
  const double texel = colorTexelCells(kLeafCells, finest_level);
  return [texel](std::uint16_t grid, double column, double row) {
    const double c = column / texel, r = row / texel;
    return std::array<std::uint8_t, 4>{wave(c / 0.9 + grid, 130, 120), wave(r / 1.7 - c / 3, 120, 110),
                                       wave((c + r) / 11 + 2 * grid, 100, 90), 255};
  };
}

struct TexturedCase {
  const char* name;
  std::vector<RawGrid> grids;  // the one on top first
  int finest_level;
  ColorFunction color;
};

std::vector<TexturedCase> cases() {
  std::vector<TexturedCase> result;
  const RawGrid country = syntheticGrid(smallArea());
  result.push_back({"geodetic", {country}, 2, busyColors(2)});
  result.push_back({"deeper than the terrain", {country}, -1, busyColors(-1)});
  result.push_back({"coarser than the terrain", {country}, 5, busyColors(5)});

  SyntheticGridOptions narrow = smallArea();
  narrow.south = 68;
  narrow.spacing_longitude = {6, 1};
  result.push_back({"cells of two different sides", {syntheticGrid(narrow)}, 2, busyColors(2)});

  SyntheticGridOptions pole = smallArea();
  pole.south = 89.9;
  pole.west = 179.5;  // and across the antimeridian
  pole.spacing_longitude = {30, 1};
  result.push_back({"at the pole", {syntheticGrid(pole)}, 2, busyColors(2)});
  result.push_back({"projected", {projectedGrid()}, 2, busyColors(2)});

  // A disc of colours whose rim fades over some texels.
  const GridAxis &x = country.header.x_axis, &y = country.header.y_axis;
  const double middle_x = static_cast<double>(x.first) + 70, middle_y = static_cast<double>(y.first) + 55;
  result.push_back({"part of the area",
                    {country},
                    1,
                    [=, busy = busyColors(1)](std::uint16_t grid, double column, double row) {
                      const double rim = 34 - std::hypot(column - middle_x, row - middle_y);
                      auto color = busy(grid, column, row);
                      color[3] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(rim / 4, 0.0, 1.0)));
                      return color;
                    }});

  result.push_back({"inset between the posts", insetBetweenPosts(), 2, busyColors(2)});
  result.push_back({"projected inset", projectedInset(), 2, busyColors(2)});
  return result;
}

std::vector<Camera> viewsOf(const Database& database, int random_views) {
  std::vector<Camera> views;
  views.push_back(wholeAreaCamera(database.area(), 240, 160, 60));
  views.push_back(cameraOver(database, 0.5, 0.5, 9000, 30, -90, 240, 160));
  views.push_back(cameraOver(database, 0.41, 0.37, 1.7, 45, -3, 240, 160));   // grazing
  views.push_back(cameraOver(database, 0.55, 0.48, 40, 200, -60, 240, 160));  // texels larger than pixels
  views.push_back(cameraOver(database, 0.5, -0.6, 1500, 0, -4, 240, 160));
  std::mt19937 generator(5);
  const auto random = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator);
  };
  for (int n = 0; n < random_views; ++n) {
    Camera camera = cameraOver(database, random(0, 1), random(0, 1), std::exp(random(1, 9)), random(0, 360),
                               random(-85, 0), 240, 160);
    camera.roll = random(-30, 30);
    camera.field_of_view = random(15, 90);
    views.push_back(camera);
  }
  return views;
}

TEST(Texture, both_engines_draw_the_same_picture) {
  for (const TexturedCase& area : cases()) {
    const MemoryDatabase memory = makeTexturedDatabase(area.grids, kLeafCells, area.finest_level, area.color);
    std::uint64_t pixels = 0, differing = 0;
    double worst = 0;
    int view = 0;
    for (const Camera& camera : viewsOf(memory.database, 6)) {
      const RenderOptions options = optionsOf(camera);
      FrameStatistics fast_statistics, reference_statistics;
      const Picture fast = draw(EngineKind::kFast, memory.database, options, fast_statistics);
      const Picture reference = draw(EngineKind::kReference, memory.database, options, reference_statistics);
      const PictureDifference difference = comparePictures(memory.database, camera, fast, reference);
      EXPECT_LE(static_cast<double>(difference.differing), 0.001 * static_cast<double>(difference.pixels))
          << area.name << ", view " << view;
      pixels += difference.pixels;
      differing += difference.differing;
      worst =
          std::max(worst, static_cast<double>(difference.differing) / static_cast<double>(difference.pixels));
      ++view;
    }
    std::printf("%-30s %d views, %llu of %llu pixels differ, worst view %.4f %%\n", area.name, view,
                static_cast<unsigned long long>(differing), static_cast<unsigned long long>(pixels),
                100 * worst);
  }
}

// How often steps of each size occur.
struct Steps {
  std::array<std::uint64_t, 256> count{};
  std::uint64_t total = 0;
  void add(int step) {
    ++count[static_cast<std::size_t>(step)];
    ++total;
  }
  int percentile(double part) const {
    const auto wanted = static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(total)));
    std::uint64_t seen = 0;
    for (std::size_t step = 0; step < count.size(); ++step) {
      seen += count[step];
      if (seen >= wanted) return static_cast<int>(step);
    }
    return 255;
  }
  int largest() const { return percentile(1); }
};

// How much larger the step from a pixel to its right or lower neighbour is than the steps before and after it
// on the same line, added to `across` where the two belong to different nodes, to `inside` where they belong
// to different faces of one (a border is an edge of faces, too): where the ground runs away from the eye the
// picture changes faster, and so do its steps.
void addSteps(const Picture& picture, Steps& inside, Steps& across) {
  // Steps of depth that are large, relative to it, or larger than those beside them are silhouettes: the
  // ground behind is another.
  constexpr double kFarApart = 0.03, kSilhouette = 1.5;
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  const auto add = [&](std::size_t first, std::size_t stride) {
    std::array<std::array<int, 3>, 3> step{};
    std::array<double, 3> depth_step{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = first + k * stride, to = from + stride;
      if (picture.surface[from] != Surface::kTerrain || picture.surface[to] != Surface::kTerrain) return;
      const double u = static_cast<double>(picture.depth[from]), v = static_cast<double>(picture.depth[to]);
      depth_step[k] = std::abs(u - v);
      if (depth_step[k] > kFarApart * std::min(u, v)) return;
      for (std::size_t channel = 0; channel < 3; ++channel)
        step[k][channel] = std::abs(picture.rgb[3 * to + channel] - picture.rgb[3 * from + channel]);
    }
    if (depth_step[1] > kSilhouette * std::max(depth_step[0], depth_step[2])) return;
    int excess = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      excess = std::max(excess, step[1][channel] - std::max(step[0][channel], step[2][channel]));
    const std::size_t from = first + stride, to = from + stride;
    if (picture.triangle[from] >> 32 != picture.triangle[to] >> 32) {
      across.add(excess);
    } else if (picture.triangle[from] != picture.triangle[to]) {
      inside.add(excess);
    }
  };
  for (std::size_t i = 0; i < height; ++i) {
    for (std::size_t j = 0; j < width; ++j) {
      if (j + 3 < width) add(i * width + j, 1);
      if (i + 3 < height) add(i * width + j, width);
    }
  }
}

// A smooth map stays smooth where nodes and levels meet. The country is gently rolling, so that the light
// adds little.
TEST(Texture, has_no_steps_along_borders_of_nodes_and_levels) {
  SyntheticGridOptions gentle = smallArea();
  gentle.lowest = 900;
  gentle.highest = 960;
  for (const int finest_level : {0, 3}) {
    const MemoryDatabase memory =
        makeTexturedDatabase({syntheticGrid(gentle)}, kLeafCells, finest_level, [](auto, double c, double r) {
          return std::array<std::uint8_t, 4>{wave(c / 7, 120, 80), wave(r / 9, 120, 80),
                                             wave((c - r) / 11, 120, 80), 255};
        });
    Steps inside, across;
    std::uint64_t mixed = 0;
    for (const double tolerance : {0.03, 0.12, 0.5}) {
      for (const Camera& camera : viewsOf(memory.database, 10)) {
        RenderOptions options = optionsOf(camera);
        options.tolerance = tolerance;
        FrameStatistics statistics;
        addSteps(draw(EngineKind::kFast, memory.database, options, statistics), inside, across);
        mixed += statistics.coarsest_level > statistics.level ? 1 : 0;
      }
    }
    std::printf(
        "finest level %d: %llu steps inside nodes, 99.9 %% up to %d, largest %d; %llu across borders, "
        "99.9 %% up to %d, largest %d; %llu views of several levels\n",
        finest_level, static_cast<unsigned long long>(inside.total), inside.percentile(0.999),
        inside.largest(), static_cast<unsigned long long>(across.total), across.percentile(0.999),
        across.largest(), static_cast<unsigned long long>(mixed));
    EXPECT_GT(mixed, 5u);
    EXPECT_GT(across.total, 10000u);
    EXPECT_LE(across.percentile(0.999), inside.percentile(0.999));
    EXPECT_LE(across.largest(), inside.largest());
  }
}

// Seen from above, where the ground itself makes no step, the plain measure holds: no step across a border is
// larger than the largest thousandth of those inside nodes. (Of a rougher map as many steps are larger on
// both sides: it is the share that tells, not the largest.)
TEST(Texture, seen_from_above_no_step_across_a_border_stands_out) {
  SyntheticGridOptions level_ground = smallArea();
  level_ground.lowest = 900;
  level_ground.highest = 905;
  const MemoryDatabase memory =
      makeTexturedDatabase({syntheticGrid(level_ground)}, kLeafCells, 2, [](auto, double c, double r) {
        return std::array<std::uint8_t, 4>{wave(c / 23, 120, 70), wave(r / 27, 120, 70),
                                           wave((c - r) / 33, 120, 70), 255};
      });
  Steps inside, across;
  const auto add = [&](const Picture& picture, std::size_t from, std::size_t to) {
    if (picture.surface[from] != Surface::kTerrain || picture.surface[to] != Surface::kTerrain) return;
    int step = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      step = std::max(step, std::abs(picture.rgb[3 * to + channel] - picture.rgb[3 * from + channel]));
    (picture.triangle[from] >> 32 == picture.triangle[to] >> 32 ? inside : across).add(step);
  };
  for (const double above : {700.0, 1500.0, 3000.0, 5000.0, 9000.0}) {
    for (const double pitch : {-90.0, -75.0}) {
      const Picture picture =
          draw(EngineKind::kFast, memory.database,
               optionsOf(cameraOver(memory.database, 0.5, 0.5, above, 30, pitch, 320, 240)));
      for (std::size_t i = 0; i + 1 < 240; ++i) {
        for (std::size_t j = 0; j + 1 < 320; ++j) {
          add(picture, i * 320 + j, i * 320 + j + 1);
          add(picture, i * 320 + j, (i + 1) * 320 + j);
        }
      }
    }
  }
  std::printf("%llu steps inside nodes, 99.9 %% up to %d; %llu across borders, largest %d\n",
              static_cast<unsigned long long>(inside.total), inside.percentile(0.999),
              static_cast<unsigned long long>(across.total), across.largest());
  EXPECT_GT(across.total, 10000u);
  EXPECT_LE(across.largest(), inside.percentile(0.999));
}

// A bright spot is where it should be, at any level: the centre of its light, brought back from the picture
// through the depth, lies within half a texel of the finest level. Each pixel counts with the ground it
// shows, which on a plane grows with the third power of its depth.
TEST(Texture, shows_a_feature_where_it_is) {
  SyntheticGridOptions gentle = smallArea();
  gentle.lowest = 900;
  gentle.highest = 902;
  const RawGrid grid = syntheticGrid(gentle);
  constexpr int kFinest = 1;
  const double texel = colorTexelCells(kLeafCells, kFinest);
  const double column = static_cast<double>(grid.header.x_axis.first) + 63.3141;
  const double row = static_cast<double>(grid.header.y_axis.first) + 58.2718;
  const MemoryDatabase memory =
      makeTexturedDatabase({grid}, kLeafCells, kFinest, [&](auto, double c, double r) {
        const double distance = std::hypot(c - column, r - row) / texel;
        return std::array<std::uint8_t, 4>{encodeSrgb(std::exp(-distance * distance / 162)), 0, 0, 255};
      });
  const AreaHeader& area = memory.database.area();
  const double spot_x = (column - static_cast<double>(grid.header.x_axis.first)) / 120,
               spot_y = (row - static_cast<double>(grid.header.y_axis.first)) / 120;
  // Metres above ground at which a pixel is about the given number of the finest texels.
  const double texel_metres = texel * 3 / 3600 * 111000;
  for (const double size : {0.3, 1.0, 1.7, 3.3, 6.0}) {
    for (const double pitch : {-90.0, -50.0}) {
      Camera camera = cameraOver(memory.database, spot_x, spot_y, 0, 0, pitch, 200, 200);
      camera.field_of_view = 20;
      const double distance = size * texel_metres * 100 / std::tan(10 * std::numbers::pi / 180);
      camera.eye.height += distance * std::sin(-pitch * std::numbers::pi / 180);
      camera.eye.latitude -= distance * std::cos(pitch * std::numbers::pi / 180) / 111200;
      RenderOptions options = optionsOf(camera);
      options.color_map = kTestColorMap;
      const Picture picture = draw(EngineKind::kFast, memory.database, options);
      const EllipsoidShape& ellipsoid = area.grids.front().ellipsoid;
      const ViewTransform view = makeViewTransform(camera, ellipsoid);
      double light = 0, sum_column = 0, sum_row = 0;
      for (std::size_t pixel = 0; pixel < picture.surface.size(); ++pixel) {
        // Red over green: the haze is common to both, near enough.
        const double seen = decodeSrgb(picture.rgb[3 * pixel]) - decodeSrgb(picture.rgb[3 * pixel + 1]);
        if (picture.surface[pixel] != Surface::kTerrain || seen < 0.01) continue;
        const auto j = static_cast<double>(pixel % 200), i = static_cast<double>(pixel / 200);
        const GeodeticPoint point =
            toGeodetic(ellipsoid, view.eye + view.ray(j, i) * static_cast<double>(picture.depth[pixel]));
        const double weight = seen * std::pow(static_cast<double>(picture.depth[pixel]), 3);
        light += weight;
        sum_column += weight * (point.longitude + 180) * 3600 / 3;
        sum_row += weight * (point.latitude + 90) * 3600 / 3;
      }
      ASSERT_GT(light, 0) << size;
      const double off_column = (sum_column / light - column) / texel,
                   off_row = (sum_row / light - row) / texel;
      std::printf("pixel of %.1f texels, pitch %.0f: off by %.3f, %.3f texels\n", size, pitch, off_column,
                  off_row);
      EXPECT_LT(std::abs(off_column), 0.5) << size << ", " << pitch;
      EXPECT_LT(std::abs(off_row), 0.5) << size << ", " << pitch;
    }
  }
}

// What is drawn is the map, not something else both engines agree upon: under full cover a map of one colour
// hides the colours by rule and leaves the light.
TEST(Texture, multiplies_the_maps_colour_by_the_light) {
  const MemoryDatabase memory =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, 2, [](auto, double, double) {
        return std::array<std::uint8_t, 4>{0, 188, 0, 255};
      });
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    const Camera camera = cameraOver(memory.database, 0.5, 0.5, 300, 30, -60, 160, 120);
    RenderOptions options = optionsOf(camera);
    const Picture first = draw(kind, memory.database, options);
    options.color_map = kTestColorMap;
    EXPECT_EQ(draw(kind, memory.database, options).rgb, first.rgb);
    options.color_map = kNoColorMap;
    EXPECT_NE(draw(kind, memory.database, options).rgb, first.rgb);
    // The haze of some hundred metres adds a little of red and blue.
    std::uint8_t least = 255, greatest = 0;
    for (std::size_t pixel = 0; pixel < first.surface.size(); ++pixel) {
      if (first.surface[pixel] != Surface::kTerrain) continue;
      EXPECT_LT(first.rgb[3 * pixel], 60);
      EXPECT_LT(first.rgb[3 * pixel + 2], 90);
      least = std::min(least, first.rgb[3 * pixel + 1]);
      greatest = std::max(greatest, first.rgb[3 * pixel + 1]);
    }
    EXPECT_GT(greatest, least + 60);
  }
}

TEST(Texture, that_covers_nothing_leaves_the_colours_by_rule) {
  const RawGrid grid = syntheticGrid(smallArea());
  const double west_quarter = static_cast<double>(grid.header.x_axis.first) + 30;
  const MemoryDatabase memory = makeTexturedDatabase({grid}, kLeafCells, 3, [&](auto, double c, double) {
    return std::array<std::uint8_t, 4>{255, 0, 0, static_cast<std::uint8_t>(c < west_quarter ? 255 : 0)};
  });
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    for (const double heading : {90.0, 270.0}) {
      RenderOptions options = optionsOf(cameraOver(memory.database, 0.5, 0.5, 900, heading, -20, 160, 120));
      const Picture with = draw(kind, memory.database, options);
      options.color_map = kNoColorMap;
      EXPECT_EQ(draw(kind, memory.database, options).rgb == with.rgb, heading == 90);
    }
  }
}

TEST(Texture, does_not_depend_on_the_number_of_threads) {
  const MemoryDatabase memory =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, 1, busyColors(1));
  RenderOptions options = optionsOf(cameraOver(memory.database, 0.4, 0.4, 90, 70, -8, 333, 211));
  options.tolerance = 1;
  options.threads = 1;
  FrameStatistics first_statistics;
  const Picture first = draw(EngineKind::kFast, memory.database, options, first_statistics);
  for (const int threads : {2, 7}) {
    options.threads = threads;
    FrameStatistics statistics;
    EXPECT_EQ(draw(EngineKind::kFast, memory.database, options, statistics).rgb, first.rgb);
    EXPECT_EQ(statistics.color_tiles, first_statistics.color_tiles);
  }
}

TEST(Texture, reads_only_the_tiles_that_are_seen) {
  const MemoryDatabase memory =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, 0, busyColors(0));
  const auto drawn = [&](const Camera& camera, const std::string& map) {
    RenderOptions options = optionsOf(camera);
    options.color_map = map;
    FrameStatistics statistics;
    draw(EngineKind::kFast, memory.database, options, statistics);
    return statistics;
  };
  const std::uint32_t all = memory.database.colorMaps().front().directory().node_count;
  // From far above a few coarse tiles are enough, close to the ground a few fine ones.
  const Camera far_above = cameraOver(memory.database, 0.5, 0.5, 60000, 0, -90, 160, 120);
  const Camera near = cameraOver(memory.database, 0.5, 0.5, 200, 0, -90, 160, 120);
  for (const Camera& camera : {far_above, near}) {
    const FrameStatistics with = drawn(camera, kTestColorMap), without = drawn(camera, "none");
    EXPECT_GT(with.color_tiles, 0u);
    EXPECT_LT(with.color_tiles, 12u);
    EXPECT_LT(with.color_tiles, all / 4);
    EXPECT_EQ(without.color_tiles, 0u);
    EXPECT_GT(with.bytes_read, without.bytes_read);
  }
}

TEST(Texture, of_a_name_that_is_not_there_is_refused_with_the_names_that_are) {
  const MemoryDatabase memory =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, 4, busyColors(4));
  const MemoryDatabase bare = makeDatabase(smallArea());
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    RenderOptions options = optionsOf(cameraOver(memory.database, 0.5, 0.5, 100, 0, 0, 64, 48));
    options.color_map = "winter";
    FrameStatistics statistics;
    const Result<Picture> picture = makeEngine(kind)->render(memory.database, options, statistics);
    ASSERT_FALSE(picture.ok());
    EXPECT_EQ(picture.error().kind, ErrorKind::kUsage);
    EXPECT_NE(picture.error().message().find("winter"), std::string::npos);
    EXPECT_NE(picture.error().message().find(kTestColorMap), std::string::npos);
    EXPECT_FALSE(makeEngine(kind)->render(bare.database, options, statistics).ok());
    options.color_map = kNoColorMap;
    EXPECT_TRUE(makeEngine(kind)->render(bare.database, options, statistics).ok());
    options.color_map.clear();
    EXPECT_TRUE(makeEngine(kind)->render(bare.database, options, statistics).ok());
  }
}

TEST(Texture, that_is_damaged_is_an_error_and_no_picture) {
  MemoryDatabase memory = makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, 2, busyColors(2));
  std::string name;
  for (const FileReference& file : memory.database.area().files) {
    if (file.role == FileRole::kColors) name = file.name;
  }
  ASSERT_FALSE(name.empty());
  // Somewhere in every tile.
  MemoryFileSystem::Bytes& bytes = memory.files.mutableBytes(kMemoryDatabasePath + "/" + name);
  for (std::size_t at = 2000; at + 20000 < bytes.size(); at += 500) bytes[at] ^= std::byte{1};
  Result<Database> damaged = Database::open(memory.files, kMemoryDatabasePath);
  ASSERT_TRUE(damaged.ok());
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    RenderOptions options = optionsOf(cameraOver(memory.database, 0.5, 0.5, 400, 0, -60, 64, 48));
    FrameStatistics statistics;
    const Result<Picture> picture = makeEngine(kind)->render(damaged.value(), options, statistics);
    ASSERT_FALSE(picture.ok());
    EXPECT_EQ(picture.error().kind, ErrorKind::kInvalid);
    options.color_map = kNoColorMap;
    EXPECT_TRUE(makeEngine(kind)->render(damaged.value(), options, statistics).ok());
  }
}

}  // namespace
}  // namespace deltaz
