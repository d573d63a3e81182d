#include "libdb/build/mesh_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "libdb/build/mesh_overlay.h"

namespace deltaz {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 toCgal(const Vector3& p) {
  return {p.x, p.y, p.z};
}

double distanceTo(const std::array<Vector3, 3>& triangle, const Vector3& p) {
  const std::array<double, 3> w = nearestWeights(triangle, p);
  return length(triangle[0] * w[0] + triangle[1] * w[1] + triangle[2] * w[2] - p);
}

// A corner of a piece: where it is, the triangle of the other mesh nearest to it, and how far that is.
struct Corner {
  Vector3 position;
  std::size_t nearest = 0;
  double distance = 0;
};

struct Piece {
  double bound = 0;
  std::array<Corner, 3> corners;
  bool overlaid = false;  // lies under one triangle already, seen along its normal
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

class OneSided {
 public:
  OneSided(const TriangleView& from, const NearestTriangle& to, double least)
      : from_(from), to_(to), overlay_(to.mesh()), least_(least) {}

  // Never less than the distance of any point of `from`; `found` is one that is there.
  double bound(double& found) {
    found_ = found;
    std::vector<Corner> at_posts;
    for (const Vector3& p : from_.positions) at_posts.push_back(cornerAt(p));
    for (const auto& triangle : from_.triangles)
      push({at_posts[triangle[0]], at_posts[triangle[1]], at_posts[triangle[2]]}, false);
    // Beyond this many the bound stays looser; it holds all the same.
    const std::size_t most = 400000 + 2 * (from_.triangles.size() + to_.mesh().triangles.size());
    for (std::size_t splits = 0; splits < most && !pieces_.empty(); ++splits) {
      const Piece worst = pieces_.top();
      if (worst.bound <= enough()) break;
      pieces_.pop();
      split(worst);
    }
    found = found_;
    return std::max({found_, settled_, pieces_.empty() ? 0.0 : pieces_.top().bound});
  }

 private:
  double enough() const { return std::max(found_ * (1 + kDistanceTightness), found_ + least_); }

  Corner cornerAt(const Vector3& p) {
    Corner corner{p, to_.find(p), 0};
    corner.distance = distanceTo(to_.mesh().corners(corner.nearest), p);
    found_ = std::max(found_, corner.distance);
    return corner;
  }

  void push(const std::array<Corner, 3>& corners, bool overlaid) {
    Piece piece{std::numeric_limits<double>::infinity(), corners, overlaid};
    for (std::size_t k = 0; k < 3; ++k) {
      // Through the triangle nearest to one corner, and by how far the others are from that corner.
      const std::array<Vector3, 3> target = to_.mesh().corners(corners[k].nearest);
      double through = 0, reach = 0;
      for (const Corner& other : corners) {
        through = std::max(through, distanceTo(target, other.position));
        reach = std::max(reach, length(other.position - corners[k].position));
      }
      piece.bound = std::min({piece.bound, through, corners[k].distance + reach});
    }
    // Nothing that could decide hides in it; what it can reach is kept as a number.
    if (piece.bound <= enough()) {
      settled_ = std::max(settled_, piece.bound);
    } else {
      pieces_.push(piece);
    }
  }

  // Cut along the edges of all triangles that lie over it; if that does not work, along those of the one
  // nearest to its middle, as far as they cross it: what lies over that triangle is settled by it at once.
  // Else into four.
  void split(const Piece& piece) {
    const auto& [a, b, c] = piece.corners;
    const Vector3 middle = (a.position + b.position + c.position) * (1.0 / 3);
    const std::size_t nearest = to_.find(middle);
    bool few = true;
    if (!piece.overlaid) {
      if (overlay(piece, nearest)) return;
      // Cutting one off many triangles leaves almost all of them to be met again.
      constexpr std::size_t kFew = 16;
      few = overlay_.visited() < kFew;
    }
    if (few && cut(piece, to_.mesh().corners(nearest))) return;
    const Corner ab = cornerAt((a.position + b.position) * 0.5);
    const Corner bc = cornerAt((b.position + c.position) * 0.5);
    const Corner ca = cornerAt((c.position + a.position) * 0.5);
    push({a, ab, ca}, piece.overlaid);
    push({ab, b, bc}, piece.overlaid);
    push({ca, bc, c}, piece.overlaid);
    push({ab, bc, ca}, piece.overlaid);
  }

