#include "librender/ars/pretiler/pretiler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace deltaz::ars {

namespace {

// A convex polygon: a triangle that five planes add one corner each to.
template <class Corner>
struct Polygon {
  std::array<Corner, 8> corner{};
  std::size_t corners = 0;
};

// Keeps what has inside(corner) >= 0. `between(a, b, t)` is the corner so far from a to b.
template <class Corner, class Inside, class Between>
Polygon<Corner> cut(const Polygon<Corner>& polygon, Inside inside, Between between) {
  Polygon<Corner> kept;
  for (std::size_t k = 0; k < polygon.corners; ++k) {
    const Corner& a = polygon.corner[k];
    const Corner& b = polygon.corner[k + 1 == polygon.corners ? 0 : k + 1];
    const double of_a = inside(a), of_b = inside(b);
    if (of_a >= 0) kept.corner[kept.corners++] = a;
    if ((of_a >= 0) == (of_b >= 0)) continue;
    kept.corner[kept.corners++] =
        of_a >= 0 ? between(a, b, of_a / (of_a - of_b)) : between(b, a, of_b / (of_b - of_a));
  }
  return kept;
}

double mixed(double a, double b, double t) {
  return a + (b - a) * t;
}

bool isFinite(const ViewVertex& vertex) {
  return std::isfinite(vertex.u) && std::isfinite(vertex.v) && std::isfinite(vertex.w) &&
         std::all_of(vertex.color.begin(), vertex.color.end(), [](double c) { return std::isfinite(c); });
}

struct OnScreen {
  ScreenPosition at;
  double inverse_u = 0;
  std::array<double, kColors> color{};
};

// Twice the area.
double area(const ScreenPosition& a, const ScreenPosition& b, const ScreenPosition& c) {
  return (b.i - a.i) * (c.j - a.j) - (c.i - a.i) * (b.j - a.j);
}

// Pre: the three positions are not in line.
ScreenPlane planeOf(const std::array<const OnScreen*, 3>& vertex, const std::array<double, 3>& value) {
  const ScreenPosition& a = vertex[0]->at;
  const double bi = vertex[1]->at.i - a.i, bj = vertex[1]->at.j - a.j;
  const double ci = vertex[2]->at.i - a.i, cj = vertex[2]->at.j - a.j;
  const double determinant = bi * cj - ci * bj;
  const double db = value[1] - value[0], dc = value[2] - value[0];
  return {value[0], (db * cj - dc * bj) / determinant, (dc * bi - db * ci) / determinant};
}

using Part = std::array<const OnScreen*, 3>;

double areaOf(const Part& part) {
  return std::abs(area(part[0]->at, part[1]->at, part[2]->at));
}

std::array<double, 3> inverseDepths(const Part& part) {
  return {part[0]->inverse_u, part[1]->inverse_u, part[2]->inverse_u};
}

// Of one part; 1/U has the same gradient in all of them, `inverse_u`.
ScreenPlanes planesOf(const Part& part, const ScreenPlane& inverse_u) {
  ScreenPlanes planes;
  planes.anchor = part[0]->at;
  planes.inverse_u = {part[0]->inverse_u, inverse_u.per_i, inverse_u.per_j};
  for (std::size_t c = 0; c < kColors; ++c) {
    planes.color[c] = planeOf(part, {part[0]->color[c], part[1]->color[c], part[2]->color[c]});
    planes.color_over_u[c] =
        planeOf(part, {part[0]->color[c] * part[0]->inverse_u, part[1]->color[c] * part[1]->inverse_u,
                       part[2]->color[c] * part[2]->inverse_u});
  }
  const std::array<double, 3> depths = inverseDepths(part);
  planes.least_inverse_u = *std::min_element(depths.begin(), depths.end());
  planes.greatest_inverse_u = *std::max_element(depths.begin(), depths.end());
  return planes;
}

// What of a part is on the screen.
Polygon<ScreenPosition> cutToScreen(const Part& part, double right, double bottom, bool& is_cut) {
  Polygon<ScreenPosition> polygon;
  polygon.corners = part.size();
  is_cut = false;
  for (std::size_t k = 0; k < part.size(); ++k) {
    const ScreenPosition& p = polygon.corner[k] = part[k]->at;
    is_cut = is_cut || p.i < 0 || p.i > bottom || p.j < 0 || p.j > right;
  }
  if (!is_cut) return polygon;
  // The coordinate that is cut is set, not computed, so that no rounding leaves the screen.
  const auto at_j = [](double j) {
    return [j](const ScreenPosition& a, const ScreenPosition& b, double t) {
      return ScreenPosition{mixed(a.i, b.i, t), j};
    };
  };
  const auto at_i = [](double i) {
    return [i](const ScreenPosition& a, const ScreenPosition& b, double t) {
      return ScreenPosition{i, mixed(a.j, b.j, t)};
    };
  };
  polygon = cut(
      polygon, [&](const ScreenPosition& p) { return right - p.j; }, at_j(right));
  polygon = cut(
      polygon, [](const ScreenPosition& p) { return p.i; }, at_i(0));
  polygon = cut(
      polygon, [](const ScreenPosition& p) { return p.j; }, at_j(0));
  return cut(
      polygon, [&](const ScreenPosition& p) { return bottom - p.i; }, at_i(bottom));
}

}  // namespace

