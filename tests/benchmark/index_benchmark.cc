// The index of all journeys against FAISS IndexFlatL2 on the same points, one thread.
#include <benchmark/benchmark.h>
#include <faiss/IndexFlat.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "homing/matching/landmark_index.h"
#include "tests/benchmark/benchmarks.h"
#include "tests/benchmark/fingerprint_source.h"

namespace homing::benchmarks {
namespace {

constexpr int kQueries = 1024;
constexpr int kCompared = 20;

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

JourneyStep StepOf(std::int64_t step, const Fingerprint& fingerprint) {
  JourneyStep made;
  made.step = step;
  made.fingerprints.push_back({Side::kLeft, fingerprint, 0});
  return made;
}

std::vector<Fingerprint> Draw(Layout layout, std::int64_t size) {
  FingerprintSource source(layout, 1);
  std::vector<Fingerprint> drawn;
  drawn.reserve(static_cast<std::size_t>(size));
  for (std::int64_t i = 0; i < size; ++i) drawn.push_back(source.Next(i % kStepsPerJourney));
  return drawn;
}

void AppendAll(const std::vector<Fingerprint>& fingerprints, LandmarkIndex& index) {
  int journey = -1;
  for (std::size_t i = 0; i < fingerprints.size(); ++i) {
    const std::int64_t step = static_cast<std::int64_t>(i) % kStepsPerJourney;
    if (step == 0) {
      journey = index.AddJourney("robots/r" + std::to_string(i / 100'000) + "/journeys/j" +
                                     std::to_string(i / kStepsPerJourney),
                                 {});
    }
    index.Append(journey, StepOf(step, fingerprints[i]));
  }
}

void Load(const std::vector<Fingerprint>& fingerprints, LandmarkIndex& index) {
  index.BeginLoading();
  AppendAll(fingerprints, index);
  index.EndLoading();
}

std::vector<SeenSides> DrawQueries(Layout layout) {
  FingerprintSource source(layout, 2);
  std::vector<SeenSides> queries;
  for (int i = 0; i < kQueries; ++i) {
    const Fingerprint f = source.Next(i);
    queries.push_back({});
    queries.back()[0].push_back({.x = f.x, .y = f.y, .count = f.count});
  }
  return queries;
}

// How many of some queries the index answers otherwise than a scan with erfc, as fingerprints or as
// distinct landmarks. Journeys are named so that few scans suffice: ties are rare here, and are the
// business of the tests.
int CountUnlike(const LandmarkIndex& index, const std::vector<Fingerprint>& all,
                const std::vector<SeenSides>& queries) {
  int unlike = 0;
  for (int q = 0; q < kCompared; ++q) {
    const SeenLandmark& seen = queries[static_cast<std::size_t>(q)][0].front();
    std::vector<std::pair<double, std::size_t>> scanned;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double p_t = Compare({seen.x, seen.y, seen.count, 0}, all[i], {}).p_t;
      if (p_t >= kRecognitionThreshold) scanned.emplace_back(-p_t, i);
    }
    std::sort(scanned.begin(), scanned.end());
    const auto found = index.FindFingerprints(queries[static_cast<std::size_t>(q)], {}, nullptr);
    bool same = found.size() == std::min<std::size_t>(10, scanned.size());
    for (std::size_t i = 0; same && i < found.size(); ++i) {
      same = found[i].similarity.p_t == -scanned[i].first;
    }
    std::set<std::size_t> landmarks;
    std::vector<double> best;
    for (const auto& [p_t, i] : scanned) {
      if (best.size() < 10 && landmarks.insert(i / kStepsPerLandmark).second) best.push_back(-p_t);
    }
    const auto distinct = index.FindLandmarks(queries[static_cast<std::size_t>(q)], {}, nullptr);
    same = same && distinct.size() == best.size();
    for (std::size_t i = 0; same && i < distinct.size(); ++i) {
      same = distinct[i].similarity.p_t == best[i];
    }
    unlike += same ? 0 : 1;
  }
  return unlike;
}

// Made once a process, when first asked for.
struct Points {
  LandmarkIndex index;
  faiss::IndexFlatL2 faiss{2};
  std::vector<SeenSides> queries;
  int unlike = 0;
};

std::unique_ptr<Points> MakePoints(Layout layout, std::int64_t size) {
  auto points = std::make_unique<Points>();
  points->queries = DrawQueries(layout);
  const std::vector<Fingerprint> drawn = Draw(layout, size);
  Load(drawn, points->index);
  if (size == 1'000'000) points->unlike = CountUnlike(points->index, drawn, points->queries);
  std::vector<float> flat;
  for (const Fingerprint& f : drawn) flat.insert(flat.end(), {f.x, f.y});
  points->faiss.add(size, flat.data());
  return points;
}

Points& PointsOf(const std::string& layout, std::int64_t size) {
  static auto* const made =
      new std::map<std::pair<std::string, std::int64_t>, std::unique_ptr<Points>>;
  std::unique_ptr<Points>& points = (*made)[{layout, size}];
  if (!points) points = MakePoints(LayoutOf(layout), size);
  return *points;
}

void QueryIndex(benchmark::State& state, const std::string& layout) {
  const Points& points = PointsOf(layout, state.range(0));
  SearchCost cost;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        points.index.FindLandmarks(points.queries[next++ % kQueries], {}, nullptr, &cost));
  }
  const auto size = static_cast<double>(state.range(0));
  state.counters["visited"] =
      static_cast<double>(cost.visited) / static_cast<double>(state.iterations());
  state.counters["bytes"] = static_cast<double>(points.index.MemoryBytes()) / size;
  state.counters["unlike"] = points.unlike;
}

