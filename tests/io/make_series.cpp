// SPDX-License-Identifier: GPL-3.0-or-later
// make_series FOLDER [zlib | lz4 | raw | none]: leaves the series of a synthetic run there, for the
// tests that open them with ParaView and meshio.
#include <iostream>
#include <map>

#include "io/series.h"
#include "io/view_script.h"
#include "synthetic_run.h"

namespace {

using namespace sinew;

void write(const std::filesystem::path& folder, Encoding encoding) {
  const SyntheticRun run;
  const auto format = [&](const char* series) {
    return VtuFormat{encoding, false, series, SyntheticRun::radius};
  };
  Series particles(folder, format("particles")), surface(folder, format("surface"));
  Series bones(folder, format("bones")), frames(folder, format("frames"));
  constexpr int last = 30;
  for (int step = 0; step <= last; ++step) {
    const Moment moment{SyntheticRun::half_turn * step / last, 100 * step};
    Dataset body = run.particles(moment);
    body.meta = R"({"made_by": "make_series"})";
    particles.add(body);
    surface.add(run.surface(moment));
    bones.add(run.bones(moment));
    frames.add(run.frames(moment));
  }
  for (Series* series : {&particles, &surface, &bones, &frames}) series->close();
  write_body(folder / "body.vtu", run.body(), encoding);
  write_view_script(folder);
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, Encoding> encodings = {{"zlib", Encoding::zlib},
                                                     {"lz4", Encoding::lz4},
                                                     {"raw", Encoding::raw},
                                                     {"none", Encoding::none}};
  const auto encoding = encodings.find(argc > 2 ? argv[2] : "zlib");
  if (argc < 2 || encoding == encodings.end()) {
    std::cerr << "usage: make_series FOLDER [zlib | lz4 | raw | none]\n";
    return 2;
  }
  write(argv[1], encoding->second);
}
