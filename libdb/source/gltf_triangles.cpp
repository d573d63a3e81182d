#include "libdb/source/gltf_triangles.h"

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/bytes.h"

namespace deltaz {

namespace {

using Json = nlohmann::json;

Json documentOf(const std::vector<std::byte>& bytes) {
  constexpr std::size_t kLengthAt = 12, kDocumentAt = 20;
  std::size_t begin = 0, end = bytes.size();
  // "glTF" opens a GLB, whose first chunk is the document.
  if (bytes.size() > kDocumentAt && bytes[0] == std::byte{'g'}) {
    begin = kDocumentAt;
    end = std::min<std::uint64_t>(end, begin + loadLittleEndian<std::uint32_t>(bytes, kLengthAt));
  }
  const auto* text = static_cast<const char*>(static_cast<const void*>(bytes.data()));
  return Json::parse(text + begin, text + end);
}

std::uint64_t trianglesOf(const Json& document, const Json& primitive) {
  const Json& attributes = primitive.at("attributes");
  if (!attributes.contains("POSITION")) return 0;
  const std::size_t corners = primitive.value("indices", attributes.at("POSITION").get<std::size_t>());
  const auto count = document.at("accessors").at(corners).at("count").get<std::uint64_t>();
  switch (primitive.value("mode", 4)) {
    case 4:
      return count / 3;
    case 5:  // strip
    case 6:  // fan
      return count < 3 ? 0 : count - 2;
    default:
      return 0;
  }
}

std::uint64_t count(const Json& document) {
  if (!document.at("asset").at("version").get<std::string>().starts_with("2")) return 0;
  const Json& nodes = document.at("nodes");
  const Json& scene = document.at("scenes").at(document.value("scene", std::size_t{0}));
  std::vector<std::size_t> waiting = scene.value("nodes", std::vector<std::size_t>{});
  std::set<std::size_t> met(waiting.begin(), waiting.end()), meshes;
  while (!waiting.empty()) {
    const Json& node = nodes.at(waiting.back());
    waiting.pop_back();
    if (node.contains("mesh")) meshes.insert(node.at("mesh").get<std::size_t>());
    for (const std::size_t child : node.value("children", std::vector<std::size_t>{})) {
      if (met.insert(child).second) waiting.push_back(child);
    }
  }
  std::uint64_t sum = 0;
  for (const std::size_t mesh : meshes) {
    for (const Json& primitive : document.at("meshes").at(mesh).at("primitives"))
      sum += trianglesOf(document, primitive);
  }
  return sum;
}

}  // namespace

std::uint64_t announcedTriangles(const std::vector<std::byte>& bytes) {
  try {
    return count(documentOf(bytes));
  } catch (const std::exception&) {
    return 0;
  }
}

}  // namespace deltaz
