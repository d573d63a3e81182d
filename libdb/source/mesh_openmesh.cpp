// PLY, STL and OFF through OpenMesh's readers. They are given an importer that takes down what stands in the
// file: OpenMesh's own mesh would drop triangles that make an edge of three.
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <mutex>
#include <sstream>

#include "formats/bytes.h"
#include "libdb/source/mesh_readers.h"

namespace deltaz {

namespace {

using namespace OpenMesh;

std::uint8_t codeOf(float value) {
  const float code = value * 255.0F + 0.5F;
  return code >= 255.0F ? 255 : code > 0 ? static_cast<std::uint8_t>(code) : 0;
}

class SoupImporter final : public IO::BaseImporter {
 public:
  RawMesh mesh;
  std::size_t faces = 0, announced_vertices = 0, announced_faces = 0, polygons_left_out = 0;

  VertexHandle add_vertex(const Vec3f& p) override {
    return add_vertex(Vec3d(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])));
  }
  VertexHandle add_vertex(const Vec3d& p) override {
    mesh.positions.push_back({p[0], p[1], p[2]});
    return VertexHandle(static_cast<int>(mesh.positions.size() - 1));
  }
  VertexHandle add_vertex() override { return add_vertex(Vec3d(0, 0, 0)); }
  void set_point(VertexHandle v, const Vec3f& p) override {
    if (isVertex(v))
      mesh.positions[index(v)] = {static_cast<double>(p[0]), static_cast<double>(p[1]),
                                  static_cast<double>(p[2])};
  }

