#include "libdb/source/mesh_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "formats/file_system.h"
#include "libdb/access/model.h"
#include "libdb/source/mesh_readers.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kMostFileBytes = 2u << 30;

enum class MeshFormat { kUnknown, kObj, kGltf, kPly, kStl, kOff };

std::string extensionOf(const std::string& path) {
  const std::string name = baseName(path);
  const std::size_t dot = name.rfind('.');
  std::string extension = dot == std::string::npos ? "" : name.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool beginsWith(const std::vector<std::byte>& bytes, std::string_view text) {
  return bytes.size() >= text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin(),
                    [](char c, std::byte b) { return static_cast<std::byte>(c) == b; });
}

// What the bytes say goes before what the name says.
MeshFormat formatOf(const std::string& path, const std::vector<std::byte>& bytes) {
  const std::string extension = extensionOf(path);
  if (beginsWith(bytes, "glTF")) return MeshFormat::kGltf;
  if (beginsWith(bytes, "ply\n") || beginsWith(bytes, "ply\r")) return MeshFormat::kPly;
  if (extension == "gltf") return MeshFormat::kGltf;
  if (extension == "obj") return MeshFormat::kObj;
  if (extension == "stl") return MeshFormat::kStl;
  if (extension == "off") return MeshFormat::kOff;
  return MeshFormat::kUnknown;
}

// A node's frame: where its origin lies in the file's space and how its axes stand there; the columns that
// are left of its transform when scale, mirroring and shear are taken out.
ModelTransform frameOf(const ModelTransform& m) {
  Vector3 x{m[0], m[1], m[2]}, y{m[3], m[4], m[5]};
  constexpr double kLeast = 1e-30;
  ModelTransform frame = kIdentityTransform;
  for (std::size_t k = 9; k < 12; ++k) frame[k] = m[k];
  if (!(length(x) > kLeast)) return frame;
  // Dividing keeps the axes of a plain scale exact.
  x = {x.x / length(x), x.y / length(x), x.z / length(x)};
  y = y - x * dot(x, y);
  if (!(length(y) > kLeast)) return frame;
  y = {y.x / length(y), y.y / length(y), y.z / length(y)};
  const Vector3 z = cross(x, y);
  return {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, m[9], m[10], m[11]};
}

// Of a rotation and a translation.
ModelTransform inverseOf(const ModelTransform& m) {
  ModelTransform inverse = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8], 0, 0, 0};
  const Vector3 back = transformPoint(inverse, {-m[9], -m[10], -m[11]});
  inverse[9] = back.x;
  inverse[10] = back.y;
  inverse[11] = back.z;
  return inverse;
}

