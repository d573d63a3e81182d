#include "formats/model_file.h"

#include <cassert>
#include <cmath>
#include <set>

#include "formats/area.h"
#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::size_t kTreeHeaderBytes = 72, kPartBytes = 144, kLodBytes = 12, kMeshHeaderBytes = 16;
constexpr std::size_t kLongestName = 255;
constexpr std::uint8_t kCurveShaded = 1, kColoredByVertex = 2, kTwoSided = 4;
constexpr std::uint8_t kMeshFlags = kCurveShaded | kColoredByVertex | kTwoSided;

Error badTree(const std::string& where, const char* why) {
  return invalidError(IssueCode::kModelTree, where, "this is no tree of parts", why);
}

bool isDistance(double value) {
  return value >= 0 && value <= kMaximumModelMetres;
}
bool isCoordinate(double value) {
  return std::abs(value) <= kMaximumModelMetres;
}

template <typename T, std::size_t size>
void putAll(ByteWriter& writer, const std::array<T, size>& values) {
  for (const T value : values) writer.put(value);
}
template <typename T, std::size_t size>
std::array<T, size> getAll(ByteReader& reader) {
  std::array<T, size> values{};
  for (T& value : values) value = reader.get<T>();
  return values;
}

// A transform that keeps three dimensions, and numbers that are some.
bool isTransform(const ModelTransform& m) {
  for (const double value : m) {
    if (!isCoordinate(value)) return false;
  }
  const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                             m[2] * (m[3] * m[7] - m[4] * m[6]);
  return std::abs(determinant) > 0;
}

// What is wrong with a part that stands at `number`; nothing if all is right.
const char* faultOf(const ModelPart& part, std::size_t number, std::uint32_t blocks) {
  if ((number == 0) != (part.parent == kNoParent)) return "not the first part alone has no parent";
  if (number > 0 && part.parent >= number) return "a part stands before its parent";
  if (!isTransform(part.transform)) return "a transform is out of range or flattens its part";
  for (const double value : part.centre) {
    if (!isCoordinate(value)) return "a centre is out of range";
  }
  if (!isDistance(part.radius)) return "a radius is out of range";
  for (const ModelLod& lod : part.lods) {
    // The last block is the tree itself.
    if (std::uint64_t{lod.block} + 1 >= blocks) return "a mesh is not in the file";
    if (!isDistance(lod.error)) return "an error is out of range";
  }
  return nullptr;
}

}  // namespace

std::vector<std::byte> encodeModelTree(const ModelTree& tree) {
  ByteWriter writer;
  writer.put(static_cast<std::uint32_t>(tree.parts.size()));
  writer.put(std::uint32_t{0});
  putAll(writer, tree.anchor);
  putAll(writer, tree.centre);
  writer.put(tree.radius);
  writer.putZeros(kTreeHeaderBytes - writer.size());
  for (const ModelPart& part : tree.parts) {
    assert(part.name.size() <= kLongestName && part.lods.size() <= kMaximumPartLods);
    writer.put(part.parent);
    writer.put(static_cast<std::uint16_t>(part.name.size()));
    writer.put(static_cast<std::uint16_t>(part.lods.size()));
    putAll(writer, part.transform);
    putAll(writer, part.centre);
    writer.put(part.radius);
    writer.putZeros(kPartBytes - 8 - 16 * sizeof(double));
    for (const ModelLod& lod : part.lods) {
      writer.put(lod.block);
      writer.put(lod.triangle_count);
      writer.put(lod.error);
    }
    for (const char c : part.name) writer.put(static_cast<std::uint8_t>(c));
  }
  return writer.take();
}

Result<ModelTree> decodeModelTree(std::span<const std::byte> bytes, std::uint32_t blocks,
                                  const std::string& where) {
  if (bytes.size() < kTreeHeaderBytes) return badTree(where, "it is too short");
  ByteReader reader(bytes);
  ModelTree tree;
  const auto parts = reader.get<std::uint32_t>();
  const bool reserved = reader.get<std::uint32_t>() != 0;
  tree.anchor = getAll<double, 3>(reader);
  tree.centre = getAll<double, 3>(reader);
  tree.radius = reader.get<double>();
  if (reserved || reader.get<std::uint64_t>() != 0) return badTree(where, "a reserved byte is not zero");
  if (parts < 1 || parts > kMaximumModelParts || reader.remaining() / kPartBytes < parts)
    return badTree(where, "it has no parts, or more than it has bytes for");
  for (const double value : tree.anchor) {
    if (!isCoordinate(value)) return badTree(where, "the anchor is out of range");
  }
  for (const double value : tree.centre) {
    if (!isCoordinate(value)) return badTree(where, "its centre is out of range");
  }
  if (!isDistance(tree.radius)) return badTree(where, "its radius is out of range");
  std::set<std::string> names;
  for (std::uint32_t number = 0; number < parts; ++number) {
    if (reader.remaining() < kPartBytes) return badTree(where, "it ends within a part");
    ModelPart part;
    part.parent = reader.get<std::uint32_t>();
    const auto name_length = reader.get<std::uint16_t>();
    const auto lods = reader.get<std::uint16_t>();
    part.transform = getAll<double, 12>(reader);
    part.centre = getAll<double, 3>(reader);
    part.radius = reader.get<double>();
    if (reader.get<std::uint64_t>() != 0) return badTree(where, "a reserved byte is not zero");
    if (lods > kMaximumPartLods) return badTree(where, "a part has too many levels of detail");
    if (name_length < 1 || name_length > kLongestName) return badTree(where, "a part has no name");
    if (reader.remaining() < std::size_t{lods} * kLodBytes + name_length)
      return badTree(where, "it ends within a part");
    for (std::uint16_t k = 0; k < lods; ++k) {
      ModelLod lod;
      lod.block = reader.get<std::uint32_t>();
      lod.triangle_count = reader.get<std::uint32_t>();
      lod.error = reader.get<float>();
      part.lods.push_back(lod);
    }
    for (std::uint16_t k = 0; k < name_length; ++k)
      part.name.push_back(static_cast<char>(reader.get<std::uint8_t>()));
    if (!isPrintableName(part.name)) return badTree(where, "a part's name is not text");
    if (!names.insert(part.name).second) return badTree(where, "two parts have one name");
    if (const char* fault = faultOf(part, number, blocks)) return badTree(where, fault);
    tree.parts.push_back(std::move(part));
  }
  if (reader.remaining() != 0) return badTree(where, "something follows the last part");
  return tree;
}

