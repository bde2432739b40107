// SPDX-License-Identifier: GPL-3.0-or-later
// make_series FOLDER [zlib | lz4 | raw | none [FRAMES PAUSE]]: leaves the series of a synthetic run
// there, for the tests that open them with ParaView and meshio; PAUSE seconds between its frames,
// for those that watch a run while it goes.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <thread>

#include <sinew/io/paraview/view_state.h>
#include <sinew/io/series.h>
#include "synthetic_run.h"

namespace {

using namespace sinew;

void write(const std::filesystem::path& folder, Encoding encoding, int count, double pause) {
  const SyntheticRun run;
  const auto format = [&](const char* series) {
    return VtuFormat{encoding, false, series, SyntheticRun::radius};
  };
  std::filesystem::create_directories(folder);
  write_body(folder / "body.vtu", run.body(), encoding);
  Series particles(folder, format("particles")), surface(folder, format("surface"));
  Series bones(folder, format("bones")), frames(folder, format("frames"));
  for (int step = 0; step < count; ++step) {
    const Moment moment{SyntheticRun::half_turn * step / (count - 1), 100 * step};
    Dataset body = run.particles(moment);
    body.meta = R"({"made_by": "make_series"})";
    particles.add(body);
    surface.add(run.surface(moment));
    bones.add(run.bones(moment));
    frames.add(run.frames(moment));
    if (step == 0) write_view_state(folder, folder / "view.pvsm");
    std::this_thread::sleep_for(std::chrono::duration<double>(pause));
  }
  for (Series* series : {&particles, &surface, &bones, &frames}) series->close();
  write_view_state(folder, folder / "view.pvsm");
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, Encoding> encodings = {{"zlib", Encoding::zlib},
                                                     {"lz4", Encoding::lz4},
                                                     {"raw", Encoding::raw},
                                                     {"none", Encoding::none}};
  const auto encoding = encodings.find(argc > 2 ? argv[2] : "zlib");
  if (argc < 2 || encoding == encodings.end()) {
    std::cerr << "usage: make_series FOLDER [zlib | lz4 | raw | none [FRAMES PAUSE]]\n";
    return 2;
  }
  const int count = argc > 4 ? std::atoi(argv[3]) : 31;
  write(argv[1], encoding->second, count, argc > 4 ? std::atof(argv[4]) : 0);
}
