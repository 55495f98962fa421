#include "server/rpc/field_path.h"

#include <gtest/gtest.h>

#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"

namespace homing::server {
namespace {

TEST(FieldPathTest, IsOneOfTheRequest) {
  const auto& create = *v1::CreateJourneyRequest::descriptor();
  EXPECT_EQ(FieldPath("parent is \"x\"; it must be", create), "parent");
  EXPECT_EQ(FieldPath("journey.settings.flow: flow.cell_px 0 must be", create),
            "journey.settings.flow.cell_px");
  EXPECT_EQ(FieldPath("journey.settings.left_camera: focal_y is 0", create),
            "journey.settings.left_camera.focal_y");
  EXPECT_EQ(FieldPath("flow.window_px 16 is not odd", create), "journey.settings.flow.window_px");
  EXPECT_EQ(FieldPath("journey.readers[3] is \"x\"", create), "journey.readers[3]");
}

TEST(FieldPathTest, DropsWhatTheRequestDoesNotHave) {
  const auto& record = *v1::RecordJourneyRequest::descriptor();
  EXPECT_EQ(FieldPath("observation[17]: left: flow_vectors.width is 0", record),
            "observation.left.flow_vectors.width");
  EXPECT_EQ(FieldPath("observation[17]: left: frame: frame.data has 1 bytes", record),
            "observation.left.frame.data");
  EXPECT_EQ(FieldPath("writer_id is 500 bytes", record), "config.writer_id");
  EXPECT_EQ(FieldPath("a message cannot be decoded", record), "");
}

}  // namespace
}  // namespace homing::server
