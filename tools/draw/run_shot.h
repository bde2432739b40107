// SPDX-License-Identifier: GPL-3.0-or-later
// A frame of a run as a picture shows it.
#pragma once

#include "folder/run_files.h"
#include "render/shot.h"

namespace sinew {

/// `angle`: what the caption says of the bones, rad. Bones are as long as they are in the frame.
Shot shot_of(const RunFiles& run, RunFrame frame, double angle);

}  // namespace sinew
