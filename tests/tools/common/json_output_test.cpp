#include "tools/common/json_output.h"

#include <gtest/gtest.h>
#include <limits>

namespace deltaz {
namespace {

TEST(JsonOutput, what_is_not_finite_becomes_null) {
  EXPECT_TRUE(finiteOrNull(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_TRUE(finiteOrNull(-std::numeric_limits<double>::infinity()).is_null());
  EXPECT_TRUE(finiteOrNull(std::numeric_limits<double>::quiet_NaN()).is_null());
  EXPECT_EQ(finiteOrNull(1.5).get<double>(), 1.5);
}

TEST(JsonOutput, bytes_that_are_no_text_do_not_break_it) {
  Json json;
  json["name"] = std::string("caf\xe9.tif");
  const std::string text = jsonText(json);
  EXPECT_NE(text.find("\xEF\xBF\xBD"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
  EXPECT_TRUE(Json::accept(text));
}

TEST(JsonOutput, members_keep_the_order_they_were_set_in) {
  const std::string text = jsonText(jsonHeader("tool"));
  EXPECT_LT(text.find("schema_version"), text.find("\"tool\""));
  EXPECT_LT(text.find("\"tool\""), text.find("tool_version"));
}

}  // namespace
}  // namespace deltaz
