#include "librender/raster/pretiler.h"

#include <algorithm>
#include <cstddef>
#include <span>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// Where a vertex lies outside the picture; a face with a common bit in all three outcodes is outside.
enum Outcode : std::uint8_t {
  kInside = 0,
  kBeforeHither = 1,
  kLeft = 2,
  kRight = 4,
  kAbove = 8,
  kBelow = 16,
  kOutsideGuardBand = 32,  // needs clipping; never a reason to reject
};
constexpr std::uint8_t kRejecting = kBeforeHither | kLeft | kRight | kAbove | kBelow;

// Boxes up to this many samples are searched at once for a covered one; most faces of a distant terrain have
// none.
constexpr std::int32_t kSmallBox = 4;

struct PlacedVertex {
  ScreenVertex screen;  // set unless before the hither plane
  std::int32_t x = 0, y = 0;
  std::uint8_t outcode = kInside;
};

PlacedVertex place(const ViewTransform& view, const Vector3& p) {
  PlacedVertex placed;
  // Half spaces through the eye, valid for any sign of U.
  const double across = view.width / 2.0 * p.x, downward = view.height / 2.0 * p.x;
  if (p.x < kHither) placed.outcode |= kBeforeHither;
  if (p.y < -across) placed.outcode |= kLeft;
  if (p.y > across) placed.outcode |= kRight;
  if (p.z < -downward) placed.outcode |= kAbove;
  if (p.z > downward) placed.outcode |= kBelow;
  if ((placed.outcode & kBeforeHither) != 0) return placed;
  const double guard = kGuardBand * p.x;
  if (p.y < -guard || p.y > guard || p.z < -guard || p.z > guard) {
    placed.outcode |= kOutsideGuardBand;
    return placed;
  }
  placed.screen = project(view, p);
  placed.x = snap(placed.screen.j);
  placed.y = snap(placed.screen.i);
  return placed;
}

// A corner of a face while it is clipped, with its barycentric weights.
struct ClipVertex {
  Vector3 position;
  double weight1 = 0, weight2 = 0;
};

// A convex polygon in view space; five planes add at most one corner each.
class ClipPolygon {
 public:
  explicit ClipPolygon(const std::array<ClipVertex, 3>& face) : size_(3) {
    std::copy(face.begin(), face.end(), corners_.begin());
  }

  // Keeps what has plane . position >= offset.
  void clip(const Vector3& plane, double offset) {
    std::array<ClipVertex, 8> kept;
    std::size_t count = 0;
    for (std::size_t k = 0; k < size_; ++k) {
      const ClipVertex &from = corners_[k], &to = corners_[k + 1 < size_ ? k + 1 : 0];
      const double from_side = dot(plane, from.position) - offset, to_side = dot(plane, to.position) - offset;
      if (from_side >= 0) kept[count++] = from;
      if ((from_side >= 0) != (to_side >= 0)) {
        kept[count++] =
            from_side >= 0 ? crossing(from, from_side, to, to_side) : crossing(to, to_side, from, from_side);
      }
    }
    corners_ = kept;
    size_ = count;
  }

  std::span<const ClipVertex> corners() const { return {corners_.data(), size_}; }

 private:
  static ClipVertex crossing(const ClipVertex& inside, double inside_side, const ClipVertex& outside,
                             double outside_side) {
    const double t = inside_side / (inside_side - outside_side);
    return {inside.position + (outside.position - inside.position) * t,
            inside.weight1 + (outside.weight1 - inside.weight1) * t,
            inside.weight2 + (outside.weight2 - inside.weight2) * t};
  }

  std::array<ClipVertex, 8> corners_;
  std::size_t size_;
};

struct WeightedScreenVertex {
  ScreenVertex screen;
  double weight1 = 0, weight2 = 0;
};

// Positive for a face seen from its front: the order of a face's vertices is clockwise on the screen once
// reversed.
double screenArea(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return (c.j - a.j) * (b.i - a.i) - (b.j - a.j) * (c.i - a.i);
}

