// SPDX-License-Identifier: GPL-3.0-or-later
// A run in one picture, as in the paper's figure 4: the surface above, the particles below, over
// time. And the same two side by side, for the frames of a movie.
#pragma once

#include "render/picture.h"

namespace sinew {

struct SheetOptions {
  Mat3 view = three_quarter_view();
  int width = 1600;      ///< at most, pixels
  int row_height = 560;  ///< at most, pixels
  Finish finish = Finish::fine;
};

/// One column per shot, all to one scale, with the captions and the colour scale below.
/// Throws bad input without shots, and as Painter::draw does.
Image contact_sheet(Painter& painter, const std::vector<Shot>& shots, const SheetOptions& options);

struct FrameOptions {
  Camera camera;  ///< the same for all frames of a movie
  int width = 1280, height = 720;
  Finish finish = Finish::quick;
};

/// Surface and particles side by side, the caption below on the left, the colour scale on the
/// right.
Image movie_frame(Painter& painter, const Shot& shot, const FrameOptions& options);

}  // namespace sinew
