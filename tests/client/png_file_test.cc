#include "client/png_file.h"

#include <gmock/gmock.h>

#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(PngFileTest, NamesTheErrorOfAFullDisk) {
  const SourceFrame frame{FrameEncoding::kGray8, 4, 4, std::string(16, 'x'), 0};
  EXPECT_THAT(WritePng("/dev/full", frame),
              StatusIs(absl::StatusCode::kResourceExhausted,
                       AllOf(HasSubstr("/dev/full"), HasSubstr("No space left on device"))));
}

}  // namespace
}  // namespace homing::client
