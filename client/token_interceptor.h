// Sends a bearer token with every call of a channel.
#ifndef CLIENT_TOKEN_INTERCEPTOR_H_
#define CLIENT_TOKEN_INTERCEPTOR_H_

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace homing::client {

// For CreateCustomChannelWithInterceptors. Works over plain text too, which gRPC's call credentials
// refuse; the caller decides whether that is allowed.
std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> SendToken(
    const std::string& token);

}  // namespace homing::client

#endif  // CLIENT_TOKEN_INTERCEPTOR_H_