// Gradients by differences from the first vertex, in double, on unsnapped positions.
void setPlanes(const std::array<WeightedScreenVertex, 3>& vertices, FacePlanes& face) {
  const auto& [a, b, c] = vertices;
  face.anchor_j = a.screen.j;
  face.anchor_i = a.screen.i;
  const double bj = b.screen.j - a.screen.j, bi = b.screen.i - a.screen.i;
  const double cj = c.screen.j - a.screen.j, ci = c.screen.i - a.screen.i;
  const double determinant = bj * ci - cj * bi;
  // A face that is a line but for rounding keeps the values of its first vertex.
  const double inverse = determinant != 0 ? 1 / determinant : 0;
  const auto plane = [&](double at_a, double at_b, double at_c) {
    const double db = at_b - at_a, dc = at_c - at_a;
    return ScreenPlane{at_a, (db * ci - dc * bi) * inverse, (bj * dc - cj * db) * inverse};
  };
  face.inverse_u = plane(a.screen.inverse_u, b.screen.inverse_u, c.screen.inverse_u);
  face.weight1 =
      plane(a.weight1 * a.screen.inverse_u, b.weight1 * b.screen.inverse_u, c.weight1 * c.screen.inverse_u);
  face.weight2 =
      plane(a.weight2 * a.screen.inverse_u, b.weight2 * b.screen.inverse_u, c.weight2 * c.screen.inverse_u);
}

std::array<float, 3> toFloats(const LinearColor& color) {
  return {static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue)};
}

void setAttributes(const TerrainVertices& vertices, const TerrainFace& face, std::uint32_t record,
                   FacePlanes& planes) {
  for (std::size_t k = 0; k < 3; ++k) {
    planes.color[k] = toFloats(vertices.color[face.vertex[k]]);
    planes.intensity[k] = static_cast<float>(vertices.intensity[face.vertex[k]]);
  }
  planes.texture = vertices.texture[face.vertex[0]];
  for (std::size_t k = 0; k < 2; ++k) {
    const GridCoordinates& to = vertices.texture[face.vertex[k + 1]];
    planes.texture_steps[k] = {to.column - planes.texture.column, to.row - planes.texture.row};
  }
  planes.identity = std::uint64_t{record} << 32 | face.identity;
}

// False only if the triangle covers no sample of the picture; small boxes are searched, larger ones are left
// to the tiler, which counts the few of them that turn out empty.
bool mayCoverSamples(const SnappedTriangle& triangle, int width, int height) {
  const SampleBounds bounds = sampleBounds(triangle, width, height);
  if (bounds.empty() || doubledArea(triangle) <= 0) return false;
  if (bounds.last_j - bounds.first_j >= kSmallBox || bounds.last_i - bounds.first_i >= kSmallBox) return true;
  bool covers = false;
  forEachSample(triangle, bounds, [&](std::int32_t, std::int32_t) { covers = true; });
  return covers;
}

}  // namespace

Pretiler::Pretiler(const ViewTransform& view) : view_(view) {}

void Pretiler::process(const TerrainVertices& vertices, const TerrainFaces& faces, std::uint32_t record,
                       PretiledNode& out) const {
  const auto set_attributes = [&](const TerrainFace& face, FacePlanes& planes) {
    setAttributes(vertices, face, record, planes);
  };
  processFaces(vertices.position, faces.front, set_attributes, out);
}

void Pretiler::process(const ModelFaces& faces, std::uint32_t instance, PretiledNode& out) const {
  const auto set_attributes = [&](const ModelFace& face, FacePlanes& planes) {
    for (std::size_t k = 0; k < 3; ++k) planes.color[k] = toFloats(face.color[k]);
    planes.identity = std::uint64_t{instance} << 32 | face.identity;
    planes.surface = Surface::kModel;
  };
  processFaces(faces.position, faces.front, set_attributes, out);
}

