// Sends a bearer token with every call of a channel.
#ifndef CLIENT_TOKEN_INTERCEPTOR_H_
#define CLIENT_TOKEN_INTERCEPTOR_H_

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace homing::client {

// For CreateCustomChannelWithInterceptors. Over plain text too, where gRPC's own call credentials
// refuse to go: whether that is allowed is the caller's to decide.
std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> SendToken(
    const std::string& token);

}  // namespace homing::client

#endif  // CLIENT_TOKEN_INTERCEPTOR_H_
