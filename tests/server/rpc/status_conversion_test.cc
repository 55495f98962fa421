#include "server/rpc/status_conversion.h"

#include <gmock/gmock.h>

#include "google/rpc/error_details.pb.h"
#include "homing/base/field_error.h"

namespace homing::server {
namespace {

// The field of BadRequest in the details of `status`.
std::string BadFieldIn(const absl::Status& status) {
  google::rpc::Status details;
  details.ParseFromString(ToGrpcStatus(status).error_details());
  for (const auto& detail : details.details()) {
    google::rpc::BadRequest bad;
    if (detail.UnpackTo(&bad)) return bad.field_violations(0).field();
  }
  return "no BadRequest";
}

TEST(StatusConversionTest, BadRequestNamesTheFieldOfTheErrorAndNotTheWordsOfItsText) {
  EXPECT_EQ(BadFieldIn(MustBe("width", 0, "in [1, 2] px")), "width");
  EXPECT_EQ(BadFieldIn(Within("left", MustBe("frame.width", 0, "in [1, 2] px"))),
            "left.frame.width");
  EXPECT_EQ(BadFieldIn(absl::InvalidArgumentError("another day is needed")), "");
}

}  // namespace
}  // namespace homing::server
