// The check of a database with a colour map, a model and placements: what is found, how often, and what is
// not called wrong.
#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "libdb/access/database.h"
#include "tests/libdb/check/code_assets.h"
#include "tests/support/asset_editor.h"
#include "tests/support/furnished_area.h"
#include "tests/support/model_fixture.h"

namespace deltaz {
namespace {

constexpr std::array kAssetRoles = {FileRole::kColors, FileRole::kModel, FileRole::kPlacements};

// The one code that is reported, and how often; the report's text if there are others.
std::string found(const Report& report) {
  if (report.groups.empty()) return report.complete ? "nothing" : "incomplete";
  if (report.groups.size() > 1) return listing(report);
  return std::string(issueCodeName(report.groups[0].code)) + " x " + std::to_string(report.groups[0].count);
}

std::string foundAfter(const std::function<void(MemoryFileSystem&)>& change,
                       CheckLevel level = CheckLevel::kDecode) {
  MemoryFileSystem files = furnishedArea();
  change(files);
  return found(checkedAt(files, level));
}

bool isOnly(const std::string& found, const char* code) {
  return found.starts_with(std::string(code) + " x ");
}

TEST(FurnishedCheck, sound_databases_are_clean_at_every_level) {
  for (const CheckLevel level :
       {CheckLevel::kStructure, CheckLevel::kChecksum, CheckLevel::kDecode, CheckLevel::kGeometry})
    EXPECT_EQ(found(checkedAt(furnishedArea(), level)), "nothing");
}

TEST(FurnishedCheck, a_damaged_block_is_reported_once_at_every_level) {
  for (const FileRole role : kAssetRoles) {
    const std::string path = assetPath(furnishedArea(), role);
    const std::uint32_t blocks = blockCount(furnishedArea().bytes(path));
    for (std::uint32_t block = 0; block < blocks; ++block) {
      for (const CheckLevel level : {CheckLevel::kChecksum, CheckLevel::kDecode, CheckLevel::kGeometry}) {
        const auto flip = [&](MemoryFileSystem& files) {
          FileBytes& bytes = files.mutableBytes(path);
          bytes.at(entryOf(bytes, block).offset + 1) ^= std::byte{0x10};
        };
        EXPECT_EQ(foundAfter(flip, level), "SUM_BLOCK x 1") << path << ", block " << block;
      }
    }
  }
}

TEST(FurnishedCheck, reports_are_the_same_for_any_number_of_threads) {
  MemoryFileSystem files = furnishedArea();
  changeColors(files, [](ColorParts& parts) {
    for (const ColorNode& node : parts.nodes) {
      std::vector<std::uint8_t> texels = parts.texels(node);
      for (std::size_t k = 0; k < texels.size(); k += 4 * 97) texels[k] = texels[k + 3] == 0 ? 0 : 77;
      parts.setTexels(node, texels);
    }
  });
  changeModel(files, [](ModelParts& parts) {
    for (ModelPart& part : parts.tree.parts) part.radius *= 0.5;
  });
  std::string first;
  for (const int threads : {1, 2, 1, 2}) {
    CheckOptions options;
    options.level = CheckLevel::kGeometry;
    options.threads = threads;
    std::string text;
    for (const IssueGroup& group : checkDatabase(files, kMemoryDatabasePath, options).groups) {
      text += std::to_string(group.count);
      for (const Issue& issue : group.first) text += issue.message + "\n";
      if (group.worst) text += group.worst->message + "\n";
    }
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
  }
  EXPECT_GT(first.size(), 300u);
}

TEST(FurnishedCheck, files_missing_in_the_list_or_out_of_order_are_reported) {
  const auto with_area = [](const std::function<void(AreaHeader&)>& change) {
    return foundAfter(
        [&](MemoryFileSystem& files) {
          AreaHeader area = areaOf(files);
          change(area);
          setArea(files, area);
        },
        CheckLevel::kStructure);
  };
  const auto is = [](FileRole role) {
    return [role](const FileReference& file) { return file.role == role; };
  };
  EXPECT_EQ(with_area([](AreaHeader&) {}), "nothing");
  for (const FileRole role : kAssetRoles) {
    EXPECT_TRUE(isOnly(with_area([&](AreaHeader& area) {
                         std::find_if(area.files.begin(), area.files.end(), is(role))->segment = 1;
                       }),
                       "MAN_FIELD"));
  }
  EXPECT_TRUE(isOnly(with_area([&](AreaHeader& area) {
                       area.color_maps.push_back({"winter", "image", {}, {}});
                     }),
                     "MAN_FIELD"));
  EXPECT_TRUE(isOnly(with_area([&](AreaHeader& area) {
                       area.models.push_back({"bridge", "mesh", {}, {}});
                     }),
                     "MAN_FIELD"));
}

TEST(FurnishedCheck, a_missing_file_is_reported_and_the_rest_is_checked) {
  for (const FileRole role : kAssetRoles) {
    const auto remove = [&](MemoryFileSystem& files) {
      ASSERT_TRUE(files.removeFile(assetPath(files, role)).ok());
    };
    EXPECT_EQ(foundAfter(remove, CheckLevel::kGeometry), "IO_MISSING_FILE x 1");
  }
}

// ---- colour maps

std::string afterColors(const std::function<void(ColorParts&)>& change) {
  return foundAfter([&](MemoryFileSystem& files) { changeColors(files, change); });
}

TEST(CheckColors, records_that_make_no_tree_are_reported) {
  EXPECT_EQ(afterColors([](ColorParts&) {}), "nothing");
  const auto is_tree = [](const std::function<void(ColorParts&)>& change) {
    const std::string after = afterColors(change);
    EXPECT_TRUE(isOnly(after, "COL_TREE")) << after;
  };
  is_tree([](ColorParts& parts) { parts.nodes.back().y += 1; });
  is_tree([](ColorParts& parts) { parts.nodes.back().level += 1; });
  is_tree([](ColorParts& parts) { parts.nodes.back().grid = 1; });
  is_tree([](ColorParts& parts) { parts.nodes.front().level -= 1; });
  is_tree([](ColorParts& parts) { parts.nodes.back().block = parts.nodes.front().block; });
  is_tree([](ColorParts& parts) { parts.nodes.back().block = parts.directory.first_page; });
  is_tree([](ColorParts& parts) { parts.nodes.front().first_child = parts.directory.node_count + 1; });
  is_tree([](ColorParts& parts) { parts.nodes.front().first_child = 0xFFFFFFFF; });
  is_tree([](ColorParts& parts) { parts.nodes.front().first_child = 1; });
  is_tree([](ColorParts& parts) { parts.directory.trees[0].finest_level -= 1; });
  is_tree([](ColorParts& parts) { parts.directory.trees[0].coarsest_level += 1; });
  is_tree([](ColorParts& parts) { parts.directory.trees[0].grid = 1; });
  is_tree([](ColorParts& parts) { parts.directory.trees.clear(); });
  // A node nobody leads to.
  is_tree([](ColorParts& parts) {
    for (ColorNode& node : parts.nodes) {
      if (node.children == 0) continue;
      const auto lowest = static_cast<std::uint8_t>(node.children & -node.children);
      node.children = static_cast<std::uint8_t>(node.children & ~lowest);
      node.first_child = node.children == 0 ? 0 : node.first_child + 1;
      return;
    }
  });
}

// A tree all the same, and not breadth first.
TEST(CheckColors, children_that_do_not_follow_their_parents_order_are_reported) {
  bool swapped = false;
  const std::string after = afterColors([&](ColorParts& parts) {
    for (std::size_t a = 0; a < parts.nodes.size() && !swapped; ++a) {
      for (std::size_t b = a + 1; b < parts.nodes.size() && !swapped; ++b) {
        ColorNode &first = parts.nodes[a], &second = parts.nodes[b];
        const int children = std::popcount(first.children);
        if (first.level != second.level || children == 0 || children != std::popcount(second.children))
          continue;
        for (int k = 0; k < children; ++k) {
          std::swap(parts.nodes[first.first_child - 1 + static_cast<std::size_t>(k)],
                    parts.nodes[second.first_child - 1 + static_cast<std::size_t>(k)]);
        }
        std::swap(first.first_child, second.first_child);
        swapped = true;
      }
    }
  });
  ASSERT_TRUE(swapped) << "no two nodes have as many children";
  EXPECT_EQ(after, "COL_TREE x 1");
}

TEST(CheckColors, blocks_of_another_type_are_reported) {
  const auto retyped = [](BlockType from, BlockType to) {
    return foundAfter([&](MemoryFileSystem& files) {
      changeAsset(files, FileRole::kColors, 0, [&](std::vector<AssetBlock>& blocks) {
        for (AssetBlock& block : blocks) {
          if (block.type != from) continue;
          block.type = to;
          return;
        }
      });
    });
  };
  for (const BlockType type : {BlockType::kColorTile, BlockType::kColorPage, BlockType::kColorDirectory})
    EXPECT_TRUE(isOnly(retyped(type, BlockType::kSeam), "COL_TREE")) << retyped(type, BlockType::kSeam);
}

// A texel of the border on each side and corner that has a neighbour.
TEST(CheckColors, every_side_and_corner_of_a_border_is_compared) {
  int sides = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      bool changed = false;
      const std::string after = afterColors([&](ColorParts& parts) {
        for (const ColorNode& node : parts.nodes) {
          if (changed || parts.beside(node, dx, dy) == nullptr) continue;
          const auto place = [](int step) { return step < 0 ? -1 : step > 0 ? kColorTileTexels : 3; };
          std::vector<std::uint8_t> texels = parts.texels(node);
          const auto at = 4 * static_cast<std::size_t>((place(dy) + 1) * kColorTileSide + place(dx) + 1);
          texels[at + 1] ^= 1;
          texels[at + 3] = 255;
          parts.setTexels(node, texels);
          changed = true;
        }
      });
      if (!changed) continue;
      ++sides;
      EXPECT_EQ(after, "COL_BORDER x 1") << dx << " " << dy;
    }
  }
  EXPECT_GE(sides, 2) << "the map has no neighbours";
}

