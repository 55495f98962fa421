#include "client/token_interceptor.h"

#include <utility>

namespace homing::client {
namespace {

namespace ge = grpc::experimental;

class TokenInterceptor final : public ge::Interceptor {
 public:
  explicit TokenInterceptor(std::string header) : header_(std::move(header)) {}

  void Intercept(ge::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(
            ge::InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      methods->GetSendInitialMetadata()->emplace("authorization", header_);
    }
    methods->Proceed();
  }

 private:
  const std::string header_;
};

class TokenFactory final : public ge::ClientInterceptorFactoryInterface {
 public:
  explicit TokenFactory(const std::string& token) : header_("Bearer " + token) {}

  // gRPC takes ownership of the result.
  ge::Interceptor* CreateClientInterceptor(ge::ClientRpcInfo* /*info*/) override {
    return std::make_unique<TokenInterceptor>(header_).release();
  }

 private:
  const std::string header_;
};

}  // namespace

std::vector<std::unique_ptr<ge::ClientInterceptorFactoryInterface>> SendToken(
    const std::string& token) {
  std::vector<std::unique_ptr<ge::ClientInterceptorFactoryInterface>> factories;
  factories.push_back(std::make_unique<TokenFactory>(token));
  return factories;
}

}  // namespace homing::client
