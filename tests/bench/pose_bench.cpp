// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of evaluating a clip of 31 joints and 4,500 frames for a pose at every step of a body of
// 2,965 particles: the time of a step, and the fraction of it that the pose takes. The pose is
// timed between two steps, with its data out of the nearer caches, as stepping leaves them.
//
//   cmake --build build --target benches
//   build/bench/pose_bench

#include <benchmark/benchmark.h>

#include <sinew/core/system.h>
#include <sinew/core/vector.h>

#include "support/world.h"

namespace {

using namespace sinew;

constexpr int joints = 31, frames = 4500;
constexpr double frame_time = 1.0 / 120;  // s

Settings chain() {
  Settings settings = test::box_scene();
  const double height = settings.bones[1].tail->z();
  settings.bones.clear();
  for (int i = 0; i < joints; ++i) {
    BoneDefinition bone;
    bone.name = "joint" + std::to_string(i);
    if (i == 0) bone.head = Vec3::Zero();
    if (i > 0) bone.parent = settings.bones.back().name;
    bone.tail = Vec3(0, 0, height * (i + 1) / joints);
    settings.bones.push_back(bone);
  }
  return settings;
}

/// Every joint sways a little, the first one moves.
Motion swaying(Interpolation interpolation) {
  Motion motion;
  for (int i = 0; i < joints; ++i) {
    Track track;
    track.bone = i;
    track.rotation.interpolation = track.translation.interpolation = interpolation;
    for (int k = 0; k < frames; ++k) {
      const double time = k * frame_time;
      const Vec3 turn = 1e-3 * Vec3(std::sin(time + i), std::cos(2 * time), std::sin(3 * time));
      track.rotation.times.push_back(time);
      track.rotation.values.push_back(rotation_by(turn));
      if (i > 0) continue;
      track.translation.times.push_back(time);
      track.translation.values.push_back(turn);
    }
    motion.tracks.push_back(std::move(track));
  }
  return played(motion, {});
}

void pose_of_a_step(benchmark::State& state, Interpolation interpolation, Precision precision) {
  const Settings settings = chain();
  const Points rest = test::fcc_box(11, 11, 49, *settings.body.radius);
  const Body body = test::make_body(settings, rest);
  Stepping stepping;
  stepping.step = 0.5 * step_limit(Integrator::symplectic_euler, body.material, body.springs);
  stepping.precision = precision;
  Simulation simulation(body, swaying(interpolation),
                        particles_at(rest, *settings.body.radius, body.material.mass), stepping);
  double posing = 0, stepped = 0;
  for (auto _ : state) {
    Stopwatch watch;
    auto pose = simulation.pose();
    benchmark::DoNotOptimize(pose);
    posing += watch.lap();
    simulation.step();
    stepped += watch.lap();
  }
  const auto steps = static_cast<double>(state.iterations());
  state.counters["pose_us"] = 1e6 * posing / steps;
  state.counters["step_us"] = 1e6 * stepped / steps;
  state.counters["percent"] = 100 * posing / stepped;
}

BENCHMARK_CAPTURE(pose_of_a_step, linear_double, Interpolation::linear, Precision::binary64)
    ->Iterations(15000);
BENCHMARK_CAPTURE(pose_of_a_step, smooth_double, Interpolation::smooth, Precision::binary64)
    ->Iterations(15000);
BENCHMARK_CAPTURE(pose_of_a_step, cubic_double, Interpolation::cubic, Precision::binary64)
    ->Iterations(15000);
BENCHMARK_CAPTURE(pose_of_a_step, linear_single, Interpolation::linear, Precision::binary32)
    ->Iterations(15000);
BENCHMARK_CAPTURE(pose_of_a_step, cubic_single, Interpolation::cubic, Precision::binary32)
    ->Iterations(15000);

}  // namespace

BENCHMARK_MAIN();
