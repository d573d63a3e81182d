// Errors that records and leaves state, changed; found at level geometry only.
#include <gtest/gtest.h>
#include <stdexcept>

#include "tests/libdb/check/code_assets.h"

namespace deltaz {

namespace {

constexpr CheckLevel kGeometry = CheckLevel::kGeometry;

// A node that ends short of the area's edge, and has no void: its coverage error is a distance.
std::uint32_t edgeNode(const DatabaseEditor& editor) {
  for (std::uint32_t number = 1; number <= editor.records.size(); ++number) {
    const NodeRecord& node = editor.records[number - 1];
    if (node.type == NodeType::kTerrain && node.level > 0 && node.coverage_error > 1000 &&
        node.coverage_error != kUnknownError && (node.flags & kNodeHasVoids) == 0) {
      return number;
    }
  }
  throw std::runtime_error("no such node");
}

}  // namespace

std::vector<Asset> errorAssets() {
  return {
      {IssueCode::kErrGeometric,
       byEditing([](DatabaseEditor& editor) { editor.record(innerCoarseNode(editor)).geometric_error /= 2; },
                 kGeometry),
       // A unit more is what rounding may do.
       byEditing([](DatabaseEditor& editor) { editor.record(innerCoarseNode(editor)).geometric_error += 1; },
                 kGeometry)},
      {IssueCode::kErrRms,
       byEditing([](DatabaseEditor& editor) { editor.record(innerCoarseNode(editor)).rms_error += 200; },
                 kGeometry),
       byEditing([](DatabaseEditor& editor) { editor.record(innerCoarseNode(editor)).rms_error += 1; },
                 kGeometry)},
      {IssueCode::kErrAncestor,
       byEditing(
           [](DatabaseEditor& editor) {
             TerrainBlock block = editor.block(innerLeaf(editor));
             block.ancestors.at(0).posts += 1;
             editor.setBlock(innerLeaf(editor), block);
           },
           kGeometry),
       byEditing(changeAncestorErrors, kGeometry)},
      {IssueCode::kErrCoverage,
       byEditing([](DatabaseEditor& editor) { editor.record(edgeNode(editor)).coverage_error /= 2; },
                 kGeometry),
       byEditing([](DatabaseEditor& editor) { editor.record(edgeNode(editor)).coverage_error += 1; },
                 kGeometry)},
  };
}

TEST(WrongErrors, too_large_or_unknown_is_wrong_too) {
  const auto expectOne = [](IssueCode code, const std::function<void(DatabaseEditor&)>& edit) {
    const Report report = byEditing(edit, kGeometry)(soundDatabase());
    ASSERT_EQ(report.groups.size(), 1u) << listing(report);
    EXPECT_EQ(report.groups[0].code, code) << listing(report);
    EXPECT_EQ(report.groups[0].count, 1u) << listing(report);
  };
  expectOne(IssueCode::kErrGeometric, [](DatabaseEditor& editor) {
    NodeRecord& node = editor.record(innerCoarseNode(editor));
    node.geometric_error += node.geometric_error / 50 + 5;
  });
  expectOne(IssueCode::kErrGeometric, [](DatabaseEditor& editor) {
    editor.record(innerCoarseNode(editor)).geometric_error = kUnknownError;
  });
  expectOne(IssueCode::kErrGeometric,
            [](DatabaseEditor& editor) { editor.record(innerLeaf(editor)).geometric_error = 1; });
  expectOne(IssueCode::kErrCoverage, [](DatabaseEditor& editor) {
    NodeRecord& node = editor.record(edgeNode(editor));
    node.coverage_error += node.coverage_error / 10;
  });
  expectOne(IssueCode::kErrCoverage,
            [](DatabaseEditor& editor) { editor.record(edgeNode(editor)).coverage_error = kUnknownError; });
  expectOne(IssueCode::kErrRms,
            [](DatabaseEditor& editor) { editor.record(innerCoarseNode(editor)).rms_error = kUnknownError; });
  expectOne(IssueCode::kErrAncestor, [](DatabaseEditor& editor) {
    TerrainBlock block = editor.block(innerLeaf(editor));
    block.ancestors.at(1).maximum -= block.ancestors.at(1).maximum / 20 + 5;
    editor.setBlock(innerLeaf(editor), block);
  });
}

}  // namespace deltaz
