// Recording over gRPC, as many streams as cores: frames against the same without a network, flow
// vectors against an echo.
#include <benchmark/benchmark.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/journey/journey_recorder.h"
#include "homing/v1/journey_service.grpc.pb.h"
#include "proto/wire/observation_conversion.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/benchmark/stream_server.h"
#include "tests/benchmark/textured_drive.h"

namespace homing::benchmarks {
namespace {

// Observations of one stream in one repetition.
constexpr int kFrames = 120;
constexpr int kFlows = 4000;
constexpr int kVectors = 200;
// Most observations sent and not yet acknowledged, as in the client library.
constexpr int kWindow = 256;
const cv::Size kSize(640, 480);
// So many that the interval is narrow.
constexpr int kRepetitions = 31;

int Streams() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

void OnAllCores(const std::function<void(int)>& body) {
  std::vector<std::thread> threads;
  for (int i = 0; i < Streams(); ++i) threads.emplace_back([&body, i] { body(i); });
  for (std::thread& thread : threads) thread.join();
}

using Requests = std::vector<v1::RecordJourneyRequest>;

Requests FrameRequests() {
  Requests requests;
  std::int64_t sequence = 0;
  for (const cv::Mat& frame : DrawFrames(kSize, kFrames)) {
    *requests.emplace_back().mutable_observation() =
        wire::ToProto(FrameObservation(sequence++, frame));
  }
  return requests;
}

Requests FlowRequests() {
  Requests requests;
  for (int i = 0; i < kFlows; ++i) {
    *requests.emplace_back().mutable_observation() = wire::ToProto(FlowObservation(i, kVectors));
  }
  return requests;
}

// Streams all requests and waits for the last acknowledgement. False: it ended early.
bool Stream(const std::string& address, const std::string& journey, const Requests& requests) {
  grpc::ChannelArguments own_connection;
  own_connection.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::JourneyService::NewStub(
      grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), own_connection));
  grpc::ClientContext context;
  const auto stream = stub->RecordJourney(&context);
  v1::RecordJourneyRequest config;
  config.mutable_config()->set_journey(journey);
  config.mutable_config()->set_writer_id("w");
  stream->Write(config);
  v1::RecordJourneyResponse response;
  if (!stream->Read(&response)) return false;
  std::size_t answered = 0;
  for (std::size_t sent = 0; sent < requests.size(); ++sent) {
    if (!stream->Write(requests[sent])) return false;
    for (; sent + 1 - answered >= kWindow; ++answered) {
      if (!stream->Read(&response)) return false;
    }
  }
  stream->WritesDone();
  for (; answered < requests.size(); ++answered) {
    if (!stream->Read(&response)) return false;
  }
  return stream->Finish().ok();
}

bool CreateJourney(const std::string& address, const std::string& robot,
                   const std::string& journey) {
  const auto stub =
      v1::JourneyService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  v1::CreateJourneyRequest request;
  request.set_parent("robots/" + robot);
  request.set_journey_id(journey);
  request.set_writer_id("w");
  v1::Journey created;
  return stub->CreateJourney(&context, request, &created).ok();
}

// All streams at once, each to its own journey, until the last observation is durable. False: one
// ended early.
bool RunStreams(const std::string& address, const Requests& requests, const std::string& journey) {
  std::atomic<bool> ok = true;
  OnAllCores([&](int i) {
    const std::string name = absl::StrCat("robots/r", i, "/journeys/", journey);
    if (!Stream(address, name, requests)) ok = false;
  });
  return ok;
}

double SecondsOf(const std::function<bool()>& run, bool* ok) {
  const auto begin = std::chrono::steady_clock::now();
  *ok = run() && *ok;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Both within one repetition: a run of each to warm up, then peer, ours, ours, peer. Whatever
// else the machine does then, and does ever more or ever less of, slows down both alike.
// `prepare` is not timed.
void RunInTurns(benchmark::State& state, const std::function<bool()>& peer,
                const std::function<bool()>& prepare, const std::function<bool()>& ours) {
  bool ok = peer() && prepare() && ours();
  double peer_s = 0, ours_s = 0;
  for (auto _ : state) {
    peer_s += SecondsOf(peer, &ok);
    for (int i = 0; i < 2; ++i) {
      ok = prepare() && ok;
      ours_s += SecondsOf(ours, &ok);
    }
    peer_s += SecondsOf(peer, &ok);
  }
  if (!ok) state.SkipWithError("a stream ended early");
  state.counters["peer_s"] = peer_s;
  state.counters["ours_s"] = ours_s;
}

// The journeys of the next run over gRPC.
class NewJourneys {
 public:
  explicit NewJourneys(const StreamServer* server) : server_(server) {}
  bool Create() {
    name_ = absl::StrCat("j", ++runs_);
    bool ok = true;
    for (int i = 0; i < Streams(); ++i) {
      ok = CreateJourney(server_->address(), absl::StrCat("r", i), name_) && ok;
    }
    return ok;
  }
  bool Record(const Requests& requests) const {
    return RunStreams(server_->address(), requests, name_);
  }

 private:
  const StreamServer* const server_;
  int runs_ = 0;
  std::string name_;
};

void FramesOverGrpc(benchmark::State& state) {
  cv::setNumThreads(0);
  const auto server = StartHomingServer();
  if (server == nullptr) return state.SkipWithError("the server did not start");
  const Requests requests = FrameRequests();
  const std::vector<cv::Mat> frames = DrawFrames(kSize, kFrames);
  const auto without_network = [&frames] {
    OnAllCores([&](int) {
      JourneyRecorder recorder{JourneySettings()};
      for (std::size_t i = 0; i < frames.size(); ++i) {
        benchmark::DoNotOptimize(
            recorder.Record(FrameObservation(static_cast<std::int64_t>(i), frames[i])));
      }
    });
    return true;
  };
  NewJourneys journeys(server.get());
  RunInTurns(
      state, without_network, [&] { return journeys.Create(); },
      [&] { return journeys.Record(requests); });
}

void FlowOverGrpc(benchmark::State& state) {
  const auto server = StartHomingServer();
  const auto echo = StartEchoServer({});
  if (server == nullptr || echo == nullptr) {
    return state.SkipWithError("a server did not start");
  }
  const Requests requests = FlowRequests();
  NewJourneys journeys(server.get());
  RunInTurns(
      state, [&] { return RunStreams(echo->address(), requests, "echo"); },
      [&] { return journeys.Create(); }, [&] { return journeys.Record(requests); });
}

// The cost of one observation before it is sent, in one thread.
void FlowWithoutNetwork(benchmark::State& state) {
  std::vector<Observation> observations;
  for (int i = 0; i < kFlows; ++i) observations.push_back(FlowObservation(i, kVectors));
  JourneyRecorder recorder{JourneySettings()};
  std::int64_t sequence = 0;
  for (auto _ : state) {
    Observation& next = observations[static_cast<std::size_t>(sequence % kFlows)];
    next.sequence = sequence++;
    benchmark::DoNotOptimize(recorder.Record(next));
  }
}

}  // namespace

void RegisterStreamBenchmarks(bool quick) {
  const auto add = [quick](const char* name, void (*body)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, body)
        ->UseRealTime()
        ->Iterations(1)
        ->Repetitions(quick ? 5 : kRepetitions)
        ->Unit(benchmark::kMillisecond);
  };
  benchmark::RegisterBenchmark("flow_alone", FlowWithoutNetwork)->Unit(benchmark::kMicrosecond);
  add("frames_grpc", FramesOverGrpc);
  add("flow_grpc", FlowOverGrpc);
}

}  // namespace homing::benchmarks
