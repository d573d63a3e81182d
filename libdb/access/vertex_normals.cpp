#include "libdb/access/vertex_normals.h"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libdb/access/vertex_normals.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

struct Vectors {
  V x, y, z;
};

Vectors loadVectors(const VectorLists& lists, std::size_t k) {
  const D d;
  return {hn::LoadU(d, &lists.x[k]), hn::LoadU(d, &lists.y[k]), hn::LoadU(d, &lists.z[k])};
}
V dotOf(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// Neighbours in the order E, NE, N, W, SW, S.
using Neighbours = std::array<Vectors, 6>;

// The vectors from a geodetic grid's posts to their neighbours, computed as differences from the start: as
// exact beside a pole, where posts stand a fraction of a millimetre apart, as anywhere else. Products of
// constants and heights change by the constant's change times one height plus the height's times the other.
class GeodeticNeighbours {
 public:
  GeodeticNeighbours(const TilePosts& posts, int j)
      : stride_(posts.stride()),
        row_(static_cast<std::size_t>(j) + 1),
        heights_(posts.heights().data()),
        south_(posts.rows()[row_ - 1]),
        here_(posts.rows()[row_]),
        north_(posts.rows()[row_ + 1]),
        columns_(posts.columns()) {}

  // Of the posts from list entry `k`, column `i` of the tile, on.
  Neighbours at(std::size_t k, std::size_t i) const {
    const D d;
    const auto set = [&](double value) { return hn::Set(d, value); };
    // The list of columns begins with the ring's.
    const auto load = [&](const std::vector<double>& list, std::size_t at) {
      return hn::LoadU(d, &list[i + at]);
    };
    const V height = hn::LoadU(d, heights_ + k);
    const auto rise = [&](std::size_t to) { return hn::Sub(hn::LoadU(d, heights_ + to), height); };
    const V distance = hn::Add(set(here_.at.a), hn::Mul(set(here_.at.b), height));
    const V east_cosine = hn::Mul(distance, load(columns_.step_cosine, 1));
    const V east_sine = hn::Mul(distance, load(columns_.step_sine, 1));
    const V west_cosine = hn::Mul(distance, load(columns_.step_cosine, 0));
    const V west_sine = hn::Mul(distance, load(columns_.step_sine, 0));
    const V north_distance = hn::Add(set(here_.step.a), hn::Mul(set(here_.step.b), height));
    const V north_z = hn::Add(set(here_.step.c), hn::Mul(set(here_.step.s), height));
    const V south_distance = hn::Add(set(south_.step.a), hn::Mul(set(south_.step.b), height));
    const V south_z = hn::Add(set(south_.step.c), hn::Mul(set(south_.step.s), height));
    // Added where a neighbour is in the same row or column: they make the sign of a zero what the general
    // expression gives.
    const V zero = hn::Zero(d), no_column = hn::Mul(distance, zero);

    const auto outwards = [&](V step, const V& cosine, const V& sine, const V& along_cosine,
                              const V& along_sine, V z) -> Vectors {
      return {hn::Add(hn::Mul(step, cosine), along_cosine), hn::Add(hn::Mul(step, sine), along_sine), z};
    };
    const auto backwards = [&](V step, const V& cosine, const V& sine, const V& along_cosine,
                               const V& along_sine, V z) -> Vectors {
      return {hn::Sub(hn::Mul(step, cosine), along_cosine), hn::Sub(hn::Mul(step, sine), along_sine), z};
    };
    const V west_c = load(columns_.cosine, 0), west_s = load(columns_.sine, 0);
    const V here_c = load(columns_.cosine, 1), here_s = load(columns_.sine, 1);
    const V east_c = load(columns_.cosine, 2), east_s = load(columns_.sine, 2);
    const V to_east = rise(k + 1), to_north_east = rise(k + stride_ + 1), to_north = rise(k + stride_);
    const V to_west = rise(k - 1), to_south_west = rise(k - stride_ - 1), to_south = rise(k - stride_);
    return {outwards(hn::Add(zero, hn::Mul(set(here_.at.b), to_east)), east_c, east_s, east_cosine, east_sine,
                     hn::Add(zero, hn::Mul(set(here_.at.s), to_east))),
            outwards(hn::Add(north_distance, hn::Mul(set(north_.at.b), to_north_east)), east_c, east_s,
                     east_cosine, east_sine, hn::Add(north_z, hn::Mul(set(north_.at.s), to_north_east))),
            outwards(hn::Add(north_distance, hn::Mul(set(north_.at.b), to_north)), here_c, here_s, no_column,
                     no_column, hn::Add(north_z, hn::Mul(set(north_.at.s), to_north))),
            backwards(hn::Add(zero, hn::Mul(set(here_.at.b), to_west)), west_c, west_s, west_cosine,
                      west_sine, hn::Add(zero, hn::Mul(set(here_.at.s), to_west))),
            backwards(hn::Sub(hn::Mul(set(south_.at.b), to_south_west), south_distance), west_c, west_s,
                      west_cosine, west_sine, hn::Sub(hn::Mul(set(south_.at.s), to_south_west), south_z)),
            outwards(hn::Sub(hn::Mul(set(south_.at.b), to_south), south_distance), here_c, here_s, no_column,
                     no_column, hn::Sub(hn::Mul(set(south_.at.s), to_south), south_z))};
  }

  Vectors up(std::size_t /*k*/, std::size_t i) const {
    const D d;
    return {hn::Mul(hn::Set(d, here_.at.b), hn::LoadU(d, &columns_.cosine[i + 1])),
            hn::Mul(hn::Set(d, here_.at.b), hn::LoadU(d, &columns_.sine[i + 1])), hn::Set(d, here_.at.s)};
  }

 private:
  std::size_t stride_, row_;
  const double* heights_;
  const RowTerms &south_, &here_, &north_;
  const ColumnTerms& columns_;
};

// The same on a projected grid, whose posts lie at least 0.1 mm apart: differences of positions, each of
// which has the same bits in whatever tile it occurs.
class ProjectedNeighbours {
 public:
  explicit ProjectedNeighbours(const TilePosts& posts) : posts_(posts) {}

  Neighbours at(std::size_t k, std::size_t /*i*/) const {
    const Vectors here = loadVectors(posts_.positions(), k);
    const auto to = [&](std::size_t other) -> Vectors {
      const Vectors there = loadVectors(posts_.positions(), other);
      return {hn::Sub(there.x, here.x), hn::Sub(there.y, here.y), hn::Sub(there.z, here.z)};
    };
    const std::size_t stride = posts_.stride();
    return {to(k + 1), to(k + stride + 1), to(k + stride), to(k - 1), to(k - stride - 1), to(k - stride)};
  }
  Vectors up(std::size_t k, std::size_t /*i*/) const { return loadVectors(posts_.ups(), k); }

 private:
  const TilePosts& posts_;
};

// table11Normal on as many posts as a vector holds.
template <bool kVoids, typename NeighboursOf>
void normalRowOf(const TilePosts& posts, int j, const NeighboursOf& neighbours_of, VectorLists& normals) {
  const D d;
  const std::size_t stride = posts.stride();
  const std::array<std::size_t, 6> behind = {1, stride + 1, stride, ~std::size_t{0}, ~stride, ~stride + 1};
  const auto columns = static_cast<std::size_t>(posts.tile().columns);
  const std::size_t first = posts.tile().index(0, j), out = static_cast<std::size_t>(j) * columns;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0), third = hn::Set(d, 1.0 / 3.0);
  const auto valid = [&](std::size_t k) { return hn::Gt(hn::LoadU(d, &posts.valid()[k]), zero); };
  for (std::size_t i = 0; i < columns; i += hn::Lanes(d)) {
    const std::size_t k = first + i;
    const Neighbours neighbours = neighbours_of.at(k, i);
    Vectors sum{zero, zero, zero};
    for (std::size_t n = 0; n < 6; ++n) {
      const Vectors &a = neighbours[n], &b = neighbours[(n + 1) % 6];
      // The centroid of the vertex (the origin here) and its two neighbours.
      const Vectors centroid{hn::Mul(hn::Add(a.x, b.x), third), hn::Mul(hn::Add(a.y, b.y), third),
                             hn::Mul(hn::Add(a.z, b.z), third)};
      const V squared = dotOf(centroid, centroid);
      auto counts = hn::Gt(squared, zero);
      if constexpr (kVoids)
        counts = hn::And(counts, hn::And(valid(k + behind[n]), valid(k + behind[(n + 1) % 6])));
      const V weight = hn::Div(one, squared);
      const auto add = [&](V so_far, V p, V q, V r, V s) {
        const V normal = hn::Sub(hn::Mul(p, q), hn::Mul(r, s));
        return hn::IfThenElse(counts, hn::Add(so_far, hn::Mul(normal, weight)), so_far);
      };
      sum.x = add(sum.x, a.y, b.z, a.z, b.y);
      sum.y = add(sum.y, a.z, b.x, a.x, b.z);
      sum.z = add(sum.z, a.x, b.y, a.y, b.x);
    }
    const V size = hn::Sqrt(dotOf(sum, sum));
    auto has_normal = hn::Gt(size, zero);
    if constexpr (kVoids) has_normal = hn::And(has_normal, valid(k));
    const V scale = hn::Div(one, size);
    const Vectors up = neighbours_of.up(k, i);
    hn::StoreU(hn::IfThenElse(has_normal, hn::Mul(sum.x, scale), up.x), d, &normals.x[out + i]);
    hn::StoreU(hn::IfThenElse(has_normal, hn::Mul(sum.y, scale), up.y), d, &normals.y[out + i]);
    hn::StoreU(hn::IfThenElse(has_normal, hn::Mul(sum.z, scale), up.z), d, &normals.z[out + i]);
  }
}

