#include "librender/ars/experiments/correction_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {

namespace {

constexpr std::uint64_t kSeed = 12;
constexpr double kScreenCentre = 255.5;

TilerSetup setUpFor(const ProjectedTriangle& triangle, bool oversample,
                    const TilerConfiguration& configuration) {
  const EncodedTriangle encoded = encodeTriangle(triangle, configuration.numbers, {.oversample = oversample});
  return setUpTriangle(encoded.variables, configuration, &encoded.supplement);
}

// How often covered pixels are tiled, on the average.
double complexity(const std::vector<ProjectedTriangle>& triangles, const TilerConfiguration& configuration) {
  std::vector<bool> covered(static_cast<std::size_t>(kScreenLines) * kScreenPixels);
  std::vector<PixelPacket> pixels;
  std::int64_t tiled = 0, once = 0;
  for (const ProjectedTriangle& triangle : triangles) {
    pixels.clear();
    tiled += tileTriangle(setUpFor(triangle, false, configuration), configuration.numbers, pixels).tiled;
    for (const PixelPacket& pixel : pixels) {
      auto before = covered[static_cast<std::size_t>(pixel.i) * kScreenPixels + pixel.j];
      once += before ? 0 : 1;
      before = true;
    }
  }
  return static_cast<double>(tiled) / static_cast<double>(once);
}

// Shares of pixels whose depth lies outside that of the triangle's vertices, per cent.
struct DepthExcess {
  double outside = 0, by_a_twentieth = 0, at_infinity = 0;
};

DepthExcess depthExcess(const std::vector<ProjectedTriangle>& triangles, bool oversample,
                        const TilerConfiguration& configuration) {
  constexpr double kRounding = 0x1p-18;  // of the memory's 19 bits
  std::vector<PixelPacket> pixels;
  std::int64_t all = 0, outside = 0, far = 0, infinite = 0;
  for (const ProjectedTriangle& triangle : triangles) {
    const auto [least, greatest] = std::minmax({triangle[0].depth, triangle[1].depth, triangle[2].depth});
    pixels.clear();
    all += tileTriangle(setUpFor(triangle, oversample, configuration), configuration.numbers, pixels).tiled;
    for (const PixelPacket& pixel : pixels) {
      const double depth = configuration.numbers.depth.decode(pixel.depth);
      const double excess = std::max(1 - depth / least, depth / greatest - 1);
      outside += excess > kRounding ? 1 : 0;
      far += excess > 0.05 ? 1 : 0;
      infinite += pixel.depth == 0 ? 1 : 0;
    }
  }
  const double per_cent = 100 / static_cast<double>(all);
  return {static_cast<double>(outside) * per_cent, static_cast<double>(far) * per_cent,
          static_cast<double>(infinite) * per_cent};
}

// Of pixels inside their triangle: by how many codes the colour differs from c/U over 1/U in double.
struct ColorError {
  double mean = 0, largest = 0;
};

ColorError colorError(const std::vector<ProjectedTriangle>& triangles,
                      const TilerConfiguration& configuration) {
  std::vector<PixelPacket> pixels;
  ColorError error;
  double sum = 0;
  std::int64_t count = 0;
  for (const ProjectedTriangle& triangle : triangles) {
    const TrianglePlanes planes = planesOf(triangle, 0);
    const auto [darkest, brightest] = std::minmax({triangle[0].color, triangle[1].color, triangle[2].color});
    const auto [least, greatest] = std::minmax({triangle[0].depth, triangle[1].depth, triangle[2].depth});
    pixels.clear();
    tileTriangle(setUpFor(triangle, false, configuration), configuration.numbers, pixels);
    for (const PixelPacket& pixel : pixels) {
      const double di = pixel.i - planes.i, dj = pixel.j - planes.j, depth = planes.depth.at(di, dj);
      const double color = planes.color_over_depth.at(di, dj) / depth;
      // Beside the triangle, within its tolerance.
      if (depth < least || depth > greatest || color < darkest || color > brightest) continue;
      const double off = std::abs(pixel.color - color);
      sum += off;
      error.largest = std::max(error.largest, off);
      ++count;
    }
  }
  error.mean = sum / static_cast<double>(count);
  return error;
}

// A rod from U = 1 to U = 3, black to white (Fig 14), two pixels high; the colour shown where its middle
// projects.
int rodsMiddle(const TilerConfiguration& configuration) {
  constexpr double kLeft = 100, kLength = 400, kNear = 1, kFar = 3;
  const ProjectedTriangle rod{{{.i = 100, .j = kLeft, .depth = 1 / kNear, .color = 0},
                               {.i = 102, .j = kLeft, .depth = 1 / kNear, .color = 0},
                               {.i = 101, .j = kLeft + kLength, .depth = 1 / kFar, .color = 255}}};
  // Fig 14: the middle of a rod projects to U2 / (U1 + U2) of its picture.
  constexpr int kMiddle = static_cast<int>(kLeft + kLength * kFar / (kNear + kFar));
  std::vector<PixelPacket> pixels;
  tileTriangle(setUpFor(rod, false, configuration), configuration.numbers, pixels);
  for (const PixelPacket& pixel : pixels) {
    if (pixel.i == 101 && pixel.j == kMiddle) return pixel.color;
  }
  return -1;
}

ReportRow row(const std::string& id, bool on, const std::string& description, double ours) {
  return {.id = "correction." + id + (on ? ".on" : ".off"),
          .description = description,
          .published = {},
          .ours = ours,
          .note = on ? "ours, not the report's machine" : "as in the report's machine"};
}

}  // namespace

