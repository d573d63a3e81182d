#include "libdb/source/mesh_source.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

#include "libdb/access/model.h"
#include "libdb/build/mesh_packing.h"
#include "libdb/build/mesh_repair.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

class MeshSource : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& content) const {
    const std::string path = folder_.path() + "/" + name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  static ImportedModel read(const std::string& path, const MeshSourceOptions& options = {}) {
    Result<ImportedModel> model = readMeshSource(path, options);
    if (!model.ok()) throw std::runtime_error(model.error().message());
    return std::move(model).value();
  }
  void expectRefused(const std::string& name, const std::string& content) const {
    const Result<ImportedModel> model = readMeshSource(write(name, content), {});
    ASSERT_FALSE(model.ok()) << name;
    EXPECT_EQ(model.error().kind, ErrorKind::kInvalid) << model.error().message();
    EXPECT_NE(model.error().message().find(name), std::string::npos) << model.error().message();
  }
  TemporaryDirectory folder_;
};

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

TEST_F(MeshSource, a_polygon_of_a_ply_becomes_triangles_with_the_colors_of_its_vertices) {
  const ImportedModel model =
      read(write("quad.ply", kPly + "0 0 0 255 0 0\n2 0 0 0 255 0\n2 1 0 0 0 255\n0 1 0 9 8 7\n4 0 1 2 3\n"));
  ASSERT_EQ(model.parts.size(), 1u);
  EXPECT_EQ(model.parts[0].name, "quad");
  const ImportedMesh& mesh = model.parts[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.positions[2], (std::array<float, 3>{2, 1, 0}));
  EXPECT_EQ(mesh.colors[0][1], (SrgbColor{0, 255, 0}));
  EXPECT_EQ(mesh.colors[1][2], (SrgbColor{9, 8, 7}));
  EXPECT_TRUE(mesh.normals.empty());
}

TEST_F(MeshSource, units_and_the_axis_up_are_those_that_are_given) {
  const std::string path =
      write("quad.ply", kPly + "0 0 0 1 1 1\n2 0 5 1 1 1\n2 1 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n");
  MeshSourceOptions options;
  options.unit_metres = 0.001;
  options.up = UpAxis::kY;
  const ImportedModel model = read(path, options);
  EXPECT_EQ(model.parts[0].mesh.positions[1], (std::array<float, 3>{0.002F, -0.005F, 0.0F}));
  EXPECT_EQ(model.parts[0].mesh.positions[2], (std::array<float, 3>{0.002F, 0.0F, 0.001F}));
}

const std::string kCube =
    "mtllib cube.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 0.6 0.8\nusemtl red\n"
    "f 1//1 2//1 3//1\nusemtl blue\nf 1//2 3//2 4//2\n";

TEST_F(MeshSource, triangles_of_an_obj_take_the_colors_of_their_materials_and_normals_of_corners) {
  write("cube.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 0.5\n");
  const ImportedModel model = read(write("cube.obj", kCube));
  EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
  std::size_t red = 0, blue = 0;
  for (const ImportedPart& part : model.parts) {
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const SrgbColor& color = part.mesh.colors[t][0];
      if (color == SrgbColor{255, 0, 0}) {
        ++red;
        EXPECT_FLOAT_EQ(part.mesh.normals[t][0][2], 1.0F);
      }
      if (color == SrgbColor{0, 0, 128}) {
        ++blue;
        EXPECT_FLOAT_EQ(part.mesh.normals[t][0][2], 0.8F);
      }
    }
  }
  EXPECT_EQ(red, 1u);
  EXPECT_EQ(blue, 1u);
}

TEST_F(MeshSource, materials_that_are_not_there_are_a_warning) {
  const ImportedModel model = read(write("cube.obj", kCube));
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings.front().find("cube.mtl"), std::string::npos);
}

TEST_F(MeshSource, only_materials_that_are_used_can_lack_a_texture) {
  write("cube.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 0.5\nnewmtl other\nKd 1 1 1\nmap_Kd no.png\n");
  const ImportedModel unused = read(write("cube.obj", kCube));
  EXPECT_TRUE(unused.warnings.empty()) << unused.warnings.front();
  const ImportedModel used = read(write("used.obj", kCube + "usemtl other\nf 2 3 4\n"));
  ASSERT_EQ(used.warnings.size(), 1u);
  EXPECT_NE(used.warnings[0].find("no.png"), std::string::npos) << used.warnings[0];
}

