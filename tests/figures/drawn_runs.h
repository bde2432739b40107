// SPDX-License-Identifier: GPL-3.0-or-later
// Runs to be drawn, and how.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include <sinew/figures/snapshots.h>
#include <sinew/run/simulate.h>
#include <sinew/settings/read_scene.h>
#include "support/temp_folder.h"

namespace sinew::test {

/// The folder of the scene's run.
inline RunFolder run_of_scene(const TempFolder& folder, const std::string& scene) {
  const RunFolder run{folder.path() / "run"};
  EXPECT_EQ(simulate(read_scene(folder.write("scene.yaml", scene).string()), run).exit, Exit::done);
  return run;
}

inline DrawnRunOptions drawn_as(const char* view) {
  DrawnRunOptions options;
  options.presets = {view_preset_named(view)};
  return options;
}

}  // namespace sinew::test
