// A message that cannot be decoded is an error, never the end of the stream.
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include "proto/wire/observation_conversion.h"
#include "tests/server/server_fixture.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class UndecodableTest : public ServerTest {
 protected:
  struct Ended {
    int answers = 0;
    grpc::Status status;
  };
  // Sends `messages` as they are, and half-closes.
  Ended Send(const std::string& method, const std::vector<std::string>& messages) {
    const auto channel =
        grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
    grpc::GenericStub stub(channel);
    grpc::ClientContext context;
    grpc::CompletionQueue queue;
    const auto stream = stub.PrepareCall(&context, method, &queue);
    void* tag = nullptr;
    bool ok = false;
    const auto await = [&] { return queue.Next(&tag, &ok) && ok; };
    stream->StartCall(nullptr);
    await();
    for (const std::string& message : messages) {
      const grpc::Slice slice(message);
      stream->Write(grpc::ByteBuffer(&slice, 1), nullptr);
      await();
    }
    stream->WritesDone(nullptr);
    await();
    Ended ended;
    grpc::ByteBuffer answer;
    for (stream->Read(&answer, nullptr); await(); stream->Read(&answer, nullptr)) ++ended.answers;
    stream->Finish(&ended.status, nullptr);
    await();
    queue.Shutdown();
    while (queue.Next(&tag, &ok)) {
    }
    return ended;
  }
  static std::string Config() {
    v1::RecordJourneyRequest request;
    request.mutable_config()->set_journey(kJourney);
    request.mutable_config()->set_writer_id(kWriter);
    return request.SerializeAsString();
  }
  static std::string Place(int place) {
    v1::RecordJourneyRequest request;
    *request.mutable_observation() = wire::ToProto(test::FlowAt(place));
    return request.SerializeAsString();
  }
};

constexpr char kRecord[] = "/homing.v1.JourneyService/RecordJourney";

TEST_F(UndecodableTest, RecordingAnswersWhatCameBeforeAndEndsWithAnError) {
  ASSERT_THAT(Create(), IsGrpcOk());
  const std::string whole = Place(1);
  const Ended ended =
      Send(kRecord, {Config(), Place(0), whole.substr(0, whole.size() - 1), Place(2)});
  EXPECT_EQ(ended.answers, 2);
  EXPECT_THAT(ended.status,
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("RecordJourneyRequest")));
  EXPECT_EQ(Get().next_sequence(), 1);
}

TEST_F(UndecodableTest, OtherKindsOfNonsenseAreErrorsToo) {
  ASSERT_THAT(Create(), IsGrpcOk());
  const std::string not_utf8("\x0a\x17\x0a\x12robots/r/journeys/\xfc\x12\x01w", 25);
  for (const std::string& message : {std::string("\xff\xff"), not_utf8, std::string("\x0a")}) {
    EXPECT_EQ(Send(kRecord, {message}).status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(Send("/homing.v1.HomingService/Localize", {message}).status.error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(Send("/homing.v1.JourneyService/ImportJourney", {message}).status.error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
  }
}

TEST_F(UndecodableTest, MessagesThatWouldTakeManyTimesTheirBytesAreNotParsed) {
  std::string unknown, empty;
  for (int i = 0; i < 1'000'000; ++i) {
    unknown += std::string("\x7a\x00", 2);
    empty += std::string("\x1a\x00", 2);
  }
  const auto refused = GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("more than"));
  EXPECT_THAT(Send("/homing.v1.HomingService/Localize", {unknown}).status, refused);
  EXPECT_THAT(Send("/homing.v1.HomingService/MatchLandmarks", {empty}).status, refused);
}

TEST_F(UndecodableTest, ACallWithoutItsRequestIsAnError) {
  EXPECT_THAT(Send("/homing.v1.JourneyService/GetJourney", {}).status,
              GrpcStatusIs(grpc::StatusCode::INVALID_ARGUMENT, HasSubstr("no request")));
}

TEST_F(UndecodableTest, AnEmptyStreamIsNoError) {
  EXPECT_THAT(Send(kRecord, {}).status, IsGrpcOk());
}

TEST_F(UndecodableTest, PackedMessagesAreRefused) {
  for (const auto algorithm : {GRPC_COMPRESS_GZIP, GRPC_COMPRESS_DEFLATE}) {
    grpc::ClientContext context;
    context.set_compression_algorithm(algorithm);
    v1::GetJourneyRequest request;
    request.set_name(std::string(100'000, 'a'));
    v1::Journey journey;
    EXPECT_THAT(journeys_->GetJourney(&context, request, &journey),
                GrpcStatusIs(grpc::StatusCode::UNIMPLEMENTED, HasSubstr("disabled")));
  }
}

}  // namespace
}  // namespace homing::server