std::size_t vertexBytes(const ModelMesh& mesh) {
  return 12 + (mesh.curveShaded() ? 6 : 0) + (mesh.colored_by_vertex ? 3 : 0);
}

std::size_t triangleBytes(const ModelMesh& mesh) {
  return 12 + (mesh.colored_by_vertex ? 0 : 3);
}

std::vector<std::byte> encodeModelMesh(const ModelMesh& mesh) {
  assert(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
  assert(mesh.colors.size() == (mesh.colored_by_vertex ? mesh.vertices.size() : mesh.triangles.size()));
  ByteWriter writer;
  writer.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  writer.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  writer.put(static_cast<std::uint8_t>((mesh.curveShaded() ? kCurveShaded : 0) |
                                       (mesh.colored_by_vertex ? kColoredByVertex : 0) |
                                       (mesh.two_sided ? kTwoSided : 0)));
  writer.putZeros(kMeshHeaderBytes - writer.size());
  for (const auto& triangle : mesh.triangles) putAll(writer, triangle);
  for (const auto& vertex : mesh.vertices) putAll(writer, vertex);
  for (const auto& normal : mesh.normals) putAll(writer, normal);
  for (const auto& color : mesh.colors) putAll(writer, color);
  return writer.take();
}

Result<ModelMesh> decodeModelMesh(std::span<const std::byte> bytes, const std::string& where) {
  const auto damaged = [&](const char* why) {
    return invalidError(IssueCode::kModelMesh, where, "this is no mesh", why);
  };
  if (bytes.size() < kMeshHeaderBytes) return damaged("it is too short");
  ByteReader reader(bytes);
  const auto triangles = reader.get<std::uint32_t>();
  const auto vertices = reader.get<std::uint32_t>();
  const auto flags = reader.get<std::uint8_t>();
  for (std::size_t k = 9; k < kMeshHeaderBytes; ++k) {
    if (reader.get<std::uint8_t>() != 0) return damaged("a reserved byte is not zero");
  }
  if ((flags & ~kMeshFlags) != 0) return damaged("it is of a form this program does not know");
  ModelMesh mesh;
  mesh.colored_by_vertex = (flags & kColoredByVertex) != 0;
  mesh.two_sided = (flags & kTwoSided) != 0;
  const bool curve_shaded = (flags & kCurveShaded) != 0;
  if (triangles < 1 || vertices < 3) return damaged("it has no triangle");
  const std::uint64_t wanted =
      std::uint64_t{triangles} * triangleBytes(mesh) +
      std::uint64_t{vertices} * (vertexBytes(mesh) + (curve_shaded ? std::size_t{6} : 0));
  if (reader.remaining() != wanted) return damaged("its counts do not fit its length");
  for (std::uint32_t t = 0; t < triangles; ++t) {
    mesh.triangles.push_back(getAll<std::uint32_t, 3>(reader));
    for (const std::uint32_t index : mesh.triangles.back()) {
      if (index >= vertices) return damaged("a triangle names a vertex that is not there");
    }
  }
  for (std::uint32_t v = 0; v < vertices; ++v) {
    mesh.vertices.push_back(getAll<float, 3>(reader));
    for (const float value : mesh.vertices.back()) {
      if (!isCoordinate(static_cast<double>(value))) return damaged("a vertex is out of range");
    }
  }
  for (std::uint32_t v = 0; curve_shaded && v < vertices; ++v) {
    mesh.normals.push_back(getAll<std::int16_t, 3>(reader));
    if (mesh.normals.back() == std::array<std::int16_t, 3>{}) return damaged("a normal is nothing");
  }
  const std::uint32_t colors = mesh.colored_by_vertex ? vertices : triangles;
  for (std::uint32_t c = 0; c < colors; ++c) mesh.colors.push_back(getAll<std::uint8_t, 3>(reader));
  return mesh;
}

}  // namespace deltaz
