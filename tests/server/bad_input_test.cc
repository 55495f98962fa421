// For any input the caller gets the documented code and message, the server continues to serve
// others, and no stored data is lost.
#include <cmath>
#include <functional>
#include <limits>

#include "tests/server/compressed_images.h"
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Beside the bad one there is a journey that is recorded all the while, and a finished one.
class BadInputTest : public ServerTest {
 protected:
  void SetUp() override {
    ASSERT_THAT(Create("bystander"), IsGrpcOk());
    ASSERT_THAT(Create("out"), IsGrpcOk());
    ASSERT_THAT(Create("old"), IsGrpcOk());
    RecordFlow(0, 3);
    RecordFlow(0, 30, kOld);
    ASSERT_THAT(Finish(kOld), IsGrpcOk());
    file_ = Export();
    old_file_ = Export(kOld);
    bystander_ = std::make_unique<Recording>(journeys_.get(), "robots/r/journeys/bystander");
    bystander_->Record(test::FlowAt(0));
  }
  void TearDown() override {
    EXPECT_EQ(bystander_->Record(test::FlowAt(1)).next_sequence(), 2);
    EXPECT_THAT(bystander_->Close(), IsGrpcOk());
    EXPECT_EQ(Export(), file_);
    EXPECT_EQ(Export(kOld), old_file_);
    EXPECT_EQ(Get().next_sequence(), 3);
    RecordFlow(3, 5);
  }

  grpc::Status RecordOne(const Observation& observation, const std::string& name = kJourney) {
    Recording recording(journeys_.get(), name);
    recording.Send(observation);
    return recording.AwaitEnd();
  }
  grpc::Status LocalizeOne(const Observation& observation) {
    Localizing localizing(homing_.get(), LocalizeOn(kOld));
    localizing.Send(observation);
    return localizing.AwaitEnd();
  }

  static constexpr char kOld[] = "robots/r/journeys/old";
  std::string file_;
  std::string old_file_;
  std::unique_ptr<Recording> bystander_;
};

Observation WithView(const CameraView& left) {
  Observation observation;
  observation.sequence = 3;
  observation.views[0] = left;
  return observation;
}

// The frame views bytes that live until the program ends.
Observation WithFrame(FrameEncoding encoding, int width, int height, const std::string& bytes) {
  static std::vector<std::unique_ptr<std::string>> kept;
  const std::string& own = *kept.emplace_back(std::make_unique<std::string>(bytes));
  return WithView(Frame{encoding, width, height, own});
}

Observation WithVector(float start_x, float end_y) {
  FlowField field = test::FieldAt(3, Side::kLeft);
  field.vectors[5] = {start_x, 10, 11, end_y};
  return WithView(field);
}

struct BadObservation {
  const char* name;
  std::function<Observation()> make;
  ::testing::Matcher<std::string> message;
};

class BadObservationTest : public BadInputTest,
                           public ::testing::WithParamInterface<BadObservation> {};

TEST_P(BadObservationTest, EndsTheStreamOfARecordingAsInvalid) {
  ASSERT_THAT(Create("fresh"), IsGrpcOk());
  Observation observation = GetParam().make();
  observation.sequence = 0;
  const grpc::Status status = RecordOne(observation, "robots/r/journeys/fresh");
  EXPECT_THAT(status, GrpcStatusIs(kInvalid, GetParam().message));
  EXPECT_EQ(Get("robots/r/journeys/fresh").next_sequence(), 0);
  EXPECT_THAT(BadFieldOf(status), ::testing::StartsWith("observation.left"));
  EXPECT_FALSE(HasRetryInfo(status));
}

