// Recording over gRPC, as many streams as cores: frames against the same without a network, flow
// vectors against an echo.
#include <benchmark/benchmark.h>
#include <grpcpp/grpcpp.h>

#include <atomic>
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

bool Create(const std::string& address, const std::string& robot, const std::string& journey) {
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

// All streams at once, each to its own journey, until the last observation is durable.
void RunStreams(benchmark::State& state, const StreamServer* server, const Requests& requests,
                bool create) {
  static int runs = 0;
  if (server == nullptr) return state.SkipWithError("the server did not start");
  for (auto _ : state) {
    state.PauseTiming();
    const std::string journey = absl::StrCat("j", runs++);
    for (int i = 0; create && i < Streams(); ++i) {
      if (!Create(server->address(), absl::StrCat("r", i), journey)) {
        state.SkipWithError("cannot create a journey");
      }
    }
    state.ResumeTiming();
    std::atomic<bool> ok = true;
    OnAllCores([&](int i) {
      const std::string name = absl::StrCat("robots/r", i, "/journeys/", journey);
      if (!Stream(server->address(), name, requests)) ok = false;
    });
    if (!ok) state.SkipWithError("a stream ended early");
  }
  state.counters["per_second"] =
      benchmark::Counter(static_cast<double>(requests.size() * static_cast<std::size_t>(Streams())),
                         benchmark::Counter::kIsIterationInvariantRate);
}

void FramesOverGrpc(benchmark::State& state) {
  const auto server = StartHomingServer();
  RunStreams(state, server.get(), FrameRequests(), true);
}

void FramesWithoutNetwork(benchmark::State& state) {
  cv::setNumThreads(0);
  const std::vector<cv::Mat> frames = DrawFrames(kSize, kFrames);
  for (auto _ : state) {
    OnAllCores([&](int) {
      JourneyRecorder recorder{JourneySettings()};
      for (std::size_t i = 0; i < frames.size(); ++i) {
        benchmark::DoNotOptimize(
            recorder.Record(FrameObservation(static_cast<std::int64_t>(i), frames[i])));
      }
    });
  }
}

void FlowOverGrpc(benchmark::State& state) {
  const auto server = StartHomingServer();
  RunStreams(state, server.get(), FlowRequests(), true);
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

void FlowEcho(benchmark::State& state) {
  const auto server = StartEchoServer();
  RunStreams(state, server.get(), FlowRequests(), false);
}

}  // namespace

void RegisterStreamBenchmarks(bool /*quick*/) {
  const auto add = [](const char* name, void (*body)(benchmark::State&)) {
    benchmark::RegisterBenchmark(name, body)
        ->UseRealTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  };
  benchmark::RegisterBenchmark("flow_alone", FlowWithoutNetwork)->Unit(benchmark::kMicrosecond);
  add("frames_grpc", FramesOverGrpc);
  add("frames_pool", FramesWithoutNetwork);
  add("flow_grpc", FlowOverGrpc);
  add("flow_echo", FlowEcho);
}

}  // namespace homing::benchmarks