  FaceHandle add_face(const VHandles& corners) override {
    const auto number = static_cast<int>(faces++);
    if (corners.size() < 3) {
      ++polygons_left_out;
      return FaceHandle(number);
    }
    // A fan, as those formats mean polygons to be convex.
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({unsignedOf(corners[0]), unsignedOf(corners[k - 1]), unsignedOf(corners[k])});
      face_of_.push_back(static_cast<std::uint32_t>(number));
    }
    return FaceHandle(number);
  }

  void set_normal(VertexHandle v, const Vec3f& n) override {
    set_normal(v, Vec3d(static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])));
  }
  void set_normal(VertexHandle v, const Vec3d& n) override {
    if (!isVertex(v)) return;
    vertex_normals_.resize(mesh.positions.size());
    vertex_normals_[index(v)] = {n[0], n[1], n[2]};
  }
  void set_color(VertexHandle v, const Vec3uc& c) override {
    if (!isVertex(v)) return;
    vertex_colors_.resize(mesh.positions.size(), kPlainMeshColor);
    vertex_colors_[index(v)] = {c[0], c[1], c[2]};
  }
  void set_color(VertexHandle v, const Vec4uc& c) override { set_color(v, Vec3uc(c[0], c[1], c[2])); }
  void set_color(VertexHandle v, const Vec3f& c) override {
    set_color(v, Vec3uc(codeOf(c[0]), codeOf(c[1]), codeOf(c[2])));
  }
  void set_color(VertexHandle v, const Vec4f& c) override { set_color(v, Vec3f(c[0], c[1], c[2])); }
  void set_color(FaceHandle f, const Vec3uc& c) override {
    if (f.idx() < 0 || static_cast<std::size_t>(f.idx()) >= faces) return;
    face_colors_.resize(faces, kPlainMeshColor);
    face_colors_[static_cast<std::size_t>(f.idx())] = {c[0], c[1], c[2]};
  }
  void set_color(FaceHandle f, const Vec4uc& c) override { set_color(f, Vec3uc(c[0], c[1], c[2])); }
  void set_color(FaceHandle f, const Vec3f& c) override {
    set_color(f, Vec3uc(codeOf(c[0]), codeOf(c[1]), codeOf(c[2])));
  }
  void set_color(FaceHandle f, const Vec4f& c) override { set_color(f, Vec3f(c[0], c[1], c[2])); }
  void reserve(unsigned int vertices, unsigned int, unsigned int count) override {
    announced_vertices = vertices;
    announced_faces = count;
  }
  std::size_t n_vertices() const override { return mesh.positions.size(); }
  std::size_t n_faces() const override { return faces; }
  std::size_t n_edges() const override { return 0; }

  // What has no place in a list of triangles.
  HalfedgeHandle add_edge(VertexHandle, VertexHandle) override { return HalfedgeHandle(); }
  FaceHandle add_face(HalfedgeHandle) override { return FaceHandle(); }
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec2f>&) override {}
  void add_face_texcoords(FaceHandle, VertexHandle, const std::vector<Vec3f>&) override {}
  void set_face_texindex(FaceHandle, int) override {}
  void set_halfedge(VertexHandle, HalfedgeHandle) override {}
  void set_texcoord(VertexHandle, const Vec2f&) override {}
  void set_status(VertexHandle, const Attributes::StatusInfo&) override {}
  void set_next(HalfedgeHandle, HalfedgeHandle) override {}
  void set_face(HalfedgeHandle, FaceHandle) override {}
  void request_face_texcoords2D() override {}
  void set_texcoord(HalfedgeHandle, const Vec2f&) override {}
  void set_texcoord(VertexHandle, const Vec3f&) override {}
  void set_texcoord(HalfedgeHandle, const Vec3f&) override {}
  void set_status(HalfedgeHandle, const Attributes::StatusInfo&) override {}
  void set_color(EdgeHandle, const Vec3uc&) override {}
  void set_color(EdgeHandle, const Vec4uc&) override {}
  void set_color(EdgeHandle, const Vec3f&) override {}
  void set_color(EdgeHandle, const Vec4f&) override {}
  void set_status(EdgeHandle, const Attributes::StatusInfo&) override {}
  void set_normal(FaceHandle, const Vec3f&) override {}
  void set_normal(FaceHandle, const Vec3d&) override {}
  void set_status(FaceHandle, const Attributes::StatusInfo&) override {}
  void add_texture_information(int, std::string) override {}

  // Carries what was said of vertices and faces to the corners. Pre: every index is a vertex.
  void finishCorners() {
    vertex_normals_.resize(vertex_normals_.empty() ? 0 : mesh.positions.size());
    vertex_colors_.resize(vertex_colors_.empty() ? 0 : mesh.positions.size(), kPlainMeshColor);
    face_colors_.resize(face_colors_.empty() ? 0 : faces, kPlainMeshColor);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      if (!vertex_normals_.empty())
        mesh.normals.push_back({vertex_normals_[a], vertex_normals_[b], vertex_normals_[c]});
      if (!face_colors_.empty()) {
        const SrgbColor color = face_colors_[face_of_[t]];
        mesh.colors.push_back({color, color, color});
      } else if (!vertex_colors_.empty()) {
        mesh.colors.push_back({vertex_colors_[a], vertex_colors_[b], vertex_colors_[c]});
      }
    }
  }

 private:
  static std::size_t index(VertexHandle v) { return static_cast<std::size_t>(v.idx()); }
  static std::uint32_t unsignedOf(VertexHandle v) { return static_cast<std::uint32_t>(v.idx()); }
  bool isVertex(VertexHandle v) const { return v.idx() >= 0 && index(v) < mesh.positions.size(); }

  std::vector<std::array<double, 3>> vertex_normals_;
  std::vector<SrgbColor> vertex_colors_, face_colors_;
  std::vector<std::uint32_t> face_of_;  // of each triangle
};

Error damaged(const std::string& path, const std::string& why) {
  return invalidError(IssueCode::kNone, path, "the mesh cannot be read", why, "Check or convert the file");
}

// OpenMesh believes the count of a binary STL; "" if it fits the length, or the file is text.
std::string faultOfStl(const std::vector<std::byte>& bytes) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  const bool text = bytes.size() >= 5 && std::memcmp(bytes.data(), "solid", 5) == 0;
  if (bytes.size() < kHeader) return text ? "" : "it is too short for an STL";
  const std::uint64_t wanted =
      kHeader + std::uint64_t{kTriangle} * loadLittleEndian<std::uint32_t>(bytes, kHeader - 4);
  if (wanted == bytes.size() || text) return "";
  return fmt::format("a binary STL of as many triangles as it announces has {} bytes, this one {}", wanted,
                     bytes.size());
}

bool isTextStl(const std::vector<std::byte>& bytes) {
  return bytes.size() >= 5 && std::memcmp(bytes.data(), "solid", 5) == 0 &&
         (bytes.size() < 84 ||
          84 + std::uint64_t{50} * loadLittleEndian<std::uint32_t>(bytes, 80) != bytes.size());
}

