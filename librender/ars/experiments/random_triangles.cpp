#include "librender/ars/experiments/random_triangles.h"

#include <algorithm>
#include <cmath>

namespace deltaz::ars {

namespace {

constexpr double kLastPixel = 511;

ProjectedVertex vertexAt(double i, double j) {
  return {.i = i, .j = j, .depth = 1, .color = 255};
}

double areaOf(const ProjectedTriangle& t) {
  return 0.5 * std::abs((t[1].i - t[0].i) * (t[2].j - t[0].j) - (t[1].j - t[0].j) * (t[2].i - t[0].i));
}

void move(ProjectedTriangle& triangle, RandomNumbers& random) {
  const auto offset = [&](double ProjectedVertex::*axis) {
    const auto [least, greatest] = std::minmax({triangle[0].*axis, triangle[1].*axis, triangle[2].*axis});
    const double by = random.uniform(0, kLastPixel - (greatest - least)) - least;
    for (ProjectedVertex& vertex : triangle) vertex.*axis += by;
  };
  offset(&ProjectedVertex::i);
  offset(&ProjectedVertex::j);
}

ProjectedTriangle uniformTriangle(RandomNumbers& random, const TrianglePopulation& population) {
  const double largest_area = population.largest_area * population.side * population.side;
  ProjectedTriangle triangle;
  do {
    for (ProjectedVertex& vertex : triangle) {
      const double i = random.uniform(0, population.side);
      vertex = vertexAt(i, random.uniform(0, population.side));
    }
  } while (areaOf(triangle) > largest_area);
  return triangle;
}

// A direction without sine and cosine, whose last bits differ between libraries.
ProjectedVertex randomDirection(RandomNumbers& random) {
  for (;;) {
    const double i = random.uniform(-1, 1), j = random.uniform(-1, 1), square = i * i + j * j;
    if (square > 1 || square < 0.01) continue;
    const double length = std::sqrt(square);
    return {.i = i / length, .j = j / length};
  }
}

ProjectedTriangle needle(RandomNumbers& random, const TrianglePopulation& population) {
  const ProjectedVertex along = randomDirection(random);
  const double length = population.needle_length * random.uniform(0.8, 1.2);
  const double width = random.uniform(0, population.needle_width), at = random.uniform(0, length);
  return {vertexAt(0, 0), vertexAt(along.i * length, along.j * length),
          vertexAt(along.i * at - along.j * width, along.j * at + along.i * width)};
}

}  // namespace

std::uint64_t RandomNumbers::next() {
  state_ += 0x9E3779B97F4A7C15;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

double RandomNumbers::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
}

std::uint64_t RandomNumbers::below(std::uint64_t limit) {
  return next() % limit;
}

ProjectedTriangle randomTriangle(RandomNumbers& random, const TrianglePopulation& population) {
  const bool thin = random.uniform(0, 1) < population.needle_share;
  ProjectedTriangle triangle = thin ? needle(random, population) : uniformTriangle(random, population);
  move(triangle, random);
  return triangle;
}

std::vector<ProjectedTriangle> latticeTriangles(int cells, int pitch) {
  std::vector<ProjectedTriangle> triangles;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const double i = row * pitch, j = column * pitch, i1 = i + pitch, j1 = j + pitch;
      triangles.push_back({vertexAt(i, j), vertexAt(i1, j), vertexAt(i, j1)});
      triangles.push_back({vertexAt(i, j1), vertexAt(i1, j), vertexAt(i1, j1)});
    }
  }
  return triangles;
}

}  // namespace deltaz::ars