// A node with a scale, a mirroring and a translation over a triangle.
std::string gltf(const std::string& node, const std::string& material) {
  // Three positions: (0,0,0), (1,0,0), (0,1,0), base64 of 36 bytes of floats.
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"top","children":[1]},{"name":"leaf","mesh":0)" +
         node + R"(}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"materials":[)" +
         material + R"(],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST_F(MeshSource, gltf_nodes_keep_their_names_and_their_scale_goes_into_the_positions) {
  const ImportedModel model = read(write(
      "a.gltf", gltf(R"(,"scale":[-2,2,2],"translation":[10,20,30])",
                     R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0,1,1]},"doubleSided":true})")));
  const ImportedPart& leaf = model.parts.back();
  EXPECT_EQ(leaf.name, "leaf");
  ASSERT_EQ(leaf.mesh.triangles.size(), 1u);
  EXPECT_TRUE(leaf.mesh.two_sided);
  // A factor of 0.5 is linear light.
  EXPECT_EQ(leaf.mesh.colors[0][0], (SrgbColor{188, 0, 255}));
  // A part's transform turns and moves, and nothing else.
  for (std::size_t row = 0; row < 3; ++row) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) square += leaf.transform[3 * row + k] * leaf.transform[3 * row + k];
    EXPECT_NEAR(square, 1, 1e-12);
  }
  // glTF's (x, y, z) is (x, -z, y) here: the corner (1, 0, 0) comes to (10 - 2, -30, 20).
  std::vector<Vector3> placed;
  for (const auto& [x, y, z] : leaf.mesh.positions)
    placed.push_back(transformPoint(
        leaf.transform, {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
  const auto isPlaced = [&](const Vector3& wanted) {
    return std::any_of(placed.begin(), placed.end(),
                       [&](const Vector3& p) { return length(p - wanted) < 1e-5; });
  };
  EXPECT_TRUE(isPlaced({10, -30, 20}));
  EXPECT_TRUE(isPlaced({8, -30, 20}));
  EXPECT_TRUE(isPlaced({10, -30, 22}));
  // Mirroring turns a triangle over; its winding follows, so that it still faces along glTF's +z, our -y.
  const auto& [a, b, c] = leaf.mesh.triangles[0];
  EXPECT_LT(cross(placed[b] - placed[a], placed[c] - placed[a]).y, 0);
}

TEST_F(MeshSource, transparency_is_left_out_with_a_warning) {
  const ImportedModel model = read(write("a.gltf", gltf("", R"({"alphaMode":"BLEND"})")));
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings.front().find("transparency"), std::string::npos);
}

// Three vertices, and whichever indices, of 16 bits in base64.
std::string indexedGltf(const std::string& base64, std::size_t count) {
  std::string text = gltf("", "{}");
  const auto replace = [&](const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
  };
  replace(R"("material":0)", R"("material":0,"indices":1)");
  replace(R"("max":[1,1,0]})",
          R"("max":[1,1,0]},{"bufferView":1,"componentType":5123,"type":"SCALAR","count":)" +
              std::to_string(count) + "}");
  replace(R"("byteLength":36})",
          R"("byteLength":36},{"buffer":1,"byteLength":)" + std::to_string(2 * count) + "}");
  text.replace(text.rfind("]}"), 2,
               R"(,{"byteLength":)" + std::to_string(2 * count) +
                   R"(,"uri":"data:application/octet-stream;base64,)" + base64 + "\"}]}");
  return text;
}

TEST_F(MeshSource, triangles_of_a_gltf_whose_indices_are_wrong_are_not_dropped_in_silence) {
  EXPECT_EQ(read(write("good.gltf", indexedGltf("AAABAAIAAgABAAAA", 6))).parts.back().mesh.triangles.size(),
            2u);
  // The second triangle is 2, 1, 7.
  expectRefused("index.gltf", indexedGltf("AAABAAIAAgABAAcA", 6));
}

TEST_F(MeshSource, coordinates_of_a_map_are_a_warning_or_an_error_that_says_so) {
  const ImportedModel model = read(write(
      "map.obj", "v 500000.01 900000.01 0\nv 500000.04 900000.01 0\nv 500000.01 900000.51 0\nf 1 2 3\n"));
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("map coordinates"), std::string::npos) << model.warnings[0];
  // A large mesh about its origin is not one.
  EXPECT_TRUE(read(write("wide.obj", "v -90000 0 0\nv 90000 0 0\nv 0 90000 0\nf 1 2 3\n")).warnings.empty());
  const Result<ImportedModel> far = readMeshSource(
      write("far.obj", "v 500000 4100000 0\nv 500009 4100000 0\nv 500000 4100009 0\nf 1 2 3\n"), {});
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().message().find("Subtract an offset"), std::string::npos) << far.error().message();
  const Result<ImportedModel> none =
      readMeshSource(write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), {});
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message().find("no finite number"), std::string::npos) << none.error().message();
}

