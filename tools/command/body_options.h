// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of a body as options of the command line, for meshes without a scene: --radius 0.01
// for body.radius. They come from the table of settings.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include <sinew/settings/read_scene.h>

namespace sinew {

class BodyFlags {
 public:
  enum class Kind {
    all,   ///< each setting of the section body but its mesh, and the density
    mesh,  ///< those that say how the mesh is read
  };

  /// Adds one option for each.
  void declare(CLI::App& app, Kind kind = Kind::all);

  bool any() const { return !overrides().empty(); }

  /// What was given, as overrides for settings_of_mesh().
  std::vector<Override> overrides() const;

 private:
  struct Given {
    std::string path, option, value;
    bool flag;
    const CLI::Option* parsed;
  };
  std::vector<Given> given_;
};

}  // namespace sinew
