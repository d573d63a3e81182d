#include "librender/ars/machine/hardware_software_interface.h"

#include <gtest/gtest.h>

namespace deltaz::ars {
namespace {

// Report 5.2: empty, filling, full, transferring, empty; available, busy, available.
TEST(HardwareSoftwareInterface, takes_buffers_and_tilers_round) {
  HardwareSoftwareInterface interface(1, 2);
  EXPECT_TRUE(interface.idle());
  ASSERT_EQ(interface.beginFilling(), 0);
  EXPECT_EQ(interface.buffer(0), BufferState::kFilling);
  EXPECT_FALSE(interface.beginTransfer());
  ASSERT_TRUE(interface.finishFilling(0, 10, 20).ok());
  EXPECT_EQ(interface.buffer(0), BufferState::kFull);
  const auto transfer = interface.beginTransfer();
  ASSERT_TRUE(transfer);
  EXPECT_EQ(transfer->buffer, 0);
  EXPECT_EQ(transfer->tiler, 0);
  EXPECT_EQ(transfer->begin, 10U);
  EXPECT_EQ(transfer->end, 20U);
  EXPECT_EQ(interface.buffer(0), BufferState::kTransferring);
  EXPECT_EQ(interface.tiler(0), TilerState::kBusy);
  // The next buffer is filled meanwhile, and waits.
  ASSERT_EQ(interface.beginFilling(), 1);
  EXPECT_EQ(interface.beginFilling(), std::nullopt);
  ASSERT_TRUE(interface.finishFilling(1, 20, 30).ok());
  EXPECT_FALSE(interface.beginTransfer());
  ASSERT_TRUE(interface.finishTransfer(0).ok());
  EXPECT_EQ(interface.buffer(0), BufferState::kEmpty);
  EXPECT_EQ(interface.tiler(0), TilerState::kAvailable);
  EXPECT_EQ(interface.beginTransfer()->begin, 20U);
  EXPECT_FALSE(interface.idle());
  ASSERT_TRUE(interface.finishTransfer(0).ok());
  EXPECT_TRUE(interface.idle());
}

TEST(HardwareSoftwareInterface, gives_the_longest_full_buffer_to_the_longest_available_tiler) {
  HardwareSoftwareInterface interface(2, 3);
  for (int buffer = 0; buffer < 3; ++buffer) ASSERT_EQ(interface.beginFilling(), buffer);
  for (const int buffer : {2, 0, 1})
    ASSERT_TRUE(interface.finishFilling(buffer, static_cast<std::size_t>(buffer), 9).ok());
  EXPECT_EQ(interface.beginTransfer()->buffer, 2);
  EXPECT_EQ(interface.beginTransfer()->buffer, 0);
  ASSERT_TRUE(interface.finishTransfer(1).ok());
  ASSERT_TRUE(interface.finishTransfer(0).ok());
  const auto next = interface.beginTransfer();
  EXPECT_EQ(next->buffer, 1);
  EXPECT_EQ(next->tiler, 1);
}

TEST(HardwareSoftwareInterface, says_which_state_was_wrong) {
  HardwareSoftwareInterface interface(2, 2);
  const Status early = interface.finishFilling(1, 0, 1);
  ASSERT_FALSE(early.ok());
  EXPECT_EQ(early.error().message(), "buffer 1: is empty where the end of filling needs one that is filling");
  const Status idle = interface.finishTransfer(0);
  ASSERT_FALSE(idle.ok());
  EXPECT_EQ(idle.error().message(),
            "tiler 0: is available where the end of a transfer needs one that is busy");
  EXPECT_FALSE(interface.finishTransfer(7).ok());
  EXPECT_FALSE(interface.finishFilling(-1, 0, 1).ok());
  // Nothing has changed.
  EXPECT_TRUE(interface.idle());
  EXPECT_EQ(interface.beginFilling(), 0);
}

TEST(HardwareSoftwareInterface, never_uses_a_tiler_that_is_out_of_service) {
  HardwareSoftwareInterface interface(2, 2);
  ASSERT_TRUE(interface.takeOutOfService(0).ok());
  EXPECT_FALSE(interface.takeOutOfService(0).ok());
  EXPECT_EQ(interface.tilersInService(), 1);
  ASSERT_TRUE(interface.beginFilling());
  ASSERT_TRUE(interface.finishFilling(0, 0, 1).ok());
  EXPECT_EQ(interface.beginTransfer()->tiler, 1);
  ASSERT_TRUE(interface.beginFilling());
  ASSERT_TRUE(interface.finishFilling(1, 1, 2).ok());
  EXPECT_FALSE(interface.beginTransfer());
}

}  // namespace
}  // namespace deltaz::ars