TEST_F(MeshSource, broken_files_are_refused_by_name) {
  expectRefused("empty.ply", "");
  expectRefused("text.obj", "this is not a mesh\n");
  expectRefused("unknown.xyz", "1 2 3\n");
  expectRefused("cut.ply", kPly + "0 0 0 1 1 1\n2 0 0 1 1 1\n");
  expectRefused("index.ply", kPly + "0 0 0 1 1 1\n2 0 0 1 1 1\n2 1 0 1 1 1\n0 1 0 1 1 1\n3 0 1 7\n");
  expectRefused("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  expectRefused("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefused("far.obj", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expectRefused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  expectRefused("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n");
  expectRefused("short.stl",
                std::string(80, 'x') + std::string("\xFF\xFF\xFF\x0F", 4) + std::string(50, '\0'));
  expectRefused("cut.glb", std::string("glTF\x02\0\0\0\xFF\0\0\0", 12));
  expectRefused("broken.gltf", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":7}]}");
  expectRefused("cut.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n");
  const Result<ImportedModel> absent = readMeshSource(folder_.path() + "/absent.obj", {});
  ASSERT_FALSE(absent.ok());
  EXPECT_EQ(absent.error().kind, ErrorKind::kCannotAccess);
}

ImportedMesh tetrahedron() {
  ImportedMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (std::uint8_t k = 0; k < 4; ++k) {
    const SrgbColor color = {k, k, k};
    mesh.colors.push_back({color, color, color});
  }
  return mesh;
}

TEST(MeshRepair, a_sound_mesh_is_left_alone) {
  ImportedMesh mesh = tetrahedron();
  const RepairReport report = repairMesh(mesh);
  EXPECT_TRUE(report.lines().empty());
  EXPECT_EQ(mesh.triangles, tetrahedron().triangles);
}

TEST(MeshRepair, lines_are_in_the_number_of_what_they_count_and_say_how_shells_are_mended) {
  RepairReport report;
  report.welded_vertices = 1;
  report.inside_out_shells = 1;
  ASSERT_EQ(report.lines().size(), 2u);
  EXPECT_EQ(report.lines()[0], "1 vertex joined with others at the same place");
  EXPECT_NE(report.lines()[1].find("1 closed shell that faces inwards kept: drawn inside out; turn"),
            std::string::npos);
  report.welded_vertices = 2;
  EXPECT_EQ(report.lines()[0], "2 vertices joined with others at the same place");
}

TEST(MeshRepair, what_is_wrong_is_counted_and_put_right) {
  ImportedMesh mesh = tetrahedron();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  mesh.positions.push_back({0, 0, 1});  // where vertex 3 stands
  mesh.triangles[3][2] = 4;
  mesh.positions.push_back({9, 9, 9});  // of no triangle
  mesh.triangles.push_back({1, 3, 0});  // given twice, turned round
  mesh.triangles.push_back({1, 1, 2});  // no area
  mesh.colors.resize(6);
  const RepairReport report = repairMesh(mesh);
  EXPECT_EQ(report.welded_vertices, 1u);
  EXPECT_EQ(report.isolated_vertices, 1u);
  EXPECT_EQ(report.duplicate_triangles, 1u);
  EXPECT_EQ(report.degenerate_triangles, 1u);
  EXPECT_EQ(report.turned_triangles, 1u);
  EXPECT_EQ(report.open_edges, 0u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::uint32_t v) {
      return Vector3{static_cast<double>(mesh.positions[v][0]), static_cast<double>(mesh.positions[v][1]),
                     static_cast<double>(mesh.positions[v][2])};
    };
    volume += dot(at(a), cross(at(b), at(c))) / 6;
  }
  EXPECT_NEAR(volume, 1.0 / 6, 1e-12);
}

TEST(MeshPacking, the_smallest_form_that_loses_nothing_is_taken) {
  ImportedMesh mesh = tetrahedron();
  // Four triangles of four colours: one colour each.
  EXPECT_FALSE(packMesh(mesh).colored_by_vertex);
  EXPECT_FALSE(packMesh(mesh).curveShaded());
  EXPECT_EQ(packMesh(mesh).vertices.size(), 4u);
  // Corners of several colours can only be given by vertex.
  mesh.colors[0][1] = {200, 0, 0};
  const ModelMesh by_vertex = packMesh(mesh);
  EXPECT_TRUE(by_vertex.colored_by_vertex);
  EXPECT_EQ(by_vertex.colors[by_vertex.triangles[0][1]], (SrgbColor{200, 0, 0}));
  // Normals that are those of the triangles are not worth their bytes.
  mesh = tetrahedron();
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto at = [&](std::uint32_t v) {
      return Vector3{static_cast<double>(mesh.positions[v][0]), static_cast<double>(mesh.positions[v][1]),
                     static_cast<double>(mesh.positions[v][2])};
    };
    const Vector3 n = normalized(cross(at(b) - at(a), at(c) - at(a)));
    const std::array<float, 3> normal = {static_cast<float>(n.x), static_cast<float>(n.y),
                                         static_cast<float>(n.z)};
    mesh.normals.push_back({normal, normal, normal});
  }
  EXPECT_FALSE(packMesh(mesh).curveShaded());
  mesh.normals[0][0] = {1, 0, 0};
  EXPECT_TRUE(packMesh(mesh).curveShaded());
}

}  // namespace
}  // namespace deltaz
