// SPDX-License-Identifier: GPL-3.0-or-later
// measure_run SCENE.yaml DIR: simulates a scene into a folder and measures what happened there.
#include <sinew/sinew.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: measure_run SCENE.yaml DIR\n"), 2;
  try {
    const sinew::RunFolder folder{argv[2]};
    sinew::SimulateOptions options;
    options.force = true;  // replaces an older run in the folder
    sinew::simulate(sinew::read_scene(argv[1]), folder, options);

    const sinew::RunFiles run = sinew::open_run(folder);
    const sinew::Measured measured = sinew::measure_run(run, {});
    const sinew::FrameMetrics& last = measured.frames.back();
    std::printf("tip %.2f degrees, volume error %.4f, %g inverted\n", last.tip_angle,
                last.volume_error, last.inverted);
  } catch (const sinew::Error& error) {
    return std::fprintf(stderr, "%s\n", error.what()), static_cast<int>(error.exit());
  }
}
