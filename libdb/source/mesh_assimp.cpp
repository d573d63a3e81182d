// OBJ and glTF through assimp: what has a tree of nodes, materials, and normals of its own at each corner.
#include <algorithm>
#include <assimp/GltfMaterial.h>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>
#include <exception>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

#include "formats/file_system.h"
#include "libdb/source/gltf_triangles.h"
#include "libdb/source/mesh_readers.h"
#include "libdb/source/mesh_texture.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kMostTextureBytes = 1u << 28;

// Columns of assimp's matrices are the images of the axes.
ModelTransform transformOf(const aiMatrix4x4& m) {
  const auto value = [](ai_real v) { return static_cast<double>(v); };
  return {value(m.a1), value(m.b1), value(m.c1), value(m.a2), value(m.b2), value(m.c2),
          value(m.a3), value(m.b3), value(m.c3), value(m.a4), value(m.b4), value(m.c4)};
}

struct Material {
  LinearColor color{1, 1, 1};
  const MeshTexture* texture = nullptr;
  unsigned int coordinates = 0;  // which set of texture coordinates
  bool two_sided = false;
};

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const std::string& path, bool gltf)
      : scene_(scene), path_(path), gltf_(gltf) {}

  Result<RawScene> read() {
    // What no mesh is made of is not looked at: what it lacks is no loss.
    std::set<unsigned int> used;
    for (unsigned int m = 0; m < scene_.mNumMeshes; ++m) used.insert(scene_.mMeshes[m]->mMaterialIndex);
    for (unsigned int m = 0; m < scene_.mNumMaterials; ++m)
      materials_.push_back(used.contains(m) ? readMaterial(*scene_.mMaterials[m]) : Material{});
    if (scene_.mNumAnimations > 0) warn("animations are left out; parts stand as they do by default");
    // A node's children come right after all nodes of its depth: parents before children.
    std::vector<std::pair<const aiNode*, std::uint32_t>> waiting = {{scene_.mRootNode, kNoParent}};
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      if (waiting.size() > kMaximumModelParts) {
        return invalidError(IssueCode::kNone, path_, "there are too many nodes",
                            fmt::format("a model has at most {} parts", kMaximumModelParts));
      }
      const auto [node, parent] = waiting[k];
      DELTAZ_TRY(addNode(*node, parent));
      for (unsigned int c = 0; c < node->mNumChildren; ++c)
        waiting.emplace_back(node->mChildren[c], static_cast<std::uint32_t>(k));
    }
    if (left_out_ > 0) warn(fmt::format("{} points and lines are left out", left_out_));
    return std::move(result_);
  }

 private:
  // Each once.
  void warn(const std::string& text) {
    if (said_.insert(text).second) result_.warnings.push_back(fmt::format("{}: {}", path_, text));
  }

  Material readMaterial(const aiMaterial& source) {
    Material material;
    aiColor4D color(1, 1, 1, 1);
    // The colours of glTF are linear, those of OBJ codes as a screen shows them.
    if (gltf_ && source.Get(AI_MATKEY_BASE_COLOR, color) == aiReturn_SUCCESS) {
      material.color = {static_cast<double>(color.r), static_cast<double>(color.g),
                        static_cast<double>(color.b)};
    } else if (source.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
      material.color = {gltf_ ? static_cast<double>(color.r) : linearOf(color.r),
                        gltf_ ? static_cast<double>(color.g) : linearOf(color.g),
                        gltf_ ? static_cast<double>(color.b) : linearOf(color.b)};
    }
    int two_sided = 0;
    material.two_sided = source.Get(AI_MATKEY_TWOSIDED, two_sided) == aiReturn_SUCCESS && two_sided != 0;
    aiString mode;
    float opacity = 1;
    const bool blended = gltf_ && source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == aiReturn_SUCCESS &&
                         std::string(mode.C_Str()) != "OPAQUE";
    const bool seen_through =
        !gltf_ && source.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && opacity < 1;
    if (blended || seen_through) warn("transparency is left out; its triangles are drawn opaque");
    aiString name;
    unsigned int coordinates = 0;
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &name, nullptr, &coordinates) == aiReturn_SUCCESS ||
        source.GetTexture(aiTextureType_BASE_COLOR, 0, &name, nullptr, &coordinates) == aiReturn_SUCCESS) {
      material.texture = textureNamed(name.C_Str());
      material.coordinates = coordinates;
    }
    return material;
  }

  static double linearOf(float code) {
    return decodeSrgb(static_cast<std::uint8_t>(std::clamp(code, 0.0F, 1.0F) * 255.0F + 0.5F));
  }

  // Null, with a warning, if it cannot be read.
  const MeshTexture* textureNamed(const std::string& name) {
    const auto known = textures_.find(name);
    if (known != textures_.end()) return known->second ? &*known->second : nullptr;
    std::optional<MeshTexture>& texture = textures_[name];
    Result<MeshTexture> decoded = loadTexture(name);
    if (decoded.ok()) {
      texture = std::move(decoded).value();
      return &*texture;
    }
    warn(fmt::format("without a texture: {}", decoded.error().message()));
    return nullptr;
  }

  Result<MeshTexture> loadTexture(const std::string& name) const {
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str())) {
      if (embedded->mHeight != 0)
        return invalidError(IssueCode::kNone, name, "the texture is of a kind not read");
      return MeshTexture::decode(
          std::as_bytes(std::span(static_cast<const char*>(static_cast<const void*>(embedded->pcData)),
                                  embedded->mWidth)),
          name);
    }
    // Files beside the mesh, and nothing that reaches elsewhere.
    if (name.empty() || name.front() == '/' || name.find("://") != std::string::npos) {
      return invalidError(IssueCode::kNone, name, "the texture does not lie beside the mesh");
    }
    std::string relative = name;
    std::replace(relative.begin(), relative.end(), '\\', '/');
    const std::string path = joinPath(parentPath(path_), relative);
    DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                      readWholeFile(localFileSystem(), path, kMostTextureBytes));
    return MeshTexture::decode(bytes, path);
  }

  Status addNode(const aiNode& source, std::uint32_t parent) {
    RawNode node;
    node.name = source.mName.C_Str();
    // Assimp's name for what an OBJ says before it names an object; the file's own name says more.
    if (node.name == "defaultobject") node.name.clear();
    node.parent = parent;
    node.transform = transformOf(source.mTransformation);
    for (unsigned int k = 0; k < source.mNumMeshes; ++k) {
      if (source.mMeshes[k] >= scene_.mNumMeshes)
        return invalidError(IssueCode::kNone, path_, "a node names a mesh that is not there");
      node.meshes.push_back(readMesh(*scene_.mMeshes[source.mMeshes[k]]));
    }
    result_.nodes.push_back(std::move(node));
    return Success{};
  }

  RawMesh readMesh(const aiMesh& source) {
    RawMesh mesh;
    if (source.HasBones()) warn("skins are left out; the mesh stands in its default pose");
    if (source.mNumAnimMeshes > 0) warn("morph targets are left out");
    const Material* material =
        source.mMaterialIndex < materials_.size() ? &materials_[source.mMaterialIndex] : nullptr;
    mesh.two_sided = material != nullptr && material->two_sided;
    for (unsigned int v = 0; v < source.mNumVertices; ++v)
      mesh.positions.push_back(toArray(source.mVertices[v]));
    const bool plain = material == nullptr && !source.HasVertexColors(0);
    for (unsigned int f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) {
        ++left_out_;
        continue;
      }
      const std::array<std::uint32_t, 3> corners = {face.mIndices[0], face.mIndices[1], face.mIndices[2]};
      mesh.triangles.push_back(corners);
      const bool inside = std::all_of(corners.begin(), corners.end(),
                                      [&](std::uint32_t v) { return v < source.mNumVertices; });
      if (source.HasNormals()) {
        mesh.normals.emplace_back();
        for (std::size_t k = 0; inside && k < 3; ++k)
          mesh.normals.back()[k] = toArray(source.mNormals[corners[k]]);
      }
      if (plain) continue;
      mesh.colors.push_back({kPlainMeshColor, kPlainMeshColor, kPlainMeshColor});
      if (inside) mesh.colors.back() = colorsOf(source, material, corners);
    }
    return mesh;
  }

  std::array<SrgbColor, 3> colorsOf(const aiMesh& source, const Material* material,
                                    const std::array<std::uint32_t, 3>& corners) const {
    LinearColor base = material != nullptr ? material->color : LinearColor{1, 1, 1};
    if (material != nullptr && material->texture != nullptr &&
        source.HasTextureCoords(material->coordinates)) {
      std::array<std::array<double, 2>, 3> at{};
      for (std::size_t k = 0; k < 3; ++k) {
        const aiVector3D& uv = source.mTextureCoords[material->coordinates][corners[k]];
        at[k] = {static_cast<double>(uv.x), static_cast<double>(uv.y)};
      }
      const bool finite = std::all_of(at.begin(), at.end(), [](const std::array<double, 2>& uv) {
        return std::abs(uv[0]) < 1e6 && std::abs(uv[1]) < 1e6;
      });
      if (finite) {
        const LinearColor texel = material->texture->mean(at);
        base = {base.red * texel.red, base.green * texel.green, base.blue * texel.blue};
      }
    }
    std::array<SrgbColor, 3> colors{};
    for (std::size_t k = 0; k < 3; ++k) {
      LinearColor color = base;
      if (source.HasVertexColors(0)) {
        const aiColor4D& c = source.mColors[0][corners[k]];
        color = gltf_
                    ? LinearColor{base.red * static_cast<double>(c.r), base.green * static_cast<double>(c.g),
                                  base.blue * static_cast<double>(c.b)}
                    : LinearColor{linearOf(c.r), linearOf(c.g), linearOf(c.b)};
      }
      colors[k] = {encodeSrgb(color.red), encodeSrgb(color.green), encodeSrgb(color.blue)};
    }
    return colors;
  }

  static std::array<double, 3> toArray(const aiVector3D& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  const aiScene& scene_;
  const std::string& path_;
  bool gltf_;
  std::vector<Material> materials_;
  std::map<std::string, std::optional<MeshTexture>> textures_;
  std::set<std::string> said_;
  std::size_t left_out_ = 0;
  RawScene result_;
};

