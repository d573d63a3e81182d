#include "librender/ars/engine/ars_options.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <string>

namespace deltaz {
namespace {

TEST(ArsOptions, nothing_is_the_machine_of_the_report) {
  const ArsOptions options = parseArsOptions("").value();
  EXPECT_EQ(options.machine.tilers, 4);
  EXPECT_EQ(options.machine.memories, 8);
  EXPECT_EQ(options.machine.mode, ars::HashingMode::kScramble);
  EXPECT_EQ(options.passes, 3);
  EXPECT_EQ(describeArsOptions(options), "");
}

TEST(ArsOptions, come_back_from_their_description) {
  const std::string text =
      "tilers=2,memories=16,unavailable=1,mode=interleave,discipline=queue-first,queue=7,fifo=3,memory-fifo="
      "5,"
      "transfer-fifo=1,setup-fifo=9,alternative=3,ties=brighter,clock=50,buffers=12,buffer-triangles=100,"
      "word-ns=1200,host-ns=20,barriers=off,sampling=over,passes=1,antialiaser=report,timing=off,top-left=on,"
      "clamp-depth=on,true-color=on,vertex-bits=4,color-bits=8,plane-bits=20,depth-bits=12";
  const ArsOptions options = parseArsOptions(text).value();
  EXPECT_EQ(options.machine.unavailable, std::vector<int>{1});
  EXPECT_EQ(options.machine.word_transfer, 1200);
  EXPECT_TRUE(options.oversample);
  EXPECT_FALSE(options.timed);
  EXPECT_EQ(options.tiler.numbers.depth.mantissa_bits, 12);
  EXPECT_EQ(describeArsOptions(options), text);
  EXPECT_EQ(describeArsOptions(parseArsOptions(describeArsOptions(options)).value()), text);
}

// Whoever reads statistics need not know the report's machine.
TEST(ArsOptions, all_that_take_effect_are_told) {
  const std::string text = effectiveArsOptions({});
  for (const ArsKey& key : arsKeys())
    EXPECT_NE(("," + text).find(fmt::format(",{}=", key.name)), std::string::npos) << key.name;
  EXPECT_NE(text.find("tilers=4,memories=8,unavailable=none,mode=scramble,"), std::string::npos) << text;
  EXPECT_NE(text.find(",buffers=5,"), std::string::npos) << text;
  EXPECT_EQ(effectiveArsOptions(parseArsOptions(text).value()), text);
}

// Every key has a value that can be set, and refuses one that cannot.
TEST(ArsOptions, every_key_refuses_nonsense_and_names_its_values) {
  ASSERT_GT(arsKeys().size(), 25u);
  for (const ArsKey& key : arsKeys()) {
    ArsOptions options;
    const Status refused = setArsOption(key.name, "nonsense", options);
    ASSERT_FALSE(refused.ok()) << key.name;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
    EXPECT_NE(refused.error().remedy.find(key.values), std::string::npos) << key.name;
    EXPECT_FALSE(setArsOption(key.name, "", options).ok()) << key.name;
    EXPECT_FALSE(setArsOption(key.name, "999999999999", options).ok()) << key.name;
  }
}

TEST(ArsOptions, refuse_what_is_no_list_of_settings) {
  for (const char* text :
       {"tilers", "=4", "tilers=4,", ",tilers=4", "tilers=4,tilers=2", "tilrs=4", "tilers=3",
        "tilers=2,unavailable=0+1", "unavailable=7", "unavailable=0+", "depth-bits=27,tilers=0"}) {
    const Result<ArsOptions> refused = parseArsOptions(text);
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage) << text;
  }
  EXPECT_NE(parseArsOptions("tilrs=4").error().why.find("tilers"), std::string::npos);
}

}  // namespace
}  // namespace deltaz
