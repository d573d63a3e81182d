#include "formats/near_names.h"

#include <gtest/gtest.h>

namespace deltaz {
namespace {

using Names = std::vector<std::string>;

TEST(NearNames, nearest_come_first_and_far_ones_not_at_all) {
  const Names names = {"wheel", "wheels", "piston", "whale", "axle"};
  EXPECT_EQ(nearNames("wheel", names), (Names{"wheel", "wheels"}));
  EXPECT_EQ(nearNames("pistn", names), (Names{"piston"}));
  EXPECT_EQ(nearNames("PISTON", names), (Names{"piston"}));
  EXPECT_EQ(nearNames("xale", names), (Names{"axle"}));  // two letters exchanged are one mistake
  EXPECT_EQ(nearNames("rotor", names), Names{});
}

TEST(NearNames, one_letter_may_differ_in_the_shortest_names) {
  EXPECT_EQ(nearNames("a", Names{"b", "cd"}), (Names{"b"}));
}

TEST(NearNames, at_most_five_are_given) {
  const Names names = {"part1", "part2", "part3", "part4", "part5", "part6"};
  EXPECT_EQ(nearNames("part", names).size(), 5u);
}

TEST(NearNames, text_says_what_there_is) {
  EXPECT_EQ(nearNamesText("x", Names{}), "there are none");
  EXPECT_EQ(nearNamesText("piton", Names{"piston", "rod"}), "near it: \"piston\"");
  EXPECT_EQ(nearNamesText("zzzz", Names{"piston", "rod"}), "there are \"piston\", \"rod\"");
  EXPECT_EQ(nearNamesText("zzzzzzzzz", Names{"aa", "bb", "cc", "dd", "ee", "ff"}),
            "there are \"aa\", \"bb\", \"cc\", \"dd\", \"ee\" and others");
}

}  // namespace
}  // namespace deltaz