TEST_P(BadObservationTest, EndsTheStreamOfALocalisationAsInvalid) {
  EXPECT_THAT(LocalizeOne(GetParam().make()), GrpcStatusIs(kInvalid, GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadObservationTest,
    ::testing::Values(
        BadObservation{"NoCamera", [] { return WithView(std::monostate()); }, HasSubstr("left")},
        BadObservation{"ZeroWidth", [] { return WithFrame(FrameEncoding::kGray8, 0, 120, ""); },
                       AllOf(HasSubstr("width"), HasSubstr("0"))},
        BadObservation{"NegativeHeight",
                       [] { return WithFrame(FrameEncoding::kGray8, 160, -1, ""); },
                       AllOf(HasSubstr("height"), HasSubstr("-1"))},
        BadObservation{"HugeWidth",
                       [] { return WithFrame(FrameEncoding::kRgb8, 2147483647, 2147483647, "x"); },
                       HasSubstr("2147483647")},
        BadObservation{"TooFewBytes",
                       [] {
                         return WithFrame(FrameEncoding::kGray8, 160, 120,
                                          std::string(160 * 120 - 1, 'x'));
                       },
                       HasSubstr("19199")},
        BadObservation{"TooManyBytes",
                       [] {
                         return WithFrame(FrameEncoding::kBgr8, 160, 120,
                                          std::string(160 * 120 * 3 + 1, 'x'));
                       },
                       HasSubstr("57601")},
        BadObservation{"TruncatedJpeg",
                       [] {
                         const std::string jpeg = Jpeg();
                         return WithFrame(FrameEncoding::kJpeg, 0, 0,
                                          jpeg.substr(0, jpeg.size() / 2));
                       },
                       HasSubstr("left")},
        BadObservation{"JpegUnlikeItsSize",
                       [] { return WithFrame(FrameEncoding::kJpeg, 161, 120, Jpeg()); },
                       HasSubstr("161")},
        BadObservation{"NoJpegAtAll", [] { return WithFrame(FrameEncoding::kJpeg, 0, 0, "hello"); },
                       HasSubstr("left")},
        BadObservation{
            "PngOf60000By60000",
            [] { return WithFrame(FrameEncoding::kPng, 0, 0, PngThatClaims(60'000, 60'000)); },
            HasSubstr("60000")},
        BadObservation{"NanVector", [] { return WithVector(std::nanf(""), 10); },
                       AllOf(HasSubstr("left"), HasSubstr("nan"))},
        BadObservation{"InfiniteVector",
                       [] { return WithVector(10, -std::numeric_limits<float>::infinity()); },
                       AllOf(HasSubstr("left"), HasSubstr("inf"))},
        BadObservation{"AMillionVectors",
                       [] {
                         FlowField field = test::FieldAt(3, Side::kLeft);
                         field.vectors.resize(1'000'000, {1, 2, 3, 4});
                         return WithView(field);
                       },
                       AllOf(HasSubstr("1000000"), HasSubstr("100000"))},
        BadObservation{"FlowOfNoImage",
                       [] {
                         FlowField field = test::FieldAt(3, Side::kLeft);
                         field.width = 0;
                         return WithView(field);
                       },
                       HasSubstr("width")}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST_F(BadInputTest, ColumnsOfUnequalLengthAreInvalid) {
  v1::RecordJourneyRequest request = RecordRequest(test::FlowAt(3));
  request.mutable_observation()->mutable_left()->mutable_flow_vectors()->add_end_x(1);
  Recording recording(journeys_.get(), kJourney);
  recording.Send(request);
  EXPECT_THAT(recording.AwaitEnd(), GrpcStatusIs(kInvalid, HasSubstr("end_x")));
}

TEST_F(BadInputTest, AnUnknownJourneyIsNotFound) {
  Recording recording(journeys_.get(), "robots/r/journeys/none");
  EXPECT_THAT(recording.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("robots/r/journeys/none")));
  Localizing localizing(homing_.get(), LocalizeOn("robots/r/journeys/none"));
  EXPECT_THAT(localizing.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("robots/r/journeys/none")));
}

TEST_F(BadInputTest, ASecondWriterIsAbortedWhileTheFirstOnesLeaseLives) {
  Recording second(journeys_.get(), "robots/r/journeys/bystander", "other");
  const grpc::Status status = second.AwaitEnd();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::ABORTED, HasSubstr("another writer holds")));
  EXPECT_EQ(ReasonOf(status), "WRITER_LEASE_HELD");
}

TEST_F(BadInputTest, AnObservationBeforeTheConfigIsInvalid) {
  Recording recording(journeys_.get(), "");
  recording.Send(test::FlowAt(0));
  EXPECT_THAT(recording.AwaitEnd(), GrpcStatusIs(kInvalid, HasSubstr("must be config")));
  grpc::ClientContext context;
  const auto stream = homing_->Localize(&context);
  stream->Write(LocalizeRequestOf(test::FlowAt(0)));
  EXPECT_THAT(stream->Finish(), GrpcStatusIs(kInvalid, HasSubstr("must be config")));
}

TEST_F(BadInputTest, AnEmptyRequestAndASecondConfigAreInvalid) {
  Recording empty(journeys_.get(), "");
  empty.Send(v1::RecordJourneyRequest());
  EXPECT_THAT(empty.AwaitEnd(), GrpcStatusIs(kInvalid, HasSubstr("must be config or observation")));
  Recording twice(journeys_.get(), kJourney);
  v1::RecordJourneyRequest config;
  config.mutable_config()->set_journey(kJourney);
  config.mutable_config()->set_writer_id(kWriter);
  twice.Send(config);
  EXPECT_THAT(twice.AwaitEnd(), GrpcStatusIs(kInvalid, HasSubstr("must come once")));
}

