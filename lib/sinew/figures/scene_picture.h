// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of a scene before it is run: the bones in the translucent mesh, the size of a particle,
// obstacles, held particles and muscles, with axes in meters.
//
//     write_scene_picture(scene_snapshot(prepared), {}, "scene.png");
#pragma once

#include <string>

#include <sinew/render/elevations.h>
#include <sinew/render/figure.h>
#include <sinew/run/run_files.h>
#include <sinew/scene/intrusions.h>
#include <sinew/scene/prepare.h>

namespace sinew {

/// The scene at rest, its obstacles where they are at the start.
Snapshot scene_snapshot(const Prepared& prepared);

/// The same from the files of its run.
Snapshot scene_snapshot(const RunFiles& run);

/// The skin by dual quaternions where flesh is deepest in other flesh, with the particles that are.
Snapshot intrusion_snapshot(const Prepared& prepared, const Intrusion& found);

/// On the backdrop of `files`, not on the paper of `options`. Needs a display. Throws not written,
/// and as elevations() does.
void write_scene_picture(const Snapshot& scene, const ElevationOptions& options,
                         const PageFiles& files, const std::string& path);

}  // namespace sinew
