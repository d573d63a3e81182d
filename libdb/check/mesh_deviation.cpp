#include "libdb/check/mesh_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "libdb/access/vector3.h"

namespace deltaz {
namespace {

using Triangle = std::array<Vector3, 3>;

double squared(const Vector3& v) {
  return dot(v, v);
}

double toSegment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 along = b - a;
  const double size = squared(along);
  const double t = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0.0;
  return squared(p - (a + along * t));
}

// The squared distance of a point from a triangle.
double toTriangle(const Vector3& p, const Triangle& t) {
  const Vector3 ab = t[1] - t[0], ac = t[2] - t[0];
  const Vector3 normal = cross(ab, ac);
  const double size = squared(normal);
  // A sliver's plane is noise; its edges are as good as itself.
  constexpr double kThinnest = 1e-16;
  if (size > kThinnest * squared(ab) * squared(ac)) {
    bool above = true;
    for (std::size_t k = 0; k < 3 && above; ++k)
      above = dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) >= 0;
    if (above) {
      const double height = dot(p - t[0], normal);
      return height * height / size;
    }
  }
  return std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
}

// The triangles of a mesh in a tree of boxes.
class TriangleTree {
 public:
  explicit TriangleTree(const ModelMesh& mesh) {
    for (const auto& indices : mesh.triangles) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = mesh.vertices[indices[k]];
        triangle[k] = {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
      }
      triangles_.push_back(triangle);
    }
    boxes_.reserve(2 * triangles_.size() / kLeaf + 2);
    build(0, triangles_.size());
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

  struct Nearest {
    double squared_distance = std::numeric_limits<double>::infinity();
    std::size_t triangle = 0;
  };
  Nearest nearest(const Vector3& p) const {
    Nearest best;
    search(0, p, best);
    return best;
  }

