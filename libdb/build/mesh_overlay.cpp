#include "libdb/build/mesh_overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace deltaz {

namespace {

struct Point {
  double x = 0, y = 0;
};

Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y};
}

double across(const Point& a, const Point& b) {
  return a.x * b.y - a.y * b.x;
}

Point between(const Point& a, const Point& b, double t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

// How far w lies to the left of the way from u to v; nothing if that way has no length.
double leftOf(const Point& u, const Point& v, const Point& w) {
  const double size = std::hypot(v.x - u.x, v.y - u.y);
  return size > 0 ? across(v - u, w - u) / size : 0;
}

// The piece in its own plane, counterclockwise.
class Frame {
 public:
  static std::optional<Frame> of(const std::array<Vector3, 3>& piece) {
    const Vector3 ab = piece[1] - piece[0], ac = piece[2] - piece[0];
    const Vector3 normal = cross(ab, ac);
    // A sliver's normal is noise.
    constexpr double kThinnest = 1e-5;
    Frame frame;
    frame.size_ = std::max({length(ab), length(ac), length(ac - ab)});
    if (!(length(normal) > kThinnest * frame.size_ * frame.size_)) return std::nullopt;
    frame.origin_ = piece[0];
    frame.x_ = normalized(ab);
    frame.y_ = normalized(cross(normal, ab));
    for (std::size_t k = 0; k < 3; ++k) frame.corners_[k] = frame.flat(piece[k]);
    return frame;
  }

  double size() const { return size_; }
  Point flat(const Vector3& p) const { return {dot(p - origin_, x_), dot(p - origin_, y_)}; }
  Vector3 lifted(const Point& p) const { return origin_ + x_ * p.x + y_ * p.y; }

  bool meetsSegment(const Point& u, const Point& v, double margin) const {
    double from = 0, to = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at_u = height(k, u) + margin, at_v = height(k, v) + margin;
      if (at_u < 0 && at_v < 0) return false;
      if (at_u < 0) from = std::max(from, at_u / (at_u - at_v));
      if (at_v < 0) to = std::min(to, at_u / (at_u - at_v));
    }
    return from <= to;
  }

  // What of a convex polygon lies within the piece.
  std::vector<Point> clip(std::vector<Point> polygon) const {
    for (std::size_t edge = 0; edge < 3 && !polygon.empty(); ++edge) {
      std::vector<Point> kept;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Point &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
        const double at_here = height(edge, here), at_next = height(edge, next);
        if (at_here >= 0) kept.push_back(here);
        if ((at_here < 0 && at_next > 0) || (at_here > 0 && at_next < 0))
          kept.push_back(between(here, next, at_here / (at_here - at_next)));
      }
      polygon.swap(kept);
    }
    return polygon;
  }

 private:
  double height(std::size_t k, const Point& p) const { return leftOf(corners_[k], corners_[(k + 1) % 3], p); }

  Vector3 origin_, x_, y_;
  std::array<Point, 3> corners_;
  double size_ = 0;
};

}  // namespace

MeshOverlay::MeshOverlay(const TriangleView& mesh)
    : mesh_(mesh),
      neighbours_(mesh.triangles.size(), {kNone, kNone, kNone}),
      round_of_(mesh.triangles.size(), 0) {
  // Lesser vertex, greater vertex, triangle, and which of its edges.
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t u = mesh.triangles[t][k], v = mesh.triangles[t][(k + 1) % 3];
      edges.emplace_back(std::min(u, v), std::max(u, v), t, k);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
    const auto same = [&](std::size_t k) {
      return std::get<0>(edges[k]) == std::get<0>(edges[first]) &&
             std::get<1>(edges[k]) == std::get<1>(edges[first]);
    };
    while (end < edges.size() && same(end)) ++end;
    if (end - first != 2) continue;
    const auto& [u1, v1, t1, k1] = edges[first];
    const auto& [u2, v2, t2, k2] = edges[first + 1];
    neighbours_[t1][k1] = t2;
    neighbours_[t2][k2] = t1;
  }
}

std::vector<OverlayPart> MeshOverlay::over(const std::array<Vector3, 3>& piece, std::size_t first) {
  waiting_.clear();
  const std::optional<Frame> frame = Frame::of(piece);
  if (!frame) return {};
  // What is met by this little more than the piece has to be whole as well, so that rounding hides no gap.
  constexpr double kMargin = 1e-9;
  const double margin = kMargin * frame->size();
  std::vector<OverlayPart> parts;
  ++round_;
  waiting_.push_back(static_cast<std::uint32_t>(first));
  round_of_[first] = round_;
  for (std::size_t next = 0; next < waiting_.size(); ++next) {
    const std::uint32_t t = waiting_[next];
    const auto corners = mesh_.corners(t);
    const std::array<Point, 3> flat = {frame->flat(corners[0]), frame->flat(corners[1]),
                                       frame->flat(corners[2])};
    const std::vector<Point> shared = frame->clip({flat.begin(), flat.end()});
    if (next == 0 && shared.size() < 3) return {};
    if (shared.size() >= 3) {
      OverlayPart part{t, {}};
      for (const Point& p : shared) part.polygon.push_back(frame->lifted(p));
      parts.push_back(std::move(part));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &u = flat[k], &v = flat[(k + 1) % 3];
      if (!frame->meetsSegment(u, v, margin)) continue;
      const std::uint32_t neighbour = neighbours_[t][k];
      if (neighbour == kNone) return {};
      // The two lie on either side of their edge, so that together they cover what is around it; then a
      // vertex is surrounded as well, and what is covered of the piece ends nowhere within it.
      std::uint32_t apex = 0;
      for (const std::uint32_t vertex : mesh_.triangles[neighbour]) {
        if (vertex != mesh_.triangles[t][k] && vertex != mesh_.triangles[t][(k + 1) % 3]) apex = vertex;
      }
      const double here = leftOf(u, v, flat[(k + 2) % 3]);
      const double there = leftOf(u, v, frame->flat(mesh_.positions[apex]));
      if (std::min(std::abs(here), std::abs(there)) <= margin || (here > 0) == (there > 0)) return {};
      if (round_of_[neighbour] == round_) continue;
      round_of_[neighbour] = round_;
      waiting_.push_back(neighbour);
    }
  }
  return parts;
}

}  // namespace deltaz