// A text STL ends with "endsolid"; one that was cut does not.
bool endsWhole(const std::vector<std::byte>& bytes) {
  const std::string tail(static_cast<const char*>(static_cast<const void*>(bytes.data())) +
                             (bytes.size() > 512 ? bytes.size() - 512 : 0),
                         std::min<std::size_t>(bytes.size(), 512));
  return tail.find("endsolid") != std::string::npos || tail.find("ENDSOLID") != std::string::npos;
}

// OpenMesh reads a header without an end until memory is gone, and makes room for as many elements as one
// announces.
// "" if the header of a PLY ends and announces no more elements than there are bytes behind it.
std::string faultOfPly(const std::vector<std::byte>& bytes) {
  constexpr std::size_t kLongestHeader = 1 << 16;
  const std::string head(static_cast<const char*>(static_cast<const void*>(bytes.data())),
                         std::min(bytes.size(), kLongestHeader));
  const std::size_t end = head.find("end_header");
  if (end == std::string::npos) return "its header does not end";
  std::istringstream lines(head.substr(0, end));
  for (std::string word, name; lines >> word;) {
    if (word != "element") continue;
    double count = 0;
    if (!(lines >> name >> count) || !(count >= 0)) return "an element of its header has no count";
    if (count > static_cast<double>(bytes.size() - end))
      return fmt::format("it announces {:.0f} elements '{}' and has {} bytes for them", count, name,
                         bytes.size() - end);
  }
  return "";
}

Result<RawScene> read(const std::string& path, const std::vector<std::byte>& bytes) {
  if (bytes.size() >= 3 && std::memcmp(bytes.data(), "ply", 3) == 0) {
    if (const std::string fault = faultOfPly(bytes); !fault.empty()) return damaged(path, fault);
  }
  const bool stl =
      path.size() > 4 && (path.ends_with(".stl") || path.ends_with(".STL") || path.ends_with(".Stl"));
  if (stl) {
    if (const std::string fault = faultOfStl(bytes); !fault.empty()) return damaged(path, fault);
    if (isTextStl(bytes) && !endsWhole(bytes))
      return damaged(path, "it ends before its last line, 'endsolid'");
  }
  SoupImporter importer;
  IO::Options options = IO::Options::VertexNormal;
  options += IO::Options::VertexColor;
  options += IO::Options::FaceColor;
  // OpenMesh says what it does not like on a stream of the process.
  std::ostringstream said;
  bool good = false;
  {
    static std::mutex mutex;
    const std::lock_guard guard(mutex);
    omerr().disconnect(std::cerr);
    omlog().disconnect(std::clog);
    omout().disconnect(std::cout);
    omerr().connect(said);
    good = IO::IOManager().read(path, importer, options);
    omerr().disconnect(said);
  }
  std::string why = said.str();
  while (!why.empty() && why.back() == '\n') why.pop_back();
  for (char& c : why) c = c == '\n' ? ' ' : c;
  if (!good) return damaged(path, why);
  if (importer.n_vertices() < importer.announced_vertices || importer.n_faces() < importer.announced_faces) {
    return damaged(path, fmt::format("it announces {} vertices and {} faces and holds {} and {}",
                                     importer.announced_vertices, importer.announced_faces,
                                     importer.n_vertices(), importer.n_faces()));
  }
  for (const auto& triangle : importer.mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= importer.n_vertices())
        return damaged(path, fmt::format("a face names vertex {} of {}", index, importer.n_vertices()));
    }
  }
  importer.finishCorners();
  RawScene scene;
  if (importer.polygons_left_out > 0) {
    scene.warnings.push_back(fmt::format("{}: {} faces of less than three corners are left out", path,
                                         importer.polygons_left_out));
  }
  scene.nodes.emplace_back();
  scene.nodes.front().meshes.push_back(std::move(importer.mesh));
  return scene;
}

}  // namespace

Result<RawScene> readWithOpenMesh(const std::string& path, const std::vector<std::byte>& bytes) {
  try {
    return read(path, bytes);
  } catch (const std::exception& exception) {
    return damaged(path, exception.what());
  }
}

}  // namespace deltaz
