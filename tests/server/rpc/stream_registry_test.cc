#include "server/rpc/stream_registry.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace homing::server {
namespace {

class QuietStream final : public OpenStream {
 public:
  void Drain() override {}
  void Tick() override {}
};

TEST(StreamRegistryTest, StreamsShareEvenlyUpToTheMostThatOneMayHave) {
  StreamRegistry registry;
  std::vector<std::shared_ptr<OpenStream>> streams;
  const auto open = [&](std::size_t count) {
    while (streams.size() < count) {
      streams.push_back(std::make_shared<QuietStream>());
      ASSERT_TRUE(registry.Add(streams.back()));
    }
  };
  EXPECT_EQ(registry.ShareOf(100, 20), 20U);
  open(5);
  EXPECT_EQ(registry.ShareOf(100, 20), 20U);
  open(10);
  EXPECT_EQ(registry.ShareOf(100, 20), 10U);
  open(1000);
  EXPECT_EQ(registry.ShareOf(100, 20), 1U);
  while (streams.size() > 10) {
    registry.Remove(streams.back());
    streams.pop_back();
  }
  EXPECT_EQ(registry.ShareOf(100, 20), 10U);
}

}  // namespace
}  // namespace homing::server