double determinantOf(const ModelTransform& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

// Normals go with the transposed inverse, here the matrix of cofactors, which also exists for flat ones. A
// mirroring turns them round together with the triangles.
Vector3 transformNormal(const ModelTransform& m, const Vector3& n, double sign) {
  const Vector3 x{m[0], m[1], m[2]}, y{m[3], m[4], m[5]}, z{m[6], m[7], m[8]};
  const Vector3 turned = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
  const double size = length(turned);
  return size > 0 ? turned * (sign / size) : Vector3{};
}

class SceneConverter {
 public:
  SceneConverter(const std::string& path, const MeshSourceOptions& options, bool y_up)
      : path_(path), unit_(options.unit_metres), y_up_(y_up) {}

  Status add(const RawNode& node, ImportedModel& model) {
    const ModelTransform own = convert(node.transform);
    const bool top = node.parent == kNoParent;
    const ModelTransform to_file = top ? own : concatenate(own, to_file_[node.parent]);
    to_file_.push_back(to_file);
    for (const double value : to_file) {
      if (!(std::abs(value) <= kMaximumModelMetres)) return outOfRange("the transform of a node", value);
    }
    const ModelTransform frame = frameOf(to_file);
    // Both have one origin; said exactly, so that every use of a mesh gets the same positions.
    ModelTransform to_frame = concatenate(to_file, inverseOf(frame));
    to_frame[9] = to_frame[10] = to_frame[11] = 0;
    ImportedPart part;
    part.name = node.name.empty() ? model.parts.front().name : node.name;
    part.parent = top ? 0 : part_of_[node.parent];
    part.transform = top ? frame : concatenate(frame, inverseOf(frames_[node.parent]));
    frames_.push_back(frame);
    part_of_.push_back(static_cast<std::uint32_t>(model.parts.size()));
    model.parts.push_back(part);
    // One part has one or two sides; meshes of the other kind go into a part of their own.
    for (const bool two_sided : {false, true}) {
      ImportedMesh mesh;
      mesh.two_sided = two_sided;
      for (const RawMesh& raw : node.meshes) {
        if (raw.two_sided == two_sided) DELTAZ_TRY(append(raw, to_frame, node.name, mesh));
      }
      if (mesh.triangles.empty()) continue;
      if (two_sided && !model.parts[part_of_.back()].mesh.triangles.empty()) {
        ImportedPart other;
        other.name = node.name + "-two-sided";
        other.parent = part_of_.back();
        other.mesh = std::move(mesh);
        model.parts.push_back(std::move(other));
      } else {
        model.parts[part_of_.back()].mesh = std::move(mesh);
      }
    }
    return Success{};
  }

 private:
  Error outOfRange(const std::string& what, double value) const {
    if (!std::isfinite(value)) {
      return invalidError(IssueCode::kNone, path_, fmt::format("{} is no finite number", what),
                          "the file is damaged", "Check or export it again");
    }
    return invalidError(IssueCode::kNone, path_,
                        fmt::format("{} is {:.8g} m, beyond {:.0f} m", what, value, kMaximumModelMetres),
                        "these look like map coordinates, or the unit is another",
                        "Subtract an offset from all coordinates so that the model lies near the origin, or "
                        "give --units");
  }

  Vector3 convert(const std::array<double, 3>& p) const {
    return y_up_ ? Vector3{p[0], -p[2], p[1]} : Vector3{p[0], p[1], p[2]};
  }

  // The same transform between spaces whose axes were exchanged and whose unit is the metre.
  ModelTransform convert(const ModelTransform& m) const {
    ModelTransform result = m;
    if (y_up_) {
      const Vector3 x = convert(std::array{m[0], m[1], m[2]}), y = convert(std::array{m[3], m[4], m[5]});
      const Vector3 z = convert(std::array{m[6], m[7], m[8]}), t = convert(std::array{m[9], m[10], m[11]});
      result = {x.x, x.y, x.z, -z.x, -z.y, -z.z, y.x, y.y, y.z, t.x, t.y, t.z};
    }
    for (std::size_t k = 9; k < 12; ++k) result[k] *= unit_;
    return result;
  }

  Status append(const RawMesh& raw, const ModelTransform& to_frame, const std::string& name,
                ImportedMesh& mesh) const {
    if (raw.triangles.empty()) return Success{};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const bool mirrored = determinantOf(to_frame) < 0;
    for (const std::array<double, 3>& position : raw.positions) {
      const Vector3 p = transformPoint(to_frame, convert(position) * unit_);
      for (const double value : {p.x, p.y, p.z}) {
        if (!(std::abs(value) <= kMaximumModelMetres))
          return outOfRange(name.empty() ? "a coordinate" : fmt::format("a coordinate of {}", name), value);
      }
      mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    // Meshes of one node with and without normals: those without get the normals of their triangles.
    const bool had_normals = !mesh.normals.empty();
    if (!raw.normals.empty() && !had_normals) {
      for (const auto& triangle : mesh.triangles) mesh.normals.push_back(flatNormals(mesh, triangle));
    }
    for (std::size_t t = 0; t < raw.triangles.size(); ++t) {
      std::array<std::uint32_t, 3> triangle = raw.triangles[t];
      std::array<std::size_t, 3> corner = {0, 1, 2};
      if (mirrored) {
        std::swap(triangle[1], triangle[2]);
        std::swap(corner[1], corner[2]);
      }
      for (std::uint32_t& index : triangle) {
        if (index >= raw.positions.size()) {
          return invalidError(
              IssueCode::kNone, path_,
              fmt::format("a triangle of {} names vertex {} of {}", name, index, raw.positions.size()),
              "the file is damaged");
        }
        index += first;
      }
      mesh.triangles.push_back(triangle);
      std::array<SrgbColor, 3> colors = {kPlainMeshColor, kPlainMeshColor, kPlainMeshColor};
      for (std::size_t k = 0; k < 3 && !raw.colors.empty(); ++k) colors[k] = raw.colors[t][corner[k]];
      mesh.colors.push_back(colors);
      if (raw.normals.empty() && !had_normals) continue;
      std::array<std::array<float, 3>, 3> normals = flatNormals(mesh, triangle);
      for (std::size_t k = 0; k < 3 && !raw.normals.empty(); ++k) {
        const Vector3 n = transformNormal(to_frame, convert(raw.normals[t][corner[k]]), mirrored ? -1 : 1);
        // A normal that is nothing is left to the triangle.
        if (!(length(n) > 0)) continue;
        normals[k] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
      }
      mesh.normals.push_back(normals);
    }
    return Success{};
  }

  static std::array<std::array<float, 3>, 3> flatNormals(const ImportedMesh& mesh,
                                                         const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vector3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [x, y, z] = mesh.positions[triangle[k]];
      p[k] = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    }
    const Vector3 across = cross(p[1] - p[0], p[2] - p[0]);
    const Vector3 n = length(across) > 0 ? normalized(across) : Vector3{0, 0, 1};
    const std::array<float, 3> flat = {static_cast<float>(n.x), static_cast<float>(n.y),
                                       static_cast<float>(n.z)};
    return {flat, flat, flat};
  }

  const std::string& path_;
  double unit_;
  bool y_up_;
  std::vector<ModelTransform> to_file_;  // of each node
  std::vector<ModelTransform> frames_;   // of each node, in the file's space
  std::vector<std::uint32_t> part_of_;   // of each node
};

// The file's name without its ending, as the name of a part.
std::string stemOf(const std::string& path) {
  const std::string name = baseName(path);
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

// A root that carries one part alone, and does not move it, says nothing.
void dropEmptyRoots(std::vector<ImportedPart>& parts) {
  const auto isIdle = [&]() {
    return parts.size() > 1 && parts[0].mesh.triangles.empty() && parts[0].transform == kIdentityTransform &&
           std::count_if(parts.begin(), parts.end(),
                         [](const ImportedPart& part) { return part.parent == 0; }) == 1;
  };
  while (isIdle()) {
    parts.erase(parts.begin());
    for (ImportedPart& part : parts) part.parent = part.parent == 0 ? kNoParent : part.parent - 1;
  }
}

Result<RawScene> readScene(const std::string& path, const std::vector<std::byte>& bytes, MeshFormat format) {
  if (format == MeshFormat::kUnknown) {
    return invalidError(IssueCode::kNone, path, "this is no mesh in a format dbbuild reads",
                        "it is none of OBJ, PLY, STL, OFF, glTF and GLB", "Convert it to one of them");
  }
  if (format == MeshFormat::kObj || format == MeshFormat::kGltf) return readWithAssimp(path, bytes);
  return readWithOpenMesh(path, bytes);
}

// Positions pass through floats, of the readers and of the file made: far from the origin their steps show.
// Nothing if they do not.
std::string warningOfRounding(const RawNode& node, double unit) {
  std::array<double, 3> low{}, high{};
  bool any = false;
  for (const RawMesh& mesh : node.meshes) {
    for (const std::array<double, 3>& p : mesh.positions) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(p[k])) return {};
        low[k] = any ? std::min(low[k], p[k]) : p[k];
        high[k] = any ? std::max(high[k], p[k]) : p[k];
      }
      any = true;
    }
  }
  double size = 0, far = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    size = std::max(size, high[k] - low[k]);
    far = std::max({far, std::abs(low[k]), std::abs(high[k])});
  }
  const double step = std::ldexp(1.0, std::ilogb(std::max(far, 1e-30)) - 23);
  // A millimetre where the origin lies outside the mesh, and a step that is much of its size in any unit.
  constexpr double kLargestStep = 1e-3, kLargestPart = 1e-4;
  if (far <= 2 * size || !(step * unit > kLargestStep || step > kLargestPart * size)) return {};
  return fmt::format(
      "its vertices lie up to {:.8g} m from the origin and are rounded to {:.2g} m; these look like map "
      "coordinates: subtract an offset from them first",
      far * unit, step * unit);
}

}  // namespace