// ---- models

std::string afterModel(const std::function<void(ModelParts&)>& change,
                       CheckLevel level = CheckLevel::kDecode) {
  return foundAfter([&](MemoryFileSystem& files) { changeModel(files, change); }, level);
}

TEST(CheckModels, errors_are_bounded_from_both_sides) {
  const auto with_error = [](std::size_t part, float factor) {
    return afterModel([&](ModelParts& parts) { parts.tree.parts[part].lods[1].error *= factor; },
                      CheckLevel::kGeometry);
  };
  for (const std::size_t part : {0u, 1u}) {
    EXPECT_EQ(with_error(part, 1.0f), "nothing");
    EXPECT_EQ(with_error(part, 1.19f), "nothing");
    EXPECT_EQ(with_error(part, 1.22f), "MDL_ERROR x 1") << "too large";
    EXPECT_EQ(with_error(part, 0.9999f), "MDL_ERROR x 1") << "too small";
    EXPECT_EQ(with_error(part, 0.0f), "MDL_ERROR x 1");
    // The lower levels do not look.
    EXPECT_EQ(afterModel([&](ModelParts& parts) { parts.tree.parts[part].lods[1].error *= 0.5f; }),
              "nothing");
  }
}

TEST(CheckModels, levels_of_detail_out_of_order_are_reported) {
  EXPECT_EQ(afterModel([](ModelParts& parts) {
              auto& lods = parts.tree.parts[0].lods;
              std::swap(lods[0], lods[1]);
              lods[0].error = 0;
            }),
            "MDL_LOD x 1");
}

