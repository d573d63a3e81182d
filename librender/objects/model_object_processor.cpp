#include "librender/objects/model_object_processor.h"

#include <cstddef>
#include <utility>

#include "libdb/access/model.h"

namespace deltaz {
namespace {

Vector3 rowOf(const ModelTransform& m, std::size_t row) {
  return {m[3 * row], m[3 * row + 1], m[3 * row + 2]};
}

template <typename T>
Vector3 toVector(const std::array<T, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

// Every corner of every face asks; there are 256 answers.
LinearColor decoded(const std::array<std::uint8_t, 3>& codes) {
  static const std::array<double, 256> kLinear = [] {
    std::array<double, 256> linear{};
    for (std::size_t code = 0; code < 256; ++code) linear[code] = decodeSrgb(static_cast<std::uint8_t>(code));
    return linear;
  }();
  return {kLinear[codes[0]], kLinear[codes[1]], kLinear[codes[2]]};
}

// Eye and sun in the part's space, and what normals become outside it.
class PartSpace {
 public:
  PartSpace(const ModelTransform& to_earth, const ViewTransform& view, const Light& light) : light_(light) {
    const Vector3 a = rowOf(to_earth, 0), b = rowOf(to_earth, 1), c = rowOf(to_earth, 2);
    // The rows' cross products are the columns of the inverse, times the determinant.
    cofactors_ = {cross(b, c), cross(c, a), cross(a, b)};
    determinant_ = dot(a, cofactors_[0]);
    eye_ = intoPart(view.eye - rowOf(to_earth, 3));
    to_sun_ = intoPart(light.to_sun);
  }

  const Vector3& eye() const { return eye_; }
  bool mirrored() const { return determinant_ < 0; }

  // Of light on a surface with this normal of any length. A plane's normal n becomes n times the transposed
  // inverse, so that (S in the part's space) . n is S . N times that vector's length.
  double intensity(const Vector3& normal) const {
    const Vector3 outside =
        (cofactors_[0] * normal.x + cofactors_[1] * normal.y + cofactors_[2] * normal.z) * (1 / determinant_);
    const double size = length(outside);
    if (!(size > 0)) return light_.ambient;
    const double cosine = dot(to_sun_, normal) / size;
    return cosine > 0 ? light_.ambient + light_.diffuse * cosine : light_.ambient;
  }

 private:
  Vector3 intoPart(const Vector3& v) const {
    return Vector3{dot(v, cofactors_[0]), dot(v, cofactors_[1]), dot(v, cofactors_[2])} * (1 / determinant_);
  }

  Light light_;
  std::array<Vector3, 3> cofactors_;
  double determinant_ = 1;
  Vector3 eye_, to_sun_;
};

}  // namespace

ModelTransform viewTransformOf(const ModelTransform& to_earth, const ViewTransform& view) {
  ModelTransform m{};
  for (std::size_t row = 0; row < 4; ++row) {
    const Vector3 v = row < 3 ? rowOf(to_earth, row) : rowOf(to_earth, 3) - view.eye;
    m[3 * row] = dot(view.forward, v);
    m[3 * row + 1] = dot(view.right, v) * view.pixels;
    m[3 * row + 2] = dot(view.down, v) * view.pixels;
  }
  return m;
}

ModelFaces modelFaces(const ModelMesh& mesh, const ModelTransform& to_earth, const ViewTransform& view,
                      const Light& light) {
  const PartSpace part(to_earth, view, light);
  const ModelTransform to_view = viewTransformOf(to_earth, view);
  ModelFaces faces;
  faces.position.reserve(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices)
    faces.position.push_back(transformPoint(to_view, toVector(vertex)));

  // Of each vertex of a curve-shaded mesh, and with its normal turned round.
  std::vector<double> lit, lit_behind;
  if (mesh.curveShaded()) {
    lit.reserve(mesh.normals.size());
    for (const auto& normal : mesh.normals) lit.push_back(part.intensity(toVector(normal)));
    for (std::size_t v = 0; mesh.two_sided && v < mesh.normals.size(); ++v)
      lit_behind.push_back(part.intensity(toVector(mesh.normals[v]) * -1));
  }

  faces.in = mesh.triangles.size();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    const Vector3 a = toVector(mesh.vertices[triangle[0]]), b = toVector(mesh.vertices[triangle[1]]),
                  c = toVector(mesh.vertices[triangle[2]]);
    const Vector3 normal = cross(b - a, c - a);
    const double towards_eye = dot(normal, part.eye() - a);
    const bool behind = towards_eye < 0;
    if (!(towards_eye > 0) && !(behind && mesh.two_sided)) {
      ++faces.back_facing;
      continue;
    }
    ModelFace& face = faces.front.emplace_back();
    face.vertex = triangle;
    face.identity = t;
    const double of_face = mesh.curveShaded() ? 0 : part.intensity(behind ? normal * -1 : normal);
    for (std::size_t k = 0; k < 3; ++k) {
      const double intensity = !mesh.curveShaded() ? of_face
                               : behind            ? lit_behind[triangle[k]]
                                                   : lit[triangle[k]];
      face.color[k] = decoded(mesh.colors[mesh.colored_by_vertex ? triangle[k] : t]) * intensity;
    }
    // Seen from behind, and seen in a mirror, the order of the corners is turned round.
    if (behind != part.mirrored()) {
      std::swap(face.vertex[1], face.vertex[2]);
      std::swap(face.color[1], face.color[2]);
    }
  }
  return faces;
}

}  // namespace deltaz
