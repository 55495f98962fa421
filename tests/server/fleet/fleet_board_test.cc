#include "server/fleet/fleet_board.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"

namespace homing::server {
namespace {

// Counts the blocks of memory in use: a weak_ptr keeps the block of an object that is destroyed.
template <typename T>
struct CountingAllocator {
  using value_type = T;
  explicit CountingAllocator(int* counter) : blocks(counter) {}
  template <typename Other>
  explicit CountingAllocator(const CountingAllocator<Other>& other) : blocks(other.blocks) {}
  T* allocate(std::size_t count) {
    ++*blocks;
    return std::allocator<T>().allocate(count);
  }
  void deallocate(T* block, std::size_t count) {
    --*blocks;
    std::allocator<T>().deallocate(block, count);
  }
  bool operator==(const CountingAllocator&) const = default;
  int* blocks;
};

class CountedWatcher : public FleetWatcher {
 public:
  void Wake() override { ++woken; }
  int woken = 0;
};

TEST(FleetBoardTest, WatchersOfRobotsThatDoNothingLeaveNoMemory) {
  FleetBoard board([] { return 0; });
  int blocks = 0;
  const auto watch = [&](const std::string& robot) {
    const auto watcher =
        std::allocate_shared<CountedWatcher>(CountingAllocator<CountedWatcher>(&blocks));
    board.Watch(robot, watcher);
    return watcher;
  };
  const auto stays = watch("robots/stays");
  for (int i = 0; i < 10'000; ++i) {
    watch("robots/one");
    watch(absl::StrCat("robots/", i));
    watch("");
    ASSERT_LT(blocks, 200) << i;
  }
  const auto presence = board.Enter("robots/stays", v1::ACTIVITY_RECORDING, "");
  EXPECT_EQ(stays->woken, 1);
}

TEST(FleetBoardTest, NamesThatLeaveNoJourneyTakeBoundedMemory) {
  FleetBoard board([] { return 0; });
  board.SetStored({{"robots/recorded", {1, 1}}});
  const auto present = board.Enter("robots/present", v1::ACTIVITY_LOCALIZING, "");
  for (int i = 0; i < 30'000; ++i) {
    board.Enter(absl::StrCat("robots/z", i), v1::ACTIVITY_LOCALIZING, "");
  }
  const auto robots = board.List("", 100'000);
  EXPECT_LE(robots.size(), 10'000U);
  EXPECT_EQ(robots.front().name(), "robots/present");
  EXPECT_EQ(robots[1].name(), "robots/recorded");
  EXPECT_EQ(board.Newest("robots/z29999").number > 0, true);
}

}  // namespace
}  // namespace homing::server
