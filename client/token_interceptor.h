// Adds a bearer token and the trace to every call of a channel.
#ifndef CLIENT_TOKEN_INTERCEPTOR_H_
#define CLIENT_TOKEN_INTERCEPTOR_H_

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace homing::client {

// For CreateCustomChannelWithInterceptors. An empty token is not sent; others are sent over plain
// text too, which gRPC's call credentials refuse: the caller decides whether that is allowed.
// `traceparent`: the trace that is continued; if it is not valid, a new one begins.
std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> SendToken(
    const std::string& token, const std::string& traceparent);

}  // namespace homing::client

#endif  // CLIENT_TOKEN_INTERCEPTOR_H_