Result<ImportedModel> readMeshSource(const std::string& path, const MeshSourceOptions& options) {
  DELTAZ_TRY_ASSIGN(const PathType type, localFileSystem().typeOf(path));
  if (type != PathType::kFile) {
    return accessError(path, "cannot read the mesh",
                       type == PathType::kAbsent ? "there is no such file" : "it is not a file");
  }
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                    readWholeFile(localFileSystem(), path, kMostFileBytes));
  if (bytes.empty()) return invalidError(IssueCode::kNone, path, "the file is empty");
  const MeshFormat format = formatOf(path, bytes);
  DELTAZ_TRY_ASSIGN(RawScene scene, readScene(path, bytes, format));
  for (const RawNode& node : scene.nodes) {
    const std::string warning = warningOfRounding(node, options.unit_metres);
    if (warning.empty()) continue;
    scene.warnings.push_back(fmt::format("{}: {}", path, warning));
    break;
  }
  const bool y_up =
      options.up == UpAxis::kY || (options.up == UpAxis::kOfFormat && format == MeshFormat::kGltf);
  ImportedModel model;
  model.warnings = scene.warnings;
  model.content = hash128(bytes);
  model.parts.emplace_back();
  model.parts.front().name = stemOf(path);
  SceneConverter converter(path, options, y_up);
  for (const RawNode& node : scene.nodes) DELTAZ_TRY(converter.add(node, model));
  dropEmptyRoots(model.parts);
  const bool any = std::any_of(model.parts.begin(), model.parts.end(),
                               [](const ImportedPart& part) { return !part.mesh.triangles.empty(); });
  if (!any) return invalidError(IssueCode::kNone, path, "there are no triangles in the file");
  return model;
}

}  // namespace deltaz
