#include "formats/model_file.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

#include "tests/support/byte_changes.h"

namespace deltaz {
namespace {

constexpr std::uint32_t kSampleBlocks = 4;

ModelTree sampleTree() {
  ModelTree tree;
  tree.anchor = {1, -2.5, 0};
  tree.centre = {0, 0, 4};
  tree.radius = 9.25;
  ModelPart root;
  root.name = "tower";
  root.centre = {0, 0, 3};
  root.radius = 7;
  root.lods = {{0, 12, 0}, {1, 4, 0.25f}};
  ModelPart child;
  child.name = "b\xC3\xBChne";
  child.parent = 0;
  child.transform = {0, 1, 0, -1, 0, 0, 0, 0, 1, 2, 3, 4};
  child.radius = 1;
  child.lods = {{2, 2, 0}};
  ModelPart carrier;
  carrier.name = "carrier";
  carrier.parent = 1;
  tree.parts = {root, child, carrier};
  return tree;
}

std::optional<BlockBytes> recodeTree(std::span<const std::byte> bytes) {
  const auto tree = decodeModelTree(bytes, kSampleBlocks, "test");
  if (!tree.ok()) {
    EXPECT_EQ(tree.error().code, IssueCode::kModelTree);
    return std::nullopt;
  }
  return encodeModelTree(tree.value());
}

bool accepted(const std::function<void(ModelTree&)>& change, std::uint32_t blocks = kSampleBlocks) {
  ModelTree tree = sampleTree();
  change(tree);
  return decodeModelTree(encodeModelTree(tree), blocks, "test").ok();
}

// The four forms of Table 12 and both kinds of sides.
ModelMesh sampleMesh(bool curve_shaded, bool colored_by_vertex, bool two_sided) {
  ModelMesh mesh;
  mesh.colored_by_vertex = colored_by_vertex;
  mesh.two_sided = two_sided;
  mesh.vertices = {{0, 0, 0}, {1.5f, 0, -0.0f}, {0, 2, 0}, {0, 0, -3.25f}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}};
  if (curve_shaded) mesh.normals = {{0, 0, 32767}, {-32768, 0, 0}, {1, 2, 3}, {0, -1, 0}};
  for (std::uint8_t k = 0; k < (colored_by_vertex ? 4 : 2); ++k)
    mesh.colors.push_back({k, std::uint8_t{200}, std::uint8_t{255}});
  return mesh;
}

std::vector<ModelMesh> allForms() {
  std::vector<ModelMesh> meshes;
  for (int form = 0; form < 8; ++form)
    meshes.push_back(sampleMesh((form & 1) != 0, (form & 2) != 0, (form & 4) != 0));
  return meshes;
}

std::optional<BlockBytes> recodeMesh(std::span<const std::byte> bytes) {
  const auto mesh = decodeModelMesh(bytes, "test");
  if (!mesh.ok()) {
    EXPECT_EQ(mesh.error().code, IssueCode::kModelMesh);
    return std::nullopt;
  }
  return encodeModelMesh(mesh.value());
}

TEST(ModelTree, reads_back_exactly_and_has_one_form) {
  const BlockBytes bytes = encodeModelTree(sampleTree());
  const auto back = decodeModelTree(bytes, kSampleBlocks, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), sampleTree());
  expectCutsRefused(bytes, recodeTree);
  EXPECT_GT(expectOneForm(bytes, recodeTree), 0u);
}

TEST(ModelTree, parents_stand_before_their_children) {
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_TRUE(accepted([](auto& t) { t.parts[2].parent = 0; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[2].parent = 2; })) << "its own parent";
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].parent = 2; })) << "a later one";
  EXPECT_FALSE(accepted([](auto& t) { t.parts[0].parent = 0; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].parent = kNoParent; })) << "two roots";
  EXPECT_FALSE(accepted([](auto& t) { t.parts.clear(); }));
}

TEST(ModelTree, meshes_outside_the_file_are_refused) {
  EXPECT_TRUE(accepted([](auto& t) { t.parts[1].lods[0].block = 1; }));
  // The last block is the tree itself.
  for (const std::uint32_t block : {kSampleBlocks - 1, kSampleBlocks, 0x7FFFFFFFu, 0xFFFFFFFFu})
    EXPECT_FALSE(accepted([&](auto& t) { t.parts[1].lods[0].block = block; })) << block;
  EXPECT_FALSE(accepted([](auto&) {}, 3));
  EXPECT_FALSE(accepted([](auto&) {}, 1));
}

TEST(ModelTree, names_are_text_and_unique) {
  EXPECT_TRUE(accepted([](auto& t) { t.parts[1].name = std::string(255, 'x'); }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].name.clear(); }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].name = "tower"; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].name = "a\nb"; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].name = "caf\xE9"; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].name = std::string("a\0b", 3); }));
}

TEST(ModelTree, numbers_that_are_none_or_too_large_are_refused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(accepted([](auto& t) { t.anchor[0] = -kMaximumModelMetres; }));
  for (const double odd : {kNan, kInfinity, -kInfinity, 1.001 * kMaximumModelMetres}) {
    EXPECT_FALSE(accepted([&](auto& t) { t.anchor[2] = odd; }));
    EXPECT_FALSE(accepted([&](auto& t) { t.centre[1] = odd; }));
    EXPECT_FALSE(accepted([&](auto& t) { t.radius = odd; }));
    EXPECT_FALSE(accepted([&](auto& t) { t.parts[0].centre[0] = odd; }));
    EXPECT_FALSE(accepted([&](auto& t) { t.parts[0].radius = odd; }));
    EXPECT_FALSE(accepted([&](auto& t) { t.parts[0].lods[1].error = static_cast<float>(odd); }));
    for (std::size_t k = 0; k < 12; ++k)
      EXPECT_FALSE(accepted([&](auto& t) { t.parts[1].transform[k] = odd; })) << k;
  }
  EXPECT_FALSE(accepted([](auto& t) { t.parts[0].lods[1].error = -0.001f; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[0].radius = -1; }));
  // A transform that leaves no room, or no solid.
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].transform = {}; }));
  EXPECT_FALSE(accepted([](auto& t) { t.parts[1].transform[8] = 0; }));
}

