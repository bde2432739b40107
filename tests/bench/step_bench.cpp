// SPDX-License-Identifier: GPL-3.0-or-later
// Million particle-steps per second (Mps) of whole steps: pair forces, damping, bones, integration,
// checks and the energy ledger. The label is the hash of the state after the first five steps; it
// must not depend on the number of threads. The limits of this machine are beside them.
//
//   cmake --build build --target benches
//   build/bench/step_bench --benchmark_filter=/rest/
//   build/bench/step_bench --states=FOLDER ...      states written by make_state
//
// Names are step/CONDITION/PARTICLES/KIND/threads:N, and
// law/VARIANT/CONDITION/PARTICLES/KIND/threads:N for what is not the paper's. tests/bench/run.sh
// makes tables of them.

#include <benchmark/benchmark.h>
#include <algorithm>
#include <cstdio>
#include <memory>

#include <sinew/core/hash.h>
#include <sinew/core/parallel.h>
#include <sinew/core/system.h>
#include <sinew/lists/list_counts.h>

#include "bench/all_pairs.h"
#include "bench/limits.h"
#include "bench/peak_memory.h"
#include "bench/state_file.h"

namespace {

using namespace sinew;
using namespace sinew::bench;

enum class Kind { single, binary64, cells, all_pairs };
constexpr std::array kinds{"single", "double", "cells", "all_pairs"};
constexpr std::size_t counts[] = {3'000, 30'000, 300'000, 3'000'000};
constexpr std::size_t max_for_all_pairs = 3'000;
constexpr int first_steps = 5;  // build what is kept between steps; then the hash is taken

std::filesystem::path states_folder;  // empty: states are made here

struct Case {
  Condition condition;
  std::size_t count;
  Kind kind;
  int threads;
  Variant variant = Variant::paper;
};

struct Prepared {
  Condition condition;
  std::size_t count;
  Variant variant;
  Scene scene;
  Particles particles;
};

Prepared prepare(Condition condition, std::size_t count, Variant variant) {
  Prepared prepared{condition, count, variant, scene_of(condition, count, variant), {}};
  const auto path = state_path(states_folder, condition, count);
  const bool made = !states_folder.empty() && variant == Variant::paper && exists(path);
  prepared.particles = made ? read_state(path, prepared.scene) : settled(prepared.scene, condition);
  return prepared;
}

/// The state of the last call is cached: those of all sizes together are large.
const Prepared& prepared(const Case& what) {
  static std::unique_ptr<Prepared> last;
  if (!last || last->condition != what.condition || last->count != what.count ||
      last->variant != what.variant) {
    last.reset();
    last = std::make_unique<Prepared>(prepare(what.condition, what.count, what.variant));
  }
  return *last;
}

/// Stepping of one kind from a prepared state.
class Stepper {
 public:
  Stepper(const Prepared& from, Kind kind) : from_(from) {
    if (kind == Kind::all_pairs) {
      particles_ = from.particles;
      pose_ = pose_at(from.scene.body.skeleton, from.scene.motion, 0);
      return;
    }
    const auto precision = kind == Kind::single ? Precision::binary32 : Precision::binary64;
    const auto search = kind == Kind::cells ? NeighborSearch::cells : NeighborSearch::lists;
    simulation_.reset(new Simulation(simulation_of(from.scene, from.particles, precision, search)));
  }

  void advance(int steps) {
    for (int step = 0; step < steps; ++step) {
      if (simulation_)
        simulation_->step();
      else
        step_all_pairs(particles_, from_.scene.body, pose_, from_.scene.step, forces_);
    }
  }

  ListCounts list_counts() const { return simulation_ ? simulation_->list_counts() : ListCounts{}; }

  std::uint64_t hash() const {
    return state_hash(simulation_ ? simulation_->particles() : particles_);
  }

 private:
  const Prepared& from_;
  std::unique_ptr<Simulation> simulation_;
  Particles particles_;  // of all pairs
  Pose pose_;
  Forces forces_;
};

/// Steps timed together. Lists are rebuilt every so many of them: enough for the mean. The other
/// steppers do the same in every step.
int steps_per_lap(const Case& what) {
  if (what.kind == Kind::all_pairs || what.kind == Kind::cells) return 5;
  return what.count > 1'000'000 ? 40 : 100;
}

/// Lists built in a lap, its first steps included.
void count_lists(benchmark::State& state, const ListCounts& lists) {
  state.counters["rebuilds"] = static_cast<double>(lists.rebuilds);
  state.counters["listed"] = static_cast<double>(lists.listed);
  state.counters["pruned"] = static_cast<double>(lists.pruned);
  state.counters["sorts"] = static_cast<double>(lists.sorts);
  state.counters["offsets"] = lists.inner;
  state.counters["listing_ms"] = 1e3 * lists.rebuilding;
  state.counters["pruning_ms"] = 1e3 * lists.pruning;
  state.counters["checking_ms"] = 1e3 * lists.checking;
}

/// Every lap begins with the same state, which would otherwise relax during the measurement.
void step(benchmark::State& state, Case what) {
  const Prepared& from = prepared(what);
  const int steps = steps_per_lap(what);
  std::uint64_t hash = 0;
  ListCounts lists;
  with_threads(what.threads, [&] {
    for (auto _ : state) {
      Stepper stepper(from, what.kind);
      stepper.advance(first_steps);
      hash = stepper.hash();
      Stopwatch stopwatch;
      stepper.advance(steps);
      state.SetIterationTime(stopwatch.lap());
      lists = stepper.list_counts();
    }
  });
  const double taken = static_cast<double>(from.particles.size()) * steps;
  state.counters["Mps"] = benchmark::Counter(1e-6 * taken * static_cast<double>(state.iterations()),
                                             benchmark::Counter::kIsRate);
  state.counters["particles"] = static_cast<double>(from.particles.size());
  state.SetLabel(hash_text(hash));
  if (what.kind == Kind::single || what.kind == Kind::binary64) count_lists(state, lists);
}

/// Peak memory of a simulation's construction and first steps, including the body's description.
void memory(benchmark::State& state, Case what) {
  const Prepared& from = prepared(what);
  double bytes = 0;
  for (auto _ : state)
    bytes = peak_memory_of([&] { Stepper(from, what.kind).advance(first_steps); });
  state.counters["bytes"] = bytes / static_cast<double>(from.particles.size());
}

void peak(benchmark::State& state, double (*multiply_add)(InstructionSet, std::int64_t)) {
  const InstructionSet set = widest();
  double operations = 0;
  for (auto _ : state) operations += multiply_add(set, 1'000'000);
  state.counters["GFLOP/s"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsRate);
  state.SetLabel(name_of(set));
}

constexpr std::size_t triad_length = 24'000'000;  // 576 MB in all: beyond any cache
constexpr std::size_t triad_piece = 100'000;

/// GB/s as STREAM counts it, 24 bytes; `traffic` counts the line of a that is read before it is
/// written as well, 32 bytes.
void triad(benchmark::State& state, int threads) {
  const std::vector<double> b(triad_length, 1), c(triad_length, 2);
  std::vector<double> a(triad_length);
  const InstructionSet set = widest();
  with_threads(threads, [&] {
    for (auto _ : state)
      parallel_for(triad_length, triad_piece, [&](std::size_t begin, std::size_t end) {
        triad(set, a.data(), b.data(), c.data(), begin, end);
      });
  });
  const double elements = 1e-9 * triad_length * static_cast<double>(state.iterations());
  state.counters["GB/s"] = benchmark::Counter(24 * elements, benchmark::Counter::kIsRate);
  state.counters["traffic"] = benchmark::Counter(32 * elements, benchmark::Counter::kIsRate);
}

template <class... Names>
std::string path_of(const Names&... names) {
  std::string path;
  ((path += path.empty() ? "" : "/", path += names), ...);
  return path;
}

std::string case_path(const Case& what) {
  return path_of(name_of(what.condition), std::to_string(what.count),
                 kinds[static_cast<int>(what.kind)], "threads:" + std::to_string(what.threads));
}

void register_case(const std::string& name, const Case& what) {
  benchmark::RegisterBenchmark(name.c_str(), step, what)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void register_steps(Condition condition, std::size_t count, Kind kind) {
  if (kind == Kind::all_pairs && count > max_for_all_pairs) return;
  for (const int threads : {1, 2}) {
    const Case what{condition, count, kind, threads};
    register_case(path_of("step", case_path(what)), what);
  }
}

void register_laws(Variant variant, Condition condition, std::size_t count) {
  for (const Kind kind : {Kind::single, Kind::binary64, Kind::cells}) {
    if (kind == Kind::cells && variant == Variant::grouped) continue;  // lists alone have groups
    for (const int threads : {1, 2}) {
      const Case what{condition, count, kind, threads, variant};
      register_case(path_of("law", name_of(variant), case_path(what)), what);
    }
  }
}

void register_all() {
  for (const Condition condition : conditions)
    for (const std::size_t count : counts)
      for (const Kind kind : {Kind::single, Kind::binary64, Kind::cells, Kind::all_pairs})
        register_steps(condition, count, kind);
  for (const Variant variant : variants)
    for (const Condition condition : {Condition::rest, Condition::bending})
      for (const std::size_t count : {std::size_t{30'000}, std::size_t{300'000}})
        register_laws(variant, condition, count);
  for (const Variant variant :
       {Variant::paper, Variant::twelve_bonds, Variant::bonded, Variant::bonded_volume})
    for (const Kind kind : {Kind::single, Kind::binary64, Kind::cells})
      benchmark::RegisterBenchmark(
          path_of("memory", name_of(variant), kinds[static_cast<int>(kind)]).c_str(), memory,
          Case{Condition::rest, 300'000, kind, 1, variant})
          ->Iterations(1);
  benchmark::RegisterBenchmark("peak/single", peak, &multiply_add_single);
  benchmark::RegisterBenchmark("peak/double", peak, &multiply_add_double);
  for (const int threads : {1, 2})
    benchmark::RegisterBenchmark(("triad/threads:" + std::to_string(threads)).c_str(), triad,
                                 threads)
        ->UseRealTime();
}

/// Takes --states=FOLDER from the command line.
int without_own_options(int count, char** words) {
  constexpr std::string_view option = "--states=";
  return static_cast<int>(std::remove_if(words + 1, words + count,
                                         [&](std::string_view word) {
                                           if (!word.starts_with(option)) return false;
                                           states_folder = word.substr(option.size());
                                           return true;
                                         }) -
                          words);
}

}  // namespace

int main(int count, char** words) try {
  count = without_own_options(count, words);
  register_all();
  benchmark::Initialize(&count, words);
  if (benchmark::ReportUnrecognizedArguments(count, words)) return 2;
  benchmark::RunSpecifiedBenchmarks();
} catch (const std::exception& error) {
  std::fprintf(stderr, "step_bench: %s\n", error.what());
  return 2;
}