std::vector<ProjectedTriangle> grazingTerrain() {
  constexpr int kCells = 120;
  constexpr double kSpacing = 90, kEye = 180, kFirst = 300;
  constexpr double kScale = 892.7597;  // 256 / tan(16 degrees)
  RandomNumbers random(kSeed);
  std::vector<ProjectedVertex> posts;
  for (int row_number = 0; row_number <= kCells; ++row_number) {
    for (int column = 0; column <= kCells; ++column) {
      const double u = kFirst + row_number * kSpacing, v = (column - 0.5 * kCells) * kSpacing;
      const double w = kEye - random.uniform(0, 10);
      posts.push_back({.i = kScreenCentre + kScale * w / u,
                       .j = kScreenCentre + kScale * v / u,
                       .depth = 1 / u,
                       .color = random.uniform(0, 255)});
    }
  }
  const auto post = [&](int row_number, int column) {
    return posts[static_cast<std::size_t>(row_number) * (kCells + 1) + static_cast<std::size_t>(column)];
  };
  const auto on_screen = [](const ProjectedVertex& v) {
    return v.i >= 0 && v.i <= 511 && v.j >= 0 && v.j <= 511;
  };
  std::vector<ProjectedTriangle> triangles;
  const auto add = [&](const ProjectedTriangle& triangle) {
    if (std::all_of(triangle.begin(), triangle.end(), on_screen)) triangles.push_back(triangle);
  };
  for (int row_number = 0; row_number < kCells; ++row_number) {
    for (int column = 0; column < kCells; ++column) {
      add({post(row_number, column), post(row_number, column + 1), post(row_number + 1, column)});
      add({post(row_number, column + 1), post(row_number + 1, column + 1), post(row_number + 1, column)});
    }
  }
  return triangles;
}

std::vector<ProjectedTriangle> randomMesh(int cells, int pitch) {
  RandomNumbers random(kSeed);
  const double reach = 0.24 * pitch;
  const auto posts_a_line = static_cast<std::size_t>(cells) + 1;
  std::vector<std::array<double, 2>> moved(posts_a_line * posts_a_line);
  for (std::array<double, 2>& by : moved) by = {random.uniform(-reach, reach), random.uniform(-reach, reach)};
  std::vector<ProjectedTriangle> mesh = latticeTriangles(cells, pitch);
  for (ProjectedTriangle& triangle : mesh) {
    for (ProjectedVertex& vertex : triangle) {
      const int line = static_cast<int>(vertex.i) / pitch, column = static_cast<int>(vertex.j) / pitch;
      if (line == 0 || line == cells || column == 0 || column == cells) continue;
      const std::array<double, 2>& by =
          moved[static_cast<std::size_t>(line) * posts_a_line + static_cast<std::size_t>(column)];
      vertex.i = line * pitch + by[0];
      vertex.j = column * pitch + by[1];
    }
  }
  return mesh;
}

std::vector<ReportRow> correctionRows() {
  const std::vector<ProjectedTriangle> lattice = latticeTriangles(16, 13), mesh = randomMesh(30, 16);
  const std::vector<ProjectedTriangle> terrain = grazingTerrain();
  std::vector<ReportRow> rows;
  for (const bool on : {false, true}) {
    TilerConfiguration configuration;
    configuration.corrections.top_left_rule = on;
    rows.push_back(row("top_left_rule.lattice", on,
                       "16 x 16 cells of 13 pixels, undersampled: times a pixel is tiled",
                       complexity(lattice, configuration)));
    rows.push_back(row("top_left_rule.mesh", on, "mesh of any vertices, undersampled: times a pixel is tiled",
                       complexity(mesh, configuration)));
  }
  for (const bool on : {false, true}) {
    TilerConfiguration configuration;
    configuration.corrections.clamp_depth = on;
    for (const bool oversample : {false, true}) {
      const std::string id = std::string("clamp_depth.") + (oversample ? "oversample" : "undersample");
      const std::string what =
          std::string("grazing terrain, ") + (oversample ? "oversampled" : "undersampled") + ": pixels ";
      const DepthExcess excess = depthExcess(terrain, oversample, configuration);
      rows.push_back(row(id + ".outside", on, what + "outside their triangle's depths, %", excess.outside));
      rows.push_back(row(id + ".twentieth", on, what + "by more than 5 % outside, %", excess.by_a_twentieth));
      rows.push_back(row(id + ".infinity", on, what + "with 1/U at or below 0, %", excess.at_infinity));
    }
  }
  for (const bool on : {false, true}) {
    TilerConfiguration configuration;
    configuration.corrections.true_color = on;
    const ColorError error = colorError(terrain, configuration);
    rows.push_back(row("true_color.mean", on, "grazing terrain: mean error of colour, codes", error.mean));
    rows.push_back(
        row("true_color.largest", on, "grazing terrain: largest error of colour, codes", error.largest));
    rows.push_back(row("true_color.rod", on,
                       "Fig 14, U from 1 to 3: colour of the middle of a rod, of 0 to 255",
                       rodsMiddle(configuration)));
  }
  return rows;
}

}  // namespace deltaz::ars
