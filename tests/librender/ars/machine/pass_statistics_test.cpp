#include "librender/ars/machine/pass_statistics.h"

#include <gtest/gtest.h>
#include <string>

#include "librender/ars/machine/machine.h"
#include "tests/librender/ars/machine/random_pixels.h"

namespace deltaz::ars {
namespace {

const CycleLengths kLengths = cycleLengths(MemoryDesign::kVariable);

const PassStatistics& soundStatistics() {
  static const PassStatistics kStatistics =
      Machine::make({}).value().runTimed(randomPixels({.triangles = 100, .seed = 4})).value();
  return kStatistics;
}

template <typename Change>
std::string complaint(Change&& change) {
  PassStatistics statistics = soundStatistics();
  change(statistics);
  const Status status = verifyConservation(statistics, kLengths);
  if (status.ok()) return "";
  EXPECT_EQ(status.error().kind, ErrorKind::kInternal);
  return status.error().where;
}

TEST(PassStatistics, of_a_frame_add_up) {
  EXPECT_TRUE(verifyConservation(soundStatistics(), kLengths).ok());
  EXPECT_GT(soundStatistics().pixels(), 1000);
}

// One picosecond, cycle or pixel too many, anywhere, is noticed.
TEST(PassStatistics, that_do_not_add_up_name_the_unit) {
  using S = PassStatistics;
  EXPECT_EQ(complaint([](S& s) { ++s.tilers[2].tiling.blocked; }), "tiler 2");
  EXPECT_EQ(complaint([](S& s) { --s.tilers[0].set_up.starved; }), "tiler 0");
  EXPECT_EQ(complaint([](S& s) { ++s.tilers[3].transfer.busy; }), "tiler 3");
  EXPECT_EQ(complaint([](S& s) { ++s.tilers[1].pixels; }), "tilers");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.left; }), "distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.outlets[7].starved; }), "outlets of the distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.levels[0].buffers[1].blocked; }),
            "level 0 of the distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.levels[1].inputs[0].lost; }), "level 1 of the distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.levels[2].queues[0].direct; }), "level 2 of the distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.tree.levels[2].queues[0].cycles_at_length[0]; }),
            "level 2 of the distribution tree");
  EXPECT_EQ(complaint([](S& s) { ++s.memories[5].counts.cycles[1]; }), "memories");
  EXPECT_EQ(complaint([](S& s) { ++s.memories[5].channel.starved; }), "memory 5");
  // One look-ahead write more and an initialisation less: as many cycles, another time.
  EXPECT_EQ(complaint([](S& s) {
              ++s.memories[6].counts.cycles[3];
              --s.memories[6].counts.cycles[1];
            }),
            "memory 6");
}

TEST(PassStatistics, average_over_the_frame) {
  PassStatistics statistics;
  EXPECT_EQ(statistics.pixelsPerTreeCycle(), 0);
  statistics.duration = 10 * kTreeCycle;
  statistics.tilers.resize(2);
  statistics.tilers[0].pixels = 15;
  statistics.tilers[1].pixels = 10;
  EXPECT_EQ(statistics.pixelsPerTreeCycle(), 2.5);
}

}  // namespace
}  // namespace deltaz::ars
