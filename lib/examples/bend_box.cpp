// SPDX-License-Identifier: GPL-3.0-or-later
// bend_box SCENE.yaml DIR: steps a scene and writes its frames as series for ParaView.
#include <sinew/sinew.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: bend_box SCENE.yaml DIR\n"), 2;
  try {
    const sinew::Settings scene = sinew::read_scene(argv[1]);
    const sinew::Prepared prepared = sinew::prepare({scene});
    sinew::Simulation simulation = sinew::start(prepared);
    sinew::FrameWriter writer(argv[2], scene.output, prepared);
    for (int frame = 0; frame <= prepared.frames.count; ++frame) {
      while (simulation.steps() < prepared.plan.steps_until(frame)) simulation.step();
      writer.add(simulation, prepared.frames.at(frame));
    }
    writer.close();
    std::printf("%d frames of %zu particles\n", writer.written(), prepared.filled.particles.size());
  } catch (const sinew::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), static_cast<int>(error.exit());
  }
}
