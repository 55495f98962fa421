#include "server/http/api_gateway.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/client_context.h>
#include <grpcpp/impl/client_unary_call.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/impl/rpc_method.h>

#include <chrono>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace homing::server {
namespace {

namespace pb = google::protobuf;

constexpr std::chrono::seconds kTimeout{30};
// Bytes of an answer before it becomes JSON, which takes several times as much for each browser.
constexpr std::size_t kMaxAnswer = 4 << 20;

int HttpStatusOf(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kOk:
      return 200;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kOutOfRange:
      return 400;
    case absl::StatusCode::kUnauthenticated:
      return 401;
    case absl::StatusCode::kPermissionDenied:
      return 403;
    case absl::StatusCode::kNotFound:
      return 404;
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kAborted:
    case absl::StatusCode::kFailedPrecondition:
      return 409;
    case absl::StatusCode::kResourceExhausted:
      return 429;
    case absl::StatusCode::kUnavailable:
      return 503;
    default:
      return 500;
  }
}

// A JSON text of this string.
std::string Quoted(absl::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

void ApiCaller::AddTo(grpc::ClientContext* context) const {
  if (!token.empty()) context->AddMetadata("authorization", "Bearer " + token);
  if (!trace.empty()) context->AddMetadata("traceparent", trace);
}

ApiAnswer ToAnswer(const absl::Status& status) {
  return {HttpStatusOf(status.code()),
          absl::StrCat("{\"code\":", Quoted(absl::StatusCodeToString(status.code())),
                       ",\"message\":", Quoted(status.message()), "}")};
}

ApiAnswer ToAnswer(const grpc::Status& status) {
  return ToAnswer(
      absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message()));
}

std::string ToJson(const pb::Message& message) {
  std::string json;
  if (!pb::util::MessageToJsonString(message, &json).ok()) return "{}";
  return json;
}

std::string ApiGateway::ToSharedJson(const grpc::ByteBuffer& bytes, pb::Message* message) const {
  std::vector<grpc::Slice> slices;
  if (!bytes.Dump(&slices).ok()) return "{}";
  std::string serialized;
  for (const grpc::Slice& slice : slices) {
    serialized.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  const MutexLock lock(mutex_);
  auto& [last, json] = last_[message->GetDescriptor()];
  if (json.empty() || last != serialized) {
    if (!message->ParseFromString(serialized)) return "{}";
    last = std::move(serialized);
    json = ToJson(*message);
  }
  return json;
}

ApiAnswer ApiGateway::Call(const std::string& method, const std::string& json,
                           const ApiCaller& caller) const {
  const std::string full = absl::StrCat("homing.v1.", method);
  const auto* found = pb::DescriptorPool::generated_pool()->FindMethodByName(
      absl::StrReplaceAll(full, {{"/", "."}}));
  if (found == nullptr || found->client_streaming() || found->server_streaming()) {
    return ToAnswer(absl::NotFoundError(absl::StrCat("no method ", method)));
  }
  auto* const factory = pb::MessageFactory::generated_factory();
  const std::unique_ptr<pb::Message> request(factory->GetPrototype(found->input_type())->New());
  const std::unique_ptr<pb::Message> response(factory->GetPrototype(found->output_type())->New());
  if (const auto parsed = pb::util::JsonStringToMessage(json, request.get()); !parsed.ok()) {
    return ToAnswer(absl::InvalidArgumentError(
        absl::StrCat("the body is not a ", std::string(found->input_type()->name()))));
  }
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kTimeout);
  caller.AddTo(&context);
  const std::string path = absl::StrCat("/", full);
  const grpc::internal::RpcMethod call(path.c_str(), grpc::internal::RpcMethod::NORMAL_RPC);
  const grpc::Status status =
      grpc::internal::BlockingUnaryCall<pb::Message, pb::Message, pb::MessageLite, pb::MessageLite>(
          channel_.get(), call, &context, *request, response.get());
  if (!status.ok()) return ToAnswer(status);
  if (const std::size_t bytes = response->ByteSizeLong(); bytes > kMaxAnswer) {
    return ToAnswer(absl::ResourceExhaustedError(
        absl::StrCat("the answer has ", bytes, " bytes, and HTTP sends at most ", kMaxAnswer,
                     "; ask for fewer with pageSize, or use gRPC")));
  }
  return {200, ToJson(*response)};
}

}  // namespace homing::server
