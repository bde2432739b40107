// SPDX-License-Identifier: GPL-3.0-or-later
// A command that does little more than what all commands share; command_test.cpp runs it.
#include <sinew/core/parallel.h>
#include <sinew/settings/read_scene.h>
#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"

using namespace sinew;

namespace {

const About about = {
    "sample", "Reads a scene.", {"sinew sample scene.yaml --set body.radius=0.02"}};

struct Options {
  std::string scene, fail;
};

void fail_as_asked(const std::string& way) {
  if (way == "write") throw not_written("a.vtu", "the disk is full", "free some space");
  if (way == "memory") throw std::bad_alloc();
  if (way == "surprise") throw std::runtime_error("two\nlines");
}

Exit sample(const Options& options, const Common& common) {
  fail_as_asked(options.fail);
  const Settings settings = read_scene(options.scene, common.overrides);
  Progress progress(20, progress_style(common.quiet));
  for (int frame = 0; frame <= 20; ++frame) progress.frame(frame, frame * 0.1, frame * 100);
  say(common, "talk");
  Results results;
  results.add("mesh", settings.body.mesh);
  results.add("bones", settings.bones.size());
  results.add("radius", settings.body.radius.value_or(0));
  results.print(common);
  return options.fail == "limit" ? Exit::limit_passed : Exit::done;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const auto declare = [&](OptionList& list) {
    list.add("SCENE", options.scene, "The scene").required();
    list.add("--fail", options.fail, "A way to fail");
  };
  return run_command(argc, argv, about, declare,
                     [&](const Common& common) { return sample(options, common); });
}
