// Every issue code has a recipe that damages a sound database so that this code, and no other, is reported,
// and a near miss that looks alike and is sound. A code without both fails.
#include "tests/libdb/check/code_assets.h"

#include <gtest/gtest.h>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "libdb/check/code_registry.h"

namespace deltaz {
namespace {

const std::vector<Asset>& assets() {
  static const std::vector<Asset> kAssets = [] {
    std::vector<Asset> all;
    for (const auto& family : {fileAssets(), treeAssets(), tileAssets(), heightAssets(), errorAssets(),
                               sourceAssets(), colorAssets(), modelAssets()})
      all.insert(all.end(), family.begin(), family.end());
    return all;
  }();
  return kAssets;
}

class CodeAssets : public testing::TestWithParam<Asset> {};

TEST_P(CodeAssets, recipe_trips_this_code_and_no_other) {
  const Report report = GetParam().bad(soundDatabase());
  EXPECT_FALSE(HasFailure());
  ASSERT_EQ(report.groups.size(), 1u) << listing(report);
  EXPECT_EQ(report.groups[0].code, GetParam().code) << listing(report);
  EXPECT_EQ(report.groups[0].severity, describe(GetParam().code).severity);
  EXPECT_GE(report.groups[0].count, 1u);
}

TEST_P(CodeAssets, near_miss_is_clean) {
  const Report report = GetParam().near_miss(soundDatabase());
  EXPECT_TRUE(report.groups.empty()) << listing(report);
  EXPECT_TRUE(report.complete);
  EXPECT_FALSE(report.fatal.has_value());
}

INSTANTIATE_TEST_SUITE_P(All, CodeAssets, testing::ValuesIn(assets()), [](const auto& information) {
  return std::string(issueCodeName(information.param.code));
});

TEST(CodeRegistry, every_code_has_exactly_one_recipe) {
  std::map<IssueCode, int> recipes;
  for (const Asset& asset : assets()) ++recipes[asset.code];
  for (const CodeDescription& code : codeRegistry()) {
    EXPECT_EQ(recipes[code.code], 1) << issueCodeName(code.code) << " has no recipe that trips it alone";
  }
  EXPECT_EQ(recipes.size(), codeRegistry().size());
}

TEST(CodeRegistry, every_code_is_explained) {
  std::set<std::string_view> titles;
  for (const CodeDescription& code : codeRegistry()) {
    EXPECT_EQ(&describe(code.code), &code);
    EXPECT_TRUE(titles.insert(code.title).second) << code.title;
    EXPECT_GT(code.explanation.size(), 40u) << issueCodeName(code.code);
    EXPECT_GT(code.remedy.size(), 10u) << issueCodeName(code.code);
    EXPECT_NE(code.section.find(".md "), std::string_view::npos) << issueCodeName(code.code);
    EXPECT_EQ(issueCodeFromName(issueCodeName(code.code)), code.code);
  }
}

TEST(SoundDatabase, is_clean_at_every_level) {
  for (const CheckLevel level :
       {CheckLevel::kStructure, CheckLevel::kChecksum, CheckLevel::kDecode, CheckLevel::kGeometry}) {
    const Report report = checkedAt(soundDatabase(), level);
    EXPECT_TRUE(report.groups.empty()) << listing(report);
    EXPECT_TRUE(report.complete);
  }
}

}  // namespace
}  // namespace deltaz
