// SPDX-License-Identifier: GPL-3.0-or-later
// own_force SCENE.yaml: steps a scene under a force of one's own, a wind that grows with height.
#include <sinew/sinew.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_force SCENE.yaml\n"), 2;
  try {
    const sinew::Settings scene = sinew::read_scene(argv[1]);
    sinew::Prepared prepared = sinew::prepare({scene});

    sinew::World world;
    const auto wind = [](const sinew::Vec3& x, const sinew::ParticleInfo& particle) {
      return sinew::Vec3(2 * x.z() * particle.mass, 0, 0);  // N, for 2 m/s^2 per meter of height
    };
    world.fields.push_back({"wind", sinew::CustomForce{wind}, {}, {}});
    prepared.body.world = std::make_shared<const sinew::World>(world);

    sinew::Simulation simulation = sinew::start(prepared);
    while (simulation.time() < 0.1) simulation.step();
    sinew::Vec3 mean = sinew::Vec3::Zero();
    for (std::size_t i = 0; i < prepared.body.rest.size(); ++i)
      mean += simulation.particles().position(i) - prepared.filled.particles.position(i);
    mean /= static_cast<double>(prepared.body.rest.size());
    std::printf("mean displacement %.3g m along x\n", mean.x());
  } catch (const sinew::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), static_cast<int>(error.exit());
  }
}
