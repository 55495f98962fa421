#include "client/token_interceptor.h"

#include <cstdint>
#include <random>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/trace_parent.h"

namespace homing::client {
namespace {

namespace ge = grpc::experimental;

// 16 hexadecimal digits, not all 0.
std::string NewId() {
  std::random_device random;
  const std::uint64_t number = (std::uint64_t{random()} << 32) | random();
  return absl::StrCat(absl::Hex(number | 1, absl::kZeroPad16));
}

class CallInterceptor final : public ge::Interceptor {
 public:
  CallInterceptor(std::string authorization, std::string trace)
      : authorization_(std::move(authorization)), trace_(std::move(trace)) {}

  void Intercept(ge::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(
            ge::InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      auto* metadata = methods->GetSendInitialMetadata();
      if (!authorization_.empty()) metadata->emplace("authorization", authorization_);
      metadata->emplace("traceparent", trace_);
    }
    methods->Proceed();
  }

 private:
  // gRPC keeps references to these until the call ends.
  const std::string authorization_;
  const std::string trace_;
};

class CallFactory final : public ge::ClientInterceptorFactoryInterface {
 public:
  CallFactory(const std::string& token, const std::string& traceparent)
      : authorization_(token.empty() ? "" : "Bearer " + token),
        trace_(ParseTraceParent(traceparent).value_or(TraceParent{NewId() + NewId(), ""})) {}

  // gRPC takes ownership of the result.
  ge::Interceptor* CreateClientInterceptor(ge::ClientRpcInfo* /*info*/) override {
    TraceParent call = trace_;
    call.span_id = NewId();
    return std::make_unique<CallInterceptor>(authorization_, ToString(call)).release();
  }

 private:
  const std::string authorization_;
  const TraceParent trace_;
};

}  // namespace

std::vector<std::unique_ptr<ge::ClientInterceptorFactoryInterface>> SendToken(
    const std::string& token, const std::string& traceparent) {
  std::vector<std::unique_ptr<ge::ClientInterceptorFactoryInterface>> factories;
  factories.push_back(std::make_unique<CallFactory>(token, traceparent));
  return factories;
}

}  // namespace homing::client
