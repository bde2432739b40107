// SPDX-License-Identifier: GPL-3.0-or-later
// What `run` and `simulate` are asked alike.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sinew {

struct RunOptions {
  std::string scene, folder;
  bool force = false, resume = false;
  std::string asked_of = "simulate";  ///< what the user called, and calls to go on
};

inline void declare(CLI::App& app, RunOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file (YAML)")->required();
  app.add_option("-o", options.folder, "Folder of the run; by default out/NAME-OF-SCENE")
      ->type_name("DIR");
  auto* force = app.add_flag("--force", options.force, "Replace an older run in the folder");
  app.add_flag("--resume", options.resume, "Go on with a run that was stopped")->excludes(force);
  app.add_option("--asked-of", options.asked_of)->group("");  // hidden: run says it to simulate
}

}  // namespace sinew