TEST(ModelTree, too_many_levels_of_detail_are_refused) {
  // The count of levels stands behind the name's length, in the bytes of the first part.
  constexpr std::size_t kCount = 72 + 6;
  BlockBytes bytes = encodeModelTree(sampleTree());
  ASSERT_EQ(std::to_integer<int>(bytes[kCount]), 2);
  bytes[kCount] = std::byte{kMaximumPartLods + 1};
  EXPECT_FALSE(recodeTree(bytes).has_value());
}

TEST(ModelTree, a_count_of_parts_is_not_believed) {
  BlockBytes bytes = encodeModelTree(sampleTree());
  for (std::size_t k = 0; k < 4; ++k) bytes[k] = std::byte{0xFF};
  EXPECT_FALSE(recodeTree(bytes).has_value());
}

TEST(ModelMesh, every_form_reads_back_exactly) {
  for (const ModelMesh& mesh : allForms()) {
    const BlockBytes bytes = encodeModelMesh(mesh);
    EXPECT_EQ(bytes.size(),
              16 + mesh.vertices.size() * vertexBytes(mesh) + mesh.triangles.size() * triangleBytes(mesh));
    const auto back = decodeModelMesh(bytes, "test");
    ASSERT_TRUE(back.ok()) << back.error().message();
    EXPECT_EQ(back.value(), mesh);
  }
}

TEST(ModelMesh, every_form_has_the_bytes_of_table_12) {
  EXPECT_EQ(vertexBytes(sampleMesh(false, false, false)), 12u);
  EXPECT_EQ(vertexBytes(sampleMesh(false, true, false)), 15u);
  EXPECT_EQ(vertexBytes(sampleMesh(true, false, false)), 18u);
  EXPECT_EQ(vertexBytes(sampleMesh(true, true, false)), 21u);
  EXPECT_EQ(triangleBytes(sampleMesh(true, true, false)), 12u);
  EXPECT_EQ(triangleBytes(sampleMesh(true, false, false)), 15u);
}

TEST(ModelMesh, every_form_has_one_spelling_and_bears_every_cut) {
  for (const ModelMesh& mesh : allForms()) {
    const BlockBytes bytes = encodeModelMesh(mesh);
    expectCutsRefused(bytes, recodeMesh);
    EXPECT_GT(expectOneForm(bytes, recodeMesh), 0u);
  }
}

RC_GTEST_PROP(ModelMesh, meshes_read_back_exactly, ()) {
  ModelMesh mesh;
  mesh.colored_by_vertex = *rc::gen::arbitrary<bool>();
  mesh.two_sided = *rc::gen::arbitrary<bool>();
  const auto vertices = *rc::gen::inRange<std::uint32_t>(3, 40);
  const auto triangles = *rc::gen::inRange<std::uint32_t>(1, 60);
  const bool curve_shaded = *rc::gen::arbitrary<bool>();
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const auto coordinate = [] { return static_cast<float>(*rc::gen::inRange(-1000000, 1000001)) / 8; };
    mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
    if (curve_shaded) {
      const auto component = [] { return static_cast<std::int16_t>(*rc::gen::inRange(-32768, 32768)); };
      mesh.normals.push_back({component(), component(), std::int16_t{1}});
    }
  }
  const auto index = [&] { return *rc::gen::inRange<std::uint32_t>(0, vertices); };
  for (std::uint32_t t = 0; t < triangles; ++t) mesh.triangles.push_back({index(), index(), index()});
  const std::uint32_t colors = mesh.colored_by_vertex ? vertices : triangles;
  for (std::uint32_t c = 0; c < colors; ++c) {
    const auto code = [] { return static_cast<std::uint8_t>(*rc::gen::inRange(0, 256)); };
    mesh.colors.push_back({code(), code(), code()});
  }
  const auto back = decodeModelMesh(encodeModelMesh(mesh), "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value() == mesh);
}

TEST(ModelMesh, counts_at_the_integer_limits_are_refused_before_anything_is_allocated) {
  for (const std::size_t place : {0u, 4u}) {
    BlockBytes bytes = encodeModelMesh(sampleMesh(true, true, false));
    for (std::size_t k = 0; k < 4; ++k) bytes[place + k] = std::byte{0xFF};
    EXPECT_FALSE(recodeMesh(bytes).has_value());
  }
}

TEST(ModelMesh, what_cannot_be_drawn_is_refused) {
  const auto mesh_accepted = [](const std::function<void(ModelMesh&)>& change) {
    ModelMesh mesh = sampleMesh(true, true, false);
    change(mesh);
    return recodeMesh(encodeModelMesh(mesh)).has_value();
  };
  EXPECT_TRUE(mesh_accepted([](auto&) {}));
  EXPECT_FALSE(mesh_accepted([](auto& m) { m.triangles.clear(); }));
  EXPECT_FALSE(mesh_accepted([](auto& m) { m.triangles[1][2] = 4; }));
  EXPECT_FALSE(mesh_accepted([](auto& m) { m.normals[3] = {0, 0, 0}; }));
  for (const float odd : {std::nanf(""), std::numeric_limits<float>::infinity(), 1.1e6f})
    EXPECT_FALSE(mesh_accepted([&](auto& m) { m.vertices[2][1] = odd; })) << odd;
}

}  // namespace
}  // namespace deltaz