TEST(CheckModels, spheres_are_those_of_every_level_and_of_the_whole) {
  EXPECT_EQ(afterModel([](ModelParts& parts) { parts.tree.radius -= 0.001; }).substr(0, 10), "MDL_SPHERE");
  EXPECT_EQ(afterModel([](ModelParts& parts) {
              parts.meshes[1].vertices[0] = {300, 0, 0};
            }).substr(0, 10),
            "MDL_SPHERE");
  // A part that was turned out of the whole's sphere.
  EXPECT_EQ(afterModel([](ModelParts& parts) { parts.tree.parts[1].transform[9] += 40; }).substr(0, 10),
            "MDL_SPHERE");
}

TEST(CheckModels, a_mesh_nobody_names_is_reported) {
  EXPECT_EQ(afterModel([](ModelParts& parts) { parts.tree.parts[0].lods.pop_back(); }), "MDL_TREE x 1");
}

TEST(CheckModels, a_mirrored_part_is_a_warning) {
  EXPECT_EQ(afterModel([](ModelParts& parts) {
              for (std::size_t k = 0; k < 3; ++k) parts.tree.parts[1].transform[k] *= -1;
            }),
            "MDL_TRANSFORM x 1");
}

// ---- placements

std::string afterPlacements(const std::function<void(PlacementParts&)>& change) {
  return foundAfter([&](MemoryFileSystem& files) { changePlacements(files, change); });
}

