// Servers to stream to: the real one, and one that only echoes.
#ifndef TESTS_BENCHMARK_STREAM_SERVER_H_
#define TESTS_BENCHMARK_STREAM_SERVER_H_

#include <memory>
#include <string>

namespace homing::benchmarks {

// Listens on its own loopback port until it is destroyed.
class StreamServer {
 public:
  virtual ~StreamServer() = default;
  virtual std::string address() const = 0;
};

// A homing-server with its own database. Null: it did not start.
std::unique_ptr<StreamServer> StartHomingServer();

// The certificate and key of TLS; empty: plain text.
struct EchoTls {
  std::string cert;
  std::string key;
};

// Answers each RecordJourney observation by its number: the same reactor, threads, strands, pool
// and transport, and nothing computed or stored. Null: it did not start.
std::unique_ptr<StreamServer> StartEchoServer(const EchoTls& tls);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_STREAM_SERVER_H_