  bool overlay(const Piece& piece, std::size_t nearest) {
    const auto& [a, b, c] = piece.corners;
    const std::vector<OverlayPart> parts = overlay_.over({a.position, b.position, c.position}, nearest);
    for (const OverlayPart& part : parts) {
      double through = 0;
      for (const Vector3& p : part.polygon)
        through = std::max(through, distanceTo(to_.mesh().corners(part.triangle), p));
      // Nearest triangles are looked for only where it could matter.
      if (through <= enough()) {
        settled_ = std::max(settled_, through);
        continue;
      }
      std::vector<Corner> corners;
      for (const Vector3& p : part.polygon) corners.push_back(cornerAt(p));
      pushPolygon(corners, true);
    }
    return !parts.empty();
  }

  bool cut(const Piece& piece, const std::array<Vector3, 3>& target) {
    const Vector3 across = cross(target[1] - target[0], target[2] - target[0]);
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k)
      size = std::max(size, length(piece.corners[k].position - piece.corners[(k + 1) % 3].position));
    std::vector<Corner> inside(piece.corners.begin(), piece.corners.end());
    std::vector<std::vector<Corner>> outside;
    for (std::size_t k = 0; k < 3 && !inside.empty(); ++k) {
      const Vector3 edge = target[(k + 1) % 3] - target[k];
      const Vector3 inwards = cross(across, edge);
      const double scale = length(inwards);
      if (!(scale > 0)) return false;
      std::vector<Corner> left;
      cutPolygon(inside, inwards * (1 / scale), target[k], size * kSliver, left);
      if (!left.empty()) outside.push_back(std::move(left));
    }
    if (outside.empty() || inside.empty()) return false;
    pushPolygon(inside, piece.overlaid);
    for (const std::vector<Corner>& polygon : outside) pushPolygon(polygon, piece.overlaid);
    return true;
  }

  // Leaves in `polygon` what lies on the side of the plane that `normal` points to and gives the rest. What
  // is thinner than `sliver` is not cut off.
  void cutPolygon(std::vector<Corner>& polygon, const Vector3& normal, const Vector3& on_plane, double sliver,
                  std::vector<Corner>& rest) {
    std::vector<double> heights;
    double lowest = 0, highest = 0;
    for (const Corner& corner : polygon) {
      heights.push_back(dot(corner.position - on_plane, normal));
      lowest = std::min(lowest, heights.back());
      highest = std::max(highest, heights.back());
    }
    if (lowest >= -sliver) return;
    if (highest <= sliver) {
      rest.swap(polygon);
      return;
    }
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t next = (k + 1) % polygon.size();
      if (heights[k] >= 0) kept.push_back(polygon[k]);
      if (heights[k] <= 0) rest.push_back(polygon[k]);
      if ((heights[k] < 0 && heights[next] > 0) || (heights[k] > 0 && heights[next] < 0)) {
        const double t = heights[k] / (heights[k] - heights[next]);
        const Corner between = cornerAt(polygon[k].position * (1 - t) + polygon[next].position * t);
        kept.push_back(between);
        rest.push_back(between);
      }
    }
    polygon.swap(kept);
  }

  void pushPolygon(const std::vector<Corner>& polygon, bool overlaid) {
    for (std::size_t k = 2; k < polygon.size(); ++k) push({polygon[0], polygon[k - 1], polygon[k]}, overlaid);
  }

  static constexpr double kSliver = 1e-6;  // of a piece's size

  const TriangleView& from_;
  const NearestTriangle& to_;
  MeshOverlay overlay_;
  double least_;
  double found_ = 0, settled_ = 0;
  std::priority_queue<Piece> pieces_;
};

}  // namespace

std::array<double, 3> nearestWeights(const std::array<Vector3, 3>& corners, const Vector3& p) {
  // Regions of corners and edges first, each by the signs of projections (Ericson, Real-Time Collision
  // Detection, 5.1.5).
  const auto& [a, b, c] = corners;
  const Vector3 ab = b - a, ac = c - a;
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

struct NearestTriangle::Tree {
  Triangles triangles;
  AabbTree tree;
};

NearestTriangle::NearestTriangle(const TriangleView& mesh) : mesh_(mesh), tree_(std::make_unique<Tree>()) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.corners(t);
    tree_->triangles.emplace_back(toCgal(a), toCgal(b), toCgal(c));
  }
  tree_->tree.rebuild(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->tree.accelerate_distance_queries();
}

NearestTriangle::~NearestTriangle() = default;

std::size_t NearestTriangle::find(const Vector3& p) const {
  const auto found = tree_->tree.closest_point_and_primitive(toCgal(p));
  return static_cast<std::size_t>(found.second - tree_->triangles.cbegin());
}

double meshDistanceBound(const NearestTriangle& a, const NearestTriangle& b, double least) {
  // What one side found spares the other all that is nearer.
  double found = 0;
  const double there = OneSided(a.mesh(), b, least).bound(found);
  const double back = OneSided(b.mesh(), a, least).bound(found);
  return std::max(there, back);
}

}  // namespace deltaz
