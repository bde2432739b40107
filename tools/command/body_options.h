// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of a body as command line options, for meshes without a scene: --radius 0.01 for
// body.radius. They are generated from the table of settings.
//
//     BodyFlags flags;
//     flags.declare(list);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/settings/read_scene.h>
#include "command/option_list.h"

namespace sinew {

class BodyFlags {
 public:
  enum class Kind {
    all,   ///< each setting of the section body except its mesh, and the density
    mesh,  ///< options about reading the mesh
  };

  /// Adds one option for each.
  void declare(OptionList& list, Kind kind = Kind::all);

  bool any() const { return !overrides().empty(); }

  /// The options given, as overrides for settings_of_mesh().
  std::vector<Override> overrides() const;

 private:
  struct Given {
    std::string path, option, value;
    bool flag;
    std::optional<CommandOption> parsed;
  };
  std::vector<Given> given_;
};

}  // namespace sinew
