#include "server/rpc/page.h"

#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

TEST(PageTest, ATokenIsGoodForItsOwnListOnly) {
  const std::string token = EncodePageToken("robots/r", "robots/r/journeys/a");
  EXPECT_EQ(DecodePageToken("robots/r", token).value(), "robots/r/journeys/a");
  EXPECT_EQ(DecodePageToken("robots/r", "").value(), "");
  EXPECT_THAT(DecodePageToken("robots/q", token),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("page_token")));
}

}  // namespace
}  // namespace homing::server
