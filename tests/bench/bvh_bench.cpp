// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a BVH file of 31 joints and 4,500 frames (4.5 MB): the text alone, and up to the rig.
//
//   cmake --build build --target benches
//   build/bench/bvh_bench

#include <benchmark/benchmark.h>

#include <sinew/rig/bvh/bvh.h>

#include "rig/bvh/bvh_files.h"

namespace {

using namespace sinew;

const std::string& text() {
  static const std::string text = bvh_files::long_clip(31, 4500);
  return text;
}

void read_text(benchmark::State& state) {
  for (auto _ : state) {
    auto parsed = parse_bvh(text(), "long.bvh");
    benchmark::DoNotOptimize(parsed);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text().size()));
}

void read_rig(benchmark::State& state) {
  BvhOptions options;
  options.rate = static_cast<double>(state.range(0));
  for (auto _ : state) {
    auto rig = rig_of(parse_bvh(text(), "long.bvh"), options);
    benchmark::DoNotOptimize(rig);
  }
}

BENCHMARK(read_text)->Unit(benchmark::kMillisecond);
BENCHMARK(read_rig)->ArgName("rate")->Arg(0)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
