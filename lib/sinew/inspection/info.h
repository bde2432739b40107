// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a file: a mesh, rig, clip, scene or the folder of a run.
//
//     const Info info = info_of({.path = "part.stl"});
//     std::puts(info.findings.json().c_str());
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/inspection/findings.h>
#include <sinew/settings/read_scene.h>

namespace sinew {

struct InfoOptions {
  std::string path;
  std::vector<Override> overrides = {};  ///< settings of a scene, or of the section body of a mesh
  std::optional<double> radius = {};     ///< radius of particles, m: find how fast a rig moves them
  bool verify = false;                   ///< compare the files of a run with their checksums
  std::string drawing = {};              ///< the mesh with its defects is written there; "": not
};

struct Info {
  Findings findings;
  std::vector<std::string> warnings = {};
  std::optional<Error> damage = {};  ///< damage of a run that was verified
};

/// Throws bad input, naming the file, for what cannot be read, and not written.
Info info_of(const InfoOptions& options);

}  // namespace sinew