void QueryFaiss(benchmark::State& state, const std::string& layout) {
  omp_set_num_threads(1);
  const Points& points = PointsOf(layout, state.range(0));
  std::array<float, 10> distances{};
  std::array<faiss::Index::idx_t, 10> found{};
  std::size_t next = 0;
  for (auto _ : state) {
    const SeenLandmark& seen = points.queries[next++ % kQueries][0].front();
    const std::array<float, 2> query{seen.x, seen.y};
    points.faiss.search(1, query.data(), 10, distances.data(), found.data());
    benchmark::DoNotOptimize(found);
  }
}

void BuildIndex(benchmark::State& state, const std::string& layout) {
  const std::vector<Fingerprint> drawn = Draw(LayoutOf(layout), state.range(0));
  for (auto _ : state) {
    LandmarkIndex index;
    const double start = ThreadSeconds();
    Load(drawn, index);
    state.counters["s_per_million"] =
        (ThreadSeconds() - start) / static_cast<double>(drawn.size()) * 1e6;
  }
}

// An index that grew by appends alone; then the longest of a hundred thousand more.
void AppendToIndex(benchmark::State& state) {
  const std::vector<Fingerprint> drawn = Draw(Layout::kCity, state.range(0));
  const std::vector<Fingerprint> more(drawn.begin(), drawn.begin() + 100'000);
  for (auto _ : state) {
    LandmarkIndex index;
    AppendAll(drawn, index);
    state.counters["bytes"] =
        static_cast<double>(index.MemoryBytes()) / static_cast<double>(drawn.size());
    const int journey = index.AddJourney("robots/last/journeys/last", {});
    double longest = 0;
    for (std::size_t i = 0; i < more.size(); ++i) {
      const JourneyStep step = StepOf(static_cast<std::int64_t>(i), more[i]);
      const double start = ThreadSeconds();
      index.Append(journey, step);
      longest = std::max(longest, ThreadSeconds() - start);
    }
    state.counters["longest_ms"] = longest * 1e3;
  }
}

}  // namespace

void RegisterIndexBenchmarks(bool quick) {
  const std::int64_t most = quick ? 1'000'000 : 10'000'000;
  for (const std::string layout : {"uniform", "city"}) {
    auto* ours = benchmark::RegisterBenchmark(
        ("index_" + layout).c_str(),
        [layout](benchmark::State& state) { QueryIndex(state, layout); });
    auto* peer = benchmark::RegisterBenchmark(
        ("faiss_" + layout).c_str(),
        [layout](benchmark::State& state) { QueryFaiss(state, layout); });
    for (std::int64_t size = 1000; size <= most; size *= 10) {
      ours->Arg(size)->Unit(benchmark::kMicrosecond);
      peer->Arg(size)->Unit(benchmark::kMicrosecond);
    }
    benchmark::RegisterBenchmark(("index_build_" + layout).c_str(),
                                 [layout](benchmark::State& state) { BuildIndex(state, layout); })
        ->Arg(most)
        ->Iterations(1)
        ->Unit(benchmark::kSecond);
  }
  benchmark::RegisterBenchmark("index_append", AppendToIndex)
      ->Arg(1'000'000)
      ->Iterations(1)
      ->Unit(benchmark::kSecond);
}

}  // namespace homing::benchmarks