// Libraries of materials an OBJ names and that are not there: assimp goes on in silence.
std::vector<std::string> missingMaterials(const std::string& path) {
  std::vector<std::string> missing;
  const Result<std::vector<std::byte>> bytes = readWholeFile(localFileSystem(), path, 2u << 30);
  if (!bytes.ok()) return missing;
  const std::string text(static_cast<const char*>(static_cast<const void*>(bytes.value().data())),
                         bytes.value().size());
  for (std::size_t at = text.find("mtllib "); at != std::string::npos; at = text.find("mtllib ", at + 1)) {
    if (at > 0 && text[at - 1] != '\n') continue;
    std::string name = text.substr(at + 7, text.find_first_of("\r\n", at) - at - 7);
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.pop_back();
    const Result<PathType> type = localFileSystem().typeOf(joinPath(parentPath(path), name));
    if (!type.ok() || type.value() != PathType::kFile) missing.push_back(name);
  }
  return missing;
}

std::uint64_t trianglesOf(const aiScene& scene) {
  std::uint64_t count = 0;
  for (unsigned int m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned int f = 0; f < mesh.mNumFaces; ++f) count += mesh.mFaces[f].mNumIndices == 3 ? 1 : 0;
  }
  return count;
}

Result<RawScene> read(const std::string& path, const std::vector<std::byte>& bytes) {
  Assimp::Importer importer;
  constexpr unsigned int kSteps = aiProcess_Triangulate | aiProcess_TransformUVCoords;
  const aiScene* scene = importer.ReadFile(path, kSteps);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    return invalidError(IssueCode::kNone, path, "the mesh cannot be read", importer.GetErrorString(),
                        "Check or convert the file");
  }
  const bool obj =
      path.size() > 4 && (path.ends_with(".obj") || path.ends_with(".OBJ") || path.ends_with(".Obj"));
  if (const std::uint64_t announced = obj ? 0 : announcedTriangles(bytes); trianglesOf(*scene) < announced) {
    return invalidError(
        IssueCode::kNone, path,
        fmt::format("only {} of its {} triangles can be read", trianglesOf(*scene), announced),
        "indices name vertices that are not there", "Check or export it again");
  }
  DELTAZ_TRY_ASSIGN(RawScene raw, SceneReader(*scene, path, !obj).read());
  if (obj) {
    for (const std::string& name : missingMaterials(path)) {
      raw.warnings.push_back(
          fmt::format("{}: the materials of {} are not there; their triangles are plain", path, name));
    }
  }
  return raw;
}

}  // namespace

Result<RawScene> readWithAssimp(const std::string& path, const std::vector<std::byte>& bytes) {
  try {
    return read(path, bytes);
  } catch (const std::exception& exception) {
    return invalidError(IssueCode::kNone, path, "the mesh cannot be read", exception.what());
  }
}

}  // namespace deltaz