 private:
  static constexpr std::size_t kLeaf = 4;
  struct Box {
    std::array<double, 3> low{}, high{};
    std::size_t begin = 0, end = 0;
    std::size_t second = 0;  // the other child; the first one follows its parent. 0 in a leaf
  };
  static std::array<double, 3> coordinates(const Vector3& v) { return {v.x, v.y, v.z}; }

  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t number = boxes_.size();
    boxes_.emplace_back();
    Box box;
    box.begin = begin;
    box.end = end;
    box.low.fill(std::numeric_limits<double>::infinity());
    box.high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t t = begin; t < end; ++t) {
      for (const Vector3& corner : triangles_[t]) {
        const auto at = coordinates(corner);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::min(box.low[axis], at[axis]);
          box.high[axis] = std::max(box.high[axis], at[axis]);
        }
      }
    }
    if (end - begin > kLeaf) {
      std::size_t longest = 0;
      for (std::size_t axis = 1; axis < 3; ++axis) {
        if (box.high[axis] - box.low[axis] > box.high[longest] - box.low[longest]) longest = axis;
      }
      const auto middle = begin + (end - begin) / 2;
      const auto place = [&](const Triangle& t) {
        return coordinates(t[0])[longest] + coordinates(t[1])[longest] + coordinates(t[2])[longest];
      };
      const auto at = [&](std::size_t t) { return triangles_.begin() + static_cast<std::ptrdiff_t>(t); };
      std::nth_element(at(begin), at(middle), at(end),
                       [&](const Triangle& a, const Triangle& b) { return place(a) < place(b); });
      build(begin, middle);
      box.second = build(middle, end);
    }
    boxes_[number] = box;
    return number;
  }

  double toBox(std::size_t number, const Vector3& p) const {
    const auto at = coordinates(p);
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d =
          std::max({boxes_[number].low[axis] - at[axis], at[axis] - boxes_[number].high[axis], 0.0});
      sum += d * d;
    }
    return sum;
  }

  void search(std::size_t number, const Vector3& p, Nearest& best) const {
    const Box& box = boxes_[number];
    if (box.second == 0) {
      for (std::size_t t = box.begin; t < box.end; ++t) {
        const double distance = toTriangle(p, triangles_[t]);
        if (distance < best.squared_distance) best = {distance, t};
      }
      return;
    }
    const double first = toBox(number + 1, p), second = toBox(box.second, p);
    const std::array<std::pair<double, std::size_t>, 2> order =
        first <= second ? std::array{std::pair(first, number + 1), std::pair(second, box.second)}
                        : std::array{std::pair(second, box.second), std::pair(first, number + 1)};
    for (const auto& [distance, child] : order) {
      if (distance < best.squared_distance) search(child, p, best);
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
};

// A triangle of one mesh, or a part of it, and how far it can lie from the other mesh.
struct Piece {
  double bound = 0;
  Triangle corners;
  const TriangleTree* other = nullptr;
  // Smallest of those that are equal last, so that the order is the same everywhere.
  std::size_t number = 0;
  bool operator<(const Piece& piece) const {
    return bound != piece.bound ? bound < piece.bound : number > piece.number;
  }
};

class Measure {
 public:
  Measure(double low, double high) : low_(low), high_(high) {}

  // The pieces of `from` against `to`.
  void addAll(const TriangleTree& from, const TriangleTree& to) {
    for (const Triangle& triangle : from.triangles()) add(triangle, to);
  }

  MeshDeviation refine() {
    constexpr std::size_t kMostPieces = 2'000'000;
    while (!pieces_.empty() && count_ < kMostPieces) {
      const double bound = pieces_.top().bound;
      if (sampled_ > high_ || bound <= low_ || (bound <= high_ && sampled_ >= low_)) break;
      const Piece piece = pieces_.top();
      pieces_.pop();
      const auto& [a, b, c] = piece.corners;
      const Vector3 ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
      for (const Triangle& part : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        add(part, *piece.other);
    }
    return {sampled_, pieces_.empty() ? std::max(sampled_, dropped_)
                                      : std::max({sampled_, dropped_, pieces_.top().bound})};
  }

 private:
  void add(const Triangle& corners, const TriangleTree& other) {
    ++count_;
    const Vector3 middle = (corners[0] + corners[1] + corners[2]) * (1.0 / 3);
    double reach = 0;
    for (const Vector3& corner : corners) reach = std::max(reach, squared(corner - middle));
    // No point of the piece lies farther away than its middle and the way there.
    std::array<TriangleTree::Nearest, 4> nearest{};
    nearest[3] = other.nearest(middle);
    double bound = std::sqrt(nearest[3].squared_distance) + std::sqrt(reach);
    sampled_ = std::max(sampled_, std::sqrt(nearest[3].squared_distance));
    for (std::size_t k = 0; k < 3; ++k) {
      nearest[k] = other.nearest(corners[k]);
      sampled_ = std::max(sampled_, std::sqrt(nearest[k].squared_distance));
    }
    // The distance from one triangle, which is convex, is largest at a corner.
    for (const TriangleTree::Nearest& candidate : nearest) {
      double largest = 0;
      for (const Vector3& corner : corners)
        largest = std::max(largest, toTriangle(corner, other.triangles()[candidate.triangle]));
      bound = std::min(bound, std::sqrt(largest));
    }
    // What lies below both thresholds decides nothing.
    if (bound <= low_) {
      dropped_ = std::max(dropped_, bound);
      return;
    }
    pieces_.push({bound, corners, &other, count_});
  }

  double low_, high_;
  double sampled_ = 0;
  double dropped_ = 0;  // largest bound of a piece that was not kept
  std::size_t count_ = 0;
  std::priority_queue<Piece> pieces_;
};

}  // namespace

MeshDeviation measureDeviation(const ModelMesh& a, const ModelMesh& b, double low, double high) {
  const TriangleTree of_a(a), of_b(b);
  Measure measure(low, high);
  measure.addAll(of_a, of_b);
  measure.addAll(of_b, of_a);
  return measure.refine();
}

}  // namespace deltaz
