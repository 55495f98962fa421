// JourneyService.DescribeRoute over a real socket.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

using RouteDescriptionTest = ServerTest;

TEST_F(RouteDescriptionTest, TheRouteIsDescribedInColumns) {
  ASSERT_THAT(Create(), IsGrpcOk());
  v1::DescribeRouteRequest request;
  request.set_name(kJourney);
  v1::DescribeRouteResponse route;
  const auto describe = [&] {
    grpc::ClientContext context;
    return journeys_->DescribeRoute(&context, request, &route);
  };
  ASSERT_THAT(describe(), IsGrpcOk());
  EXPECT_EQ(route.sides_size(), 0);
  RecordFlow(0, 60);
  ASSERT_THAT(describe(), IsGrpcOk());
  ASSERT_GE(route.sides_size(), 1);
  const auto steps = Get().step_count();
  const int cells = route.grid_columns() * route.grid_rows();
  for (const v1::RouteSide& side : route.sides()) {
    EXPECT_EQ(side.flow_px_size(), steps);
    EXPECT_EQ(side.counts().size(), static_cast<std::size_t>(steps * cells));
    EXPECT_EQ(side.nearness().size(), side.counts().size());
    for (const char code : side.counts() + side.nearness()) EXPECT_LE(code, 15);
  }
  EXPECT_GT(route.map_bytes(), 16 * Get().fingerprint_count());
  const std::string fifth = route.sides(0).counts().substr(static_cast<std::size_t>(5 * cells),
                                                           static_cast<std::size_t>(cells));
  request.set_first_step(5);
  request.set_last_step(5);
  ASSERT_THAT(describe(), IsGrpcOk());
  EXPECT_EQ(route.sides(0).counts(), fifth);
  request.set_first_step(0);
  request.clear_last_step();
  request.set_columns(7);
  ASSERT_THAT(describe(), IsGrpcOk());
  EXPECT_EQ(route.steps_each(), (steps + 6) / 7);
  EXPECT_LE(route.sides(0).flow_px_size(), 7);
  const std::vector<std::pair<std::int64_t, std::int64_t>> outside = {{9, -5}, {1000, 2000}};
  for (const auto& [first, last] : outside) {
    request.set_first_step(first);
    request.set_last_step(last);
    ASSERT_THAT(describe(), IsGrpcOk());
    EXPECT_EQ(route.sides(0).flow_px_size(), 0);
  }
  request.set_columns(2001);
  EXPECT_THAT(describe(), GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("columns")));
}

}  // namespace
}  // namespace homing::server
