// Channels that tests call over without a second attempt.
#ifndef HOMING_TESTS_SUPPORT_CONNECTED_H_
#define HOMING_TESTS_SUPPORT_CONNECTED_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>
#include <string>

namespace homing {

// A plain channel to `address`, connected if a server answers within ten seconds. Before grpc
// 1.61 the first attempt to connect may fail though nothing is wrong, when another call changes
// errno meanwhile (grpc/grpc#35064), and calls that do not wait then fail with it.
inline std::shared_ptr<grpc::Channel> ConnectedChannel(
    const std::string& address, const grpc::ChannelArguments& arguments = {}) {
  auto channel = grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
  channel->WaitForConnected(std::chrono::system_clock::now() + std::chrono::seconds(10));
  return channel;
}

}  // namespace homing

#endif  // HOMING_TESTS_SUPPORT_CONNECTED_H_
