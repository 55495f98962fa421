#include "proto/wire/observation_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/status_matchers.h"

namespace homing::wire {
namespace {

using ::testing::HasSubstr;

v1::FlowVectors Vectors(int count) {
  v1::FlowVectors message;
  message.set_width(320);
  message.set_height(240);
  for (int i = 0; i < count; ++i) {
    message.add_start_x(static_cast<float>(i) + 0.1F);
    message.add_start_y(2);
    message.add_end_x(3);
    message.add_end_y(4);
  }
  return message;
}

v1::Observation WithFlow() {
  v1::Observation message;
  message.set_sequence(7);
  *message.mutable_left()->mutable_flow_vectors() = Vectors(3);
  return message;
}

// The observation of WithFlow() after `change` is refused, and `why` is in the message.
template <typename Change>
void ExpectRefused(Change change, const std::string& why) {
  v1::Observation message = WithFlow();
  change(message);
  EXPECT_THAT(FromProto(message), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
}

TEST(ObservationConversion, FlowVectorsComeBackBitForBit) {
  const v1::Observation message = WithFlow();
  const auto observation = FromProto(message);
  ASSERT_THAT(observation, IsOk());
  const auto& flow = std::get<FlowField>(observation->views[0]);
  EXPECT_EQ(flow.width, 320);
  EXPECT_EQ(flow.height, 240);
  ASSERT_EQ(flow.vectors.size(), 3U);
  EXPECT_EQ(flow.vectors[1], (FlowVector{1.1F, 2, 3, 4}));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(observation->views[1]));
  EXPECT_EQ(ToProto(*observation).SerializeAsString(), message.SerializeAsString());
}

TEST(ObservationConversion, AFrameViewsTheBytesOfTheMessage) {
  v1::Observation message;
  message.mutable_capture_time()->set_seconds(1'700'000'000);
  message.mutable_capture_time()->set_nanos(5);
  message.set_break_before(true);
  v1::Frame& frame = *message.mutable_right()->mutable_frame();
  frame.set_encoding(v1::FRAME_ENCODING_GRAY8);
  frame.set_width(2);
  frame.set_height(3);
  frame.set_data("abcdef");
  const auto observation = FromProto(message);
  ASSERT_THAT(observation, IsOk());
  EXPECT_EQ(observation->capture_time_ns, 1'700'000'000'000'000'005);
  EXPECT_TRUE(observation->break_before);
  const auto& view = std::get<Frame>(observation->views[1]);
  EXPECT_EQ(view.data.data(), frame.data().data());
  EXPECT_EQ(view.encoding, FrameEncoding::kGray8);
  EXPECT_EQ(ToProto(*observation).SerializeAsString(), message.SerializeAsString());
}

TEST(ObservationConversion, RefusesAnObservationThatIsNone) {
  ExpectRefused([](v1::Observation& m) { m.set_sequence(-1); }, "observation.sequence: -1");
  ExpectRefused([](v1::Observation& m) { m.set_sequence(INT64_MAX); }, "must be at most");
  ExpectRefused([](v1::Observation& m) { m.set_frame(INT64_MAX); }, "observation.frame");
  ExpectRefused([](v1::Observation& m) { m.clear_left(); }, "observation.left: must be set unless");
  ExpectRefused([](v1::Observation& m) { m.mutable_left()->clear_flow_vectors(); },
                "observation.left");
  ExpectRefused([](v1::Observation& m) { m.mutable_capture_time()->set_seconds(-1); },
                "capture_time.seconds: -1");
  ExpectRefused([](v1::Observation& m) { m.mutable_capture_time()->set_seconds(1LL << 60); },
                "capture_time.seconds");
  ExpectRefused([](v1::Observation& m) { m.mutable_capture_time()->set_nanos(1'000'000'000); },
                "capture_time.nanos");
}

TEST(ObservationConversion, RefusesVectorsThatAreNone) {
  const auto flow = [](v1::Observation& m) { return m.mutable_left()->mutable_flow_vectors(); };
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_start_y(1, NAN); },
                "observation.left.flow_vectors.start_y[1]: nan");
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_end_x(0, -INFINITY); }, "end_x[0]: -inf");
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_end_y(2, 1e30F); }, "end_y[2]: 1e+30");
  ExpectRefused([&](v1::Observation& m) { flow(m)->add_end_y(1); },
                "end_y: 4 must be 3 entries, as start_x");
  ExpectRefused([&](v1::Observation& m) { flow(m)->clear_start_x(); },
                "start_y: 3 must be 0 entries");
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_width(0); }, "width: 0 must be in [1, ");
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_height(-240); }, "height: -240");
  ExpectRefused([&](v1::Observation& m) { flow(m)->set_width(8193); }, "in [1, 8192] px");
}

TEST(ObservationConversion, RefusesTooManyVectorsBeforeItReadsThem) {
  const v1::FlowVectors message = Vectors(11);
  EXPECT_THAT(FromProto(message, "f", {.max_vectors = 11}), IsOk());
  EXPECT_THAT(FromProto(message, "f", {.max_vectors = 10}),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("f.start_x: 11 must be at most 10 entries")));
  ExpectRefused(
      [](v1::Observation& m) {
        m.mutable_left()->mutable_flow_vectors()->mutable_start_x()->Resize(1'000'000, 1);
      },
      "at most 100000");
}

TEST(ObservationConversion, RefusesFramesThatAreNone) {
  const auto frame = [](v1::Observation& m) {
    v1::Frame* message = m.mutable_left()->mutable_frame();
    message->set_encoding(v1::FRAME_ENCODING_BGR8);
    message->set_width(4);
    message->set_height(4);
    message->set_data("x");
    return message;
  };
  ExpectRefused([&](v1::Observation& m) { frame(m)->clear_encoding(); }, "frame.encoding: 0");
  ExpectRefused([&](v1::Observation& m) { frame(m)->clear_data(); }, "frame.data: must hold");
  ExpectRefused([&](v1::Observation& m) { frame(m)->set_width(0); }, "frame.width: 0");
  ExpectRefused([&](v1::Observation& m) { frame(m)->set_height(-1); }, "frame.height: -1");
  ExpectRefused([&](v1::Observation& m) { frame(m)->set_height(60'000); }, "60000 must be in [1, ");
}

TEST(ObservationConversion, ACompressedFrameNeedsNoSize) {
  v1::Frame message;
  message.set_encoding(v1::FRAME_ENCODING_JPEG);
  message.set_data("x");
  EXPECT_THAT(FromProto(message, "frame"), IsOk());
  message.set_width(60'000);
  EXPECT_THAT(FromProto(message, "frame"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frame.width: 60000")));
}

}  // namespace
}  // namespace homing::wire
