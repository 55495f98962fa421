// All that is measured.
#ifndef TESTS_BENCHMARK_BENCHMARKS_H_
#define TESTS_BENCHMARK_BENCHMARKS_H_

namespace homing::benchmarks {

// `quick`: smaller sizes.
void RegisterIndexBenchmarks(bool quick);
void RegisterFrameBenchmarks(bool quick);
void RegisterStreamBenchmarks(bool quick);
void RegisterAppendBenchmarks(bool quick);
void RegisterLocalizeBenchmarks(bool quick);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_BENCHMARKS_H_