PretilerCounts& PretilerCounts::operator+=(const PretilerCounts& other) {
  in += other.in;
  beyond_yon += other.beyond_yon;
  before_hither += other.before_hither;
  beside += other.beside;
  edge_on += other.edge_on;
  drawn += other.drawn;
  cut_by_hither += other.cut_by_hither;
  cut_by_screen += other.cut_by_screen;
  out += other.out;
  return *this;
}

void Pretiler::process(const ViewTriangle& triangle, std::vector<ScreenTriangle>& out,
                       PretilerCounts& counts) const {
  ++counts.in;
  const auto& vertex = triangle.vertex;
  if (!std::all_of(vertex.begin(), vertex.end(), isFinite)) {
    ++counts.edge_on;
    return;
  }
  if (std::min({vertex[0].u, vertex[1].u, vertex[2].u}) > view_.yon) {
    ++counts.beyond_yon;
    return;
  }
  Polygon<ViewVertex> in_view;
  std::copy(vertex.begin(), vertex.end(), in_view.corner.begin());
  in_view.corners = vertex.size();
  const bool cut_by_hither = std::min({vertex[0].u, vertex[1].u, vertex[2].u}) < view_.hither;
  if (cut_by_hither) {
    in_view = cut(
        in_view, [&](const ViewVertex& p) { return p.u - view_.hither; },
        [&](const ViewVertex& a, const ViewVertex& b, double t) {
          ViewVertex p{view_.hither, mixed(a.v, b.v, t), mixed(a.w, b.w, t), {}};
          for (std::size_t c = 0; c < kColors; ++c) p.color[c] = mixed(a.color[c], b.color[c], t);
          return p;
        });
    if (in_view.corners < 3) {
      ++counts.before_hither;
      return;
    }
  }

  Polygon<OnScreen> projected;
  projected.corners = in_view.corners;
  for (std::size_t k = 0; k < in_view.corners; ++k) {
    const ViewVertex& p = in_view.corner[k];
    projected.corner[k] = {{view_.centre_i + p.w / p.u, view_.centre_j + p.v / p.u}, 1 / p.u, p.color};
  }
  const double bottom = view_.lines - 1, right = view_.pixels - 1;
  const auto all_beside = [&](auto outside) {
    return std::all_of(projected.corner.begin(),
                       projected.corner.begin() + static_cast<std::ptrdiff_t>(projected.corners),
                       [&](const OnScreen& v) { return outside(v.at); });
  };
  if (all_beside([&](const ScreenPosition& p) { return p.j > right; }) ||
      all_beside([](const ScreenPosition& p) { return p.i < 0; }) ||
      all_beside([](const ScreenPosition& p) { return p.j < 0; }) ||
      all_beside([&](const ScreenPosition& p) { return p.i > bottom; })) {
    ++counts.beside;
    return;
  }
  std::array<Part, 2> parts{};
  std::size_t largest = 0;
  for (std::size_t k = 0; k + 2 < projected.corners; ++k) {
    parts[k] = {&projected.corner[0], &projected.corner[k + 1], &projected.corner[k + 2]};
    if (areaOf(parts[k]) > areaOf(parts[largest])) largest = k;
  }
  const ScreenPlane inverse_u = planeOf(parts[largest], inverseDepths(parts[largest]));
  if (!std::isfinite(inverse_u.per_i) || !std::isfinite(inverse_u.per_j)) {
    ++counts.edge_on;
    return;
  }
  bool is_drawn = false, any_cut = false;
  for (std::size_t n = 0; n + 2 < projected.corners; ++n) {
    if (!(areaOf(parts[n]) > 0)) continue;
    bool is_cut = false;
    const Polygon<ScreenPosition> polygon = cutToScreen(parts[n], right, bottom, is_cut);
    if (polygon.corners < 3) continue;
    is_drawn = true;
    any_cut = any_cut || is_cut;
    const ScreenPlanes planes = planesOf(parts[n], inverse_u);
    for (std::size_t k = 1; k + 1 < polygon.corners; ++k)
      out.push_back({{polygon.corner[0], polygon.corner[k], polygon.corner[k + 1]}, planes});
    counts.out += polygon.corners - 2;
  }
  ++(is_drawn ? counts.drawn : counts.beside);
  counts.cut_by_hither += is_drawn && cut_by_hither ? 1 : 0;
  counts.cut_by_screen += any_cut ? 1 : 0;
}

}  // namespace deltaz::ars