TEST_F(BadInputTest, AGapNamesTheExpectedNumberAndARepeatStoresNothing) {
  Recording recording(journeys_.get(), kJourney);
  EXPECT_EQ(recording.Record(test::FlowAt(1, 50)).next_sequence(), 3);
  recording.Send(test::FlowAt(4));
  const grpc::Status status = recording.AwaitEnd();
  EXPECT_THAT(status,
              GrpcStatusIs(grpc::StatusCode::OUT_OF_RANGE, "observation.sequence: 4 must be 3"));
  EXPECT_EQ(ReasonOf(status), "SEQUENCE_GAP");
  Localizing localizing(homing_.get(), LocalizeOn(kOld));
  localizing.Localize(test::FlowAt(0));
  localizing.Send(test::FlowAt(2));
  EXPECT_THAT(localizing.AwaitEnd(),
              GrpcStatusIs(grpc::StatusCode::OUT_OF_RANGE, HasSubstr("must be 1")));
}

TEST_F(BadInputTest, ANegativeSequenceIsInvalid) {
  EXPECT_THAT(RecordOne(test::FlowAt(-1, 3)), GrpcStatusIs(kInvalid, HasSubstr("-1")));
  EXPECT_THAT(LocalizeOne(test::FlowAt(-1, 3)), GrpcStatusIs(kInvalid, HasSubstr("-1")));
}

TEST_F(BadInputTest, AnotherImageSizeThanTheJourneysIsAFailedPrecondition) {
  const Observation other = WithView(test::FieldAt(3, Side::kLeft, 640, 480));
  EXPECT_THAT(RecordOne(other), GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION,
                                             AllOf(HasSubstr("640"), HasSubstr("160"))));
  EXPECT_THAT(LocalizeOne(other), GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION,
                                               AllOf(HasSubstr("640"), HasSubstr("160"))));
}

TEST_F(BadInputTest, AFinishedJourneyTakesNoObservations) {
  Recording recording(journeys_.get(), kOld);
  const grpc::Status status = recording.AwaitEnd();
  EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION, HasSubstr("finished")));
  EXPECT_EQ(ReasonOf(status), "JOURNEY_FINISHED");
}

TEST_F(BadInputTest, AMessageOverTheLimitIsResourceExhausted) {
  const std::string bytes(17 << 20, 'x');
  const Observation large = WithFrame(FrameEncoding::kJpeg, 0, 0, bytes);
  EXPECT_THAT(RecordOne(large),
              GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("larger than max")));
  EXPECT_THAT(LocalizeOne(large),
              GrpcStatusIs(grpc::StatusCode::RESOURCE_EXHAUSTED, HasSubstr("larger than max")));
}

TEST_F(BadInputTest, AWrongAddressIsUnavailable) {
  const std::string address = server_->address();
  ConnectTo("127.0.0.1:1");
  grpc::ClientContext context;
  v1::Journey journey;
  EXPECT_THAT(journeys_->GetJourney(&context, {}, &journey),
              GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("")));
  ConnectTo(address);
}

TEST_F(BadInputTest, AFrameWhoseSizeChangesIsInvalidThoughCamerasMayDiffer) {
  ASSERT_THAT(Create("frames"), IsGrpcOk());
  Recording recording(journeys_.get(), "robots/r/journeys/frames");
  const std::string small = test::WallAt(0, Side::kLeft, 96, 64);
  const std::string large = test::WallAt(0, Side::kRight);
  Observation both;
  both.views = {test::GrayFrame(small, 96, 64), test::GrayFrame(large)};
  recording.Record(both);
  both.sequence = 1;
  EXPECT_EQ(recording.Record(both).next_sequence(), 2);
  both.sequence = 2;
  both.views[0] = test::GrayFrame(large);
  recording.Send(both);
  EXPECT_THAT(recording.AwaitEnd(),
              GrpcStatusIs(kInvalid, AllOf(HasSubstr("left"), HasSubstr("96"))));
  EXPECT_EQ(Get("robots/r/journeys/frames").next_sequence(), 2);
}

TEST_F(BadInputTest, AClientThatDisconnectsHarmsNoOther) {
  for (int i = 0; i < 20; ++i) {
    grpc::ClientContext context;
    const auto stream = journeys_->RecordJourney(&context);
    v1::RecordJourneyRequest config;
    config.mutable_config()->set_journey(kJourney);
    config.mutable_config()->set_writer_id(kWriter);
    stream->Write(config);
    stream->Write(RecordRequest(test::FlowAt(i % 3)));
    context.TryCancel();
    EXPECT_THAT(stream->Finish(), GrpcStatusIs(grpc::StatusCode::CANCELLED, HasSubstr("")));
  }
}

}  // namespace
}  // namespace homing::server
