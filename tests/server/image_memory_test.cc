// Streams that keep large images.
#include <chrono>

#include "homing/image/frame.h"
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

class ImageMemoryTest : public ServerTest {};

TEST_F(ImageMemoryTest, LargeImagesShareTheQuota) {
  options_.limits.memory_quota = 24 << 20;
  StartServer();
  ASSERT_THAT(Create(), IsGrpcOk());
  // Two cameras take 8 bytes a pixel of the source, and little for the small image that is tracked.
  const std::string pixels(2048 * 1024, 'x');
  Observation large;
  for (CameraView& view : large.views) {
    view = Frame{FrameEncoding::kGray8, 2048, 1024, pixels};
  }
  Recording recording(journeys_.get(), kJourney);
  recording.Record(large);
  ASSERT_THAT(Create("other"), IsGrpcOk());
  {
    Recording second(journeys_.get(), "robots/r/journeys/other");
    second.Send(large);
    EXPECT_EQ(ReasonOf(second.AwaitEnd()), "IMAGE_MEMORY");
  }
  Localizing localizing(homing_.get(), LocalizeOn(kJourney));
  localizing.Send(large);
  EXPECT_EQ(ReasonOf(localizing.AwaitEnd()), "LOCALIZE_MEMORY");
  EXPECT_THAT(recording.Close(), IsGrpcOk());
  // What the ended streams had waiting is freed a moment after their ends.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  grpc::Status ended;
  do {
    Localizing later(homing_.get(), LocalizeOn(kJourney));
    later.Send(large);
    ended = later.Close();
  } while (!ended.ok() && std::chrono::steady_clock::now() < deadline);
  EXPECT_THAT(ended, IsGrpcOk());
}

}  // namespace
}  // namespace homing::server
