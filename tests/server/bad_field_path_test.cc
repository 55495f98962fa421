// Each scalar field of each unary request gets values out of range: the field that BadRequest names
// must be a path of the request.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <grpcpp/impl/client_unary_call.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/rpc_method.h>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

namespace pb = google::protobuf;

// "a.b[0].c" names fields from message to message.
bool IsPath(const pb::Descriptor* type, const std::string& path) {
  for (const std::string& part : std::vector<std::string>(absl::StrSplit(path, '.'))) {
    if (type == nullptr) return false;
    const std::size_t bracket = part.find('[');
    const pb::FieldDescriptor* field = type->FindFieldByName(part.substr(0, bracket));
    if (field == nullptr || (bracket != std::string::npos && !field->is_repeated())) return false;
    type = field->message_type();
  }
  return true;
}

// Calls `visit` with each scalar field of `message` and of those that it can hold set to each of
// some values, one at a time.
void Vary(pb::Message* message, const std::function<void()>& visit, int depth = 0) {
  const pb::Reflection* reflection = message->GetReflection();
  for (int i = 0; i < message->GetDescriptor()->field_count() && depth < 6; ++i) {
    const pb::FieldDescriptor* field = message->GetDescriptor()->field(i);
    const auto* oneof = field->real_containing_oneof();
    if (oneof != nullptr && reflection->HasOneof(*message, oneof) &&
        !reflection->HasField(*message, field)) {
      continue;
    }
    const std::unique_ptr<pb::Message> before(message->New());
    before->CopyFrom(*message);
    const auto with = [&](const auto& set) {
      set();
      visit();
      message->CopyFrom(*before);
    };
    if (field->message_type() != nullptr) {
      Vary(field->is_repeated() ? reflection->AddMessage(message, field)
                                : reflection->MutableMessage(message, field),
           visit, depth + 1);
      message->CopyFrom(*before);
    } else if (field->is_repeated() && field->cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING) {
      with([&] { reflection->AddString(message, field, "x/y"); });
    } else if (field->is_repeated()) {
      continue;
    } else if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_DOUBLE) {
      for (const double value : {std::numeric_limits<double>::quiet_NaN(), -1.0, 1e300}) {
        with([&] { reflection->SetDouble(message, field, value); });
      }
    } else if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_INT32) {
      for (const int value : {-1, std::numeric_limits<int>::max()}) {
        with([&] { reflection->SetInt32(message, field, value); });
      }
    } else if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING) {
      for (const char* value : {"", "x/y", "-"}) {
        with([&] { reflection->SetString(message, field, value); });
      }
    } else if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_ENUM) {
      with([&] { reflection->SetEnumValue(message, field, 99); });
    }
  }
}

class BadFieldPathTest : public ServerTest {
 protected:
  BadFieldPathTest() {
    StartServer();
    EXPECT_THAT(Create(), IsGrpcOk());
    RecordFlow(0, 10);
  }

  // Calls `method` with all variants of `request`.
  void Try(const std::string& method, pb::Message* request) {
    const auto channel =
        grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
    const auto* found = pb::DescriptorPool::generated_pool()->FindMethodByName(
        absl::StrReplaceAll("homing.v1." + method, {{"/", "."}}));
    ASSERT_NE(found, nullptr) << method;
    const std::unique_ptr<pb::Message> response(
        pb::MessageFactory::generated_factory()->GetPrototype(found->output_type())->New());
    const std::string path = "/homing.v1." + method;
    const grpc::internal::RpcMethod call(path.c_str(), grpc::internal::RpcMethod::NORMAL_RPC);
    Vary(request, [&] {
      grpc::ClientContext context;
      const grpc::Status status =
          grpc::internal::BlockingUnaryCall<pb::Message, pb::Message, pb::MessageLite,
                                            pb::MessageLite>(channel.get(), call, &context,
                                                             *request, response.get());
      if (status.error_code() != kInvalid) return;
      ++refused_;
      EXPECT_TRUE(IsPath(request->GetDescriptor(), BadFieldOf(status)))
          << BadFieldOf(status) << " of " << request->ShortDebugString();
    });
  }

  int refused_ = 0;
};

v1::Frame SmallFrame() {
  v1::Frame frame;
  frame.set_encoding(v1::FRAME_ENCODING_GRAY8);
  frame.set_width(32);
  frame.set_height(32);
  frame.set_data(std::string(1024, 'x'));
  return frame;
}

TEST_F(BadFieldPathTest, OfJourneys) {
  v1::CreateJourneyRequest create;
  create.set_parent("robots/r");
  create.set_journey_id("new");
  Try("JourneyService/CreateJourney", &create);
  v1::ListJourneysRequest list;
  list.set_parent("robots/-");
  Try("JourneyService/ListJourneys", &list);
  v1::SetReadersRequest readers;
  readers.set_name(kJourney);
  Try("JourneyService/SetReaders", &readers);
  v1::ListLandmarksRequest landmarks;
  landmarks.set_parent(kJourney);
  Try("JourneyService/ListLandmarks", &landmarks);
  v1::AnalyzeAliasingRequest aliasing;
  aliasing.set_name(kJourney);
  Try("JourneyService/AnalyzeAliasing", &aliasing);
  v1::DescribeRouteRequest route;
  route.set_name(kJourney);
  Try("JourneyService/DescribeRoute", &route);
  EXPECT_GT(refused_, 50);
}

TEST_F(BadFieldPathTest, OfQueriesAndModels) {
  v1::MatchLandmarksRequest match;
  match.set_journey(kJourney);
  match.set_travel(v1::TRAVEL_SAME);
  *match.mutable_left()->mutable_frames()->mutable_first() = SmallFrame();
  *match.mutable_left()->mutable_frames()->mutable_second() = SmallFrame();
  Try("HomingService/MatchLandmarks", &match);
  match.mutable_left()->mutable_fingerprints()->add_fingerprints()->set_count(1);
  Try("HomingService/MatchLandmarks", &match);
  v1::TrainDeviationModelRequest train;
  Try("DeviationModelService/TrainDeviationModel", &train);
  EXPECT_GT(refused_, 30);
}

}  // namespace
}  // namespace homing::server