template <typename Face, typename SetAttributes>
void Pretiler::processFaces(const std::vector<Vector3>& position, const std::vector<Face>& faces,
                            const SetAttributes& set_attributes, PretiledNode& out) const {
  // Each vertex is projected and snapped once, though about six faces use it.
  std::vector<PlacedVertex> placed;
  placed.reserve(position.size());
  for (const Vector3& p : position) placed.push_back(place(view_, p));

  for (const Face& face : faces) {
    const PlacedVertex &a = placed[face.vertex[0]], &b = placed[face.vertex[1]], &c = placed[face.vertex[2]];
    if ((a.outcode & b.outcode & c.outcode & kRejecting) != 0) {
      ++out.clipped;
      continue;
    }
    if (((a.outcode | b.outcode | c.outcode) & (kBeforeHither | kOutsideGuardBand)) != 0) {
      FacePlanes planes;
      set_attributes(face, planes);
      clipAndEmit({position[face.vertex[0]], position[face.vertex[1]], position[face.vertex[2]]}, planes,
                  out);
      continue;
    }
    SnappedTriangle triangle;
    triangle.x = {a.x, c.x, b.x};
    triangle.y = {a.y, c.y, b.y};
    if (!mayCoverSamples(triangle, view_.width, view_.height)) {
      ++out.no_sample;
      continue;
    }
    triangle.face = static_cast<std::uint32_t>(out.faces.size());
    out.triangles.push_back(triangle);
    FacePlanes& planes = out.faces.emplace_back();
    setPlanes({{{a.screen, 0, 0}, {b.screen, 1, 0}, {c.screen, 0, 1}}}, planes);
    const auto [least, greatest] = std::minmax({a.screen.inverse_u, b.screen.inverse_u, c.screen.inverse_u});
    planes.least = least;
    planes.greatest = greatest;
    set_attributes(face, planes);
  }
}

void Pretiler::clipAndEmit(const std::array<Vector3, 3>& corners_of_face, FacePlanes planes,
                           PretiledNode& out) const {
  ClipPolygon polygon({{{corners_of_face[0], 0, 0}, {corners_of_face[1], 1, 0}, {corners_of_face[2], 0, 1}}});
  polygon.clip({1, 0, 0}, kHither);
  if (polygon.corners().size() < 3) {
    ++out.clipped;
    return;
  }
  std::vector<WeightedScreenVertex> corners;
  for (const ClipVertex& corner : polygon.corners()) {
    corners.push_back({project(view_, corner.position), corner.weight1, corner.weight2});
    const double inverse_u = corners.back().screen.inverse_u;
    planes.least = corners.size() == 1 ? inverse_u : std::min(planes.least, inverse_u);
    planes.greatest = std::max(planes.greatest, inverse_u);
  }
  // Of a quadrilateral the larger half has the better determined gradients.
  const bool second_half =
      corners.size() == 4 && screenArea(corners[0].screen, corners[2].screen, corners[3].screen) >
                                 screenArea(corners[0].screen, corners[1].screen, corners[2].screen);
  setPlanes({corners[0], corners[second_half ? 2 : 1], corners[second_half ? 3 : 2]}, planes);

  const double guard = kGuardBand;
  polygon.clip({guard, 1, 0}, 0);
  polygon.clip({guard, -1, 0}, 0);
  polygon.clip({guard, 0, 1}, 0);
  polygon.clip({guard, 0, -1}, 0);
  std::vector<std::array<std::int32_t, 2>> snapped;
  for (const ClipVertex& corner : polygon.corners()) {
    const ScreenVertex screen = project(view_, corner.position);
    snapped.push_back({snap(screen.j), snap(screen.i)});
  }
  if (snapped.size() < 3) {
    ++out.clipped;
    return;
  }

  const auto index = static_cast<std::uint32_t>(out.faces.size());
  bool emitted = false;
  for (std::size_t k = 1; k + 1 < snapped.size(); ++k) {
    const auto &a = snapped[0], &b = snapped[k + 1], &c = snapped[k];
    const SnappedTriangle triangle{{a[0], b[0], c[0]}, {a[1], b[1], c[1]}, index};
    if (!mayCoverSamples(triangle, view_.width, view_.height)) continue;
    out.triangles.push_back(triangle);
    emitted = true;
  }
  if (emitted) {
    out.faces.push_back(planes);
  } else {
    ++out.no_sample;
  }
}

}  // namespace deltaz