void normalRow(const TilePosts& posts, int j, VectorLists& normals) {
  const auto with = [&](const auto& neighbours_of) {
    if (posts.valid().empty()) {
      normalRowOf<false>(posts, j, neighbours_of, normals);
    } else {
      normalRowOf<true>(posts, j, neighbours_of, normals);
    }
  };
  if (posts.isGeodetic()) {
    with(GeodeticNeighbours(posts, j));
  } else {
    with(ProjectedNeighbours(posts));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {

namespace {

// D^p for the exponents that matter; D from its square.
double distancePower(double squared, int exponent) {
  switch (exponent) {
    case 0:
      return 1.0;
    case 2:
      return squared;
    case 4:
      return squared * squared;
    default:
      return std::pow(squared, 0.5 * exponent);
  }
}

}  // namespace

Vector3 table11Normal(const std::array<VertexNeighbour, 6>& neighbours, const Vector3& fallback,
                      int exponent) {
  Vector3 sum;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const VertexNeighbour& first = neighbours[k];
    const VertexNeighbour& second = neighbours[(k + 1) % neighbours.size()];
    if (!first.valid || !second.valid) continue;
    const Vector3 normal = cross(first.offset, second.offset);
    // The centroid of the vertex (the origin here) and its two neighbours.
    const Vector3 centroid = (first.offset + second.offset) * (1.0 / 3.0);
    const double squared = dot(centroid, centroid);
    if (!(squared > 0)) continue;
    sum = sum + normal * (1.0 / distancePower(squared, exponent));
  }
  const double size = length(sum);
  return size > 0 ? sum * (1.0 / size) : fallback;
}

namespace {

HWY_EXPORT(normalRow);

}  // namespace

void vertexNormals(const TilePosts& posts, VectorLists& normals) {
  const TerrainTile& tile = posts.tile();
  const std::size_t count = static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
  normals.resize(count);
  for (int j = 0; j < tile.rows; ++j) HWY_DYNAMIC_DISPATCH(normalRow)(posts, j, normals);
  // Whole vectors were written.
  normals.resize(count);
}

std::vector<Vector3> vertexNormals(const TerrainTile& tile, const GridGeometry& geometry) {
  std::vector<Vector3> normals;
  if (tile.columns < 1 || tile.rows < 1) return normals;
  TilePosts posts;
  posts.prepare(tile, geometry);
  VectorLists lists;
  vertexNormals(posts, lists);
  normals.reserve(lists.count());
  for (std::size_t k = 0; k < lists.count(); ++k) normals.push_back(lists.at(k));
  return normals;
}

}  // namespace deltaz
#endif