Placement& instance(PlacementParts& parts, std::uint32_t number) {
  for (auto& page : parts.pages) {
    for (Placement& placement : page) {
      if (placement.instance == number) return placement;
    }
  }
  throw std::runtime_error("no such instance");
}

TEST(CheckPlacements, a_number_not_yet_given_is_reported) {
  EXPECT_EQ(afterPlacements([](PlacementParts& parts) { instance(parts, 2).instance = 4; }),
            "PLC_RECORD x 1");
}

// The sphere need not hold the model's own sphere, only the model.
TEST(CheckPlacements, spheres_may_be_tight) {
  const Database database = Database::open(furnishedArea(), kMemoryDatabasePath).value();
  const Model& model = database.models()[0];
  const auto set_radius = [&](double factor) {
    return afterPlacements([&](PlacementParts& parts) {
      PlacementSphere& sphere = parts.directory.pages[0];
      const Vector3 centre{sphere.centre[0], sphere.centre[1], sphere.centre[2]};
      double radius = 0;
      for (const Placement& placement : parts.pages[0]) {
        const ModelTransform to_earth =
            placementTransform(placement, model.tree().anchor, database.area().grids[0].ellipsoid);
        std::vector<ModelTransform> to_model;
        for (const ModelPart& part : model.tree().parts) {
          to_model.push_back(part.parent == kNoParent ? part.transform
                                                      : concatenate(part.transform, to_model[part.parent]));
          for (const ModelLod& lod : part.lods) {
            const ModelMesh mesh = model.mesh(lod).value();
            for (const auto& v : mesh.vertices) {
              const Vector3 vertex{static_cast<double>(v[0]), static_cast<double>(v[1]),
                                   static_cast<double>(v[2])};
              radius = std::max(
                  radius, length(transformPoint(concatenate(to_model.back(), to_earth), vertex) - centre));
            }
          }
        }
      }
      sphere.radius = radius + factor;
    });
  };
  EXPECT_EQ(set_radius(1e-5), "nothing");
  EXPECT_EQ(set_radius(-1e-5), "PLC_SPHERE x 1");
}

TEST(CheckPlacements, what_should_follow_the_ground_and_does_not_is_a_warning) {
  const auto moved = [](double latitude, double longitude) {
    return afterPlacements([&](PlacementParts& parts) {
      Placement& placement = instance(parts, 1);
      placement.latitude = latitude;
      placement.longitude = longitude;
      parts.directory.pages[0].radius = 1e6;
    });
  };
  EXPECT_EQ(moved(43.03, -79.97), "PLC_GROUND x 1");
  EXPECT_EQ(moved(42.9, -79.97), "PLC_GROUND x 1") << "there is no ground";
  // Instance 3 stands at a height of its own.
  EXPECT_EQ(afterPlacements([](PlacementParts& parts) {
              instance(parts, 3).height += 5;
              parts.directory.pages[0].radius += 5;
            }),
            "nothing");
}

}  // namespace
}  // namespace deltaz
