#include "tests/faults/bad_clients.h"

#include <arpa/inet.h>
#include <grpcpp/grpcpp.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>

#include "homing/v1/homing_service.grpc.pb.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "proto/wire/observation_conversion.h"
#include "tests/support/route.h"

namespace homing::faults {
namespace {

constexpr char kPreface[] = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";

// Sends `bytes` to the port and goes away, by a reset.
void SendBytes(const std::string& address, const std::string& bytes) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0) {
    ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const linger hard{1, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &hard, sizeof(hard));
  ::close(socket);
}

std::string Garbage(std::mt19937* random) {
  std::string bytes(2000, '\0');
  for (char& c : bytes) c = static_cast<char>((*random)());
  return bytes;
}

// Starts to record a journey that does not exist, then sends bytes that are no observation.
void RecordNonsense(const std::shared_ptr<grpc::Channel>& channel) {
  grpc::ClientContext context;
  const auto stream = v1::JourneyService::NewStub(channel)->RecordJourney(&context);
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey("robots/none/journeys/none");
  request.mutable_config()->set_writer_id("bad");
  stream->Write(request);
  request.mutable_observation()->set_sequence(-1);
  stream->Write(request);
  stream->Finish();
}

// Asks for much and never reads an answer.
void NeverRead(const std::shared_ptr<grpc::Channel>& channel) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(2));
  const auto stream = v1::HomingService::NewStub(channel)->Localize(&context);
  v1::LocalizeRequest request;
  request.mutable_config()->set_journey("robots/1/journeys/-");
  request.mutable_config()->set_travel(v1::TRAVEL_SAME);
  stream->Write(request);
  for (int i = 0; i < 2000; ++i) {
    *request.mutable_observation() = wire::ToProto(test::FlowAt(i));
    if (!stream->Write(request)) break;
  }
  context.TryCancel();
}

// A message larger than any server takes.
void SendTooMuch(const std::shared_ptr<grpc::Channel>& channel) {
  grpc::ClientContext context;
  const auto stream = v1::JourneyService::NewStub(channel)->RecordJourney(&context);
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey(std::string(20 << 20, 'x'));
  stream->Write(request);
  stream->Finish();
}

}  // namespace

BadClients::BadClients(const std::string& address)
    : address_(address), thread_([this] { Run(); }) {}

BadClients::~BadClients() {
  stopping_ = true;
  thread_.join();
}

void BadClients::Run() {
  std::mt19937 random(7);
  while (!stopping_) {
    const auto channel = grpc::CreateChannel(address_, grpc::InsecureChannelCredentials());
    SendBytes(address_, Garbage(&random));
    SendBytes(address_, kPreface);
    SendBytes(address_, kPreface + Garbage(&random));
    RecordNonsense(channel);
    NeverRead(channel);
    if (visits_ % 10 == 0) SendTooMuch(channel);
    ++visits_;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace homing::faults
