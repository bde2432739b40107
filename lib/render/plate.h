// SPDX-License-Identifier: GPL-3.0-or-later
// A picture with words: one or more panels side by side, below them the caption and the meaning of
// the colours.
#pragma once

#include "render/picture.h"

namespace sinew {

/// One view of one shot.
struct Panel {
  Painter* painter = nullptr;
  const Shot* shot = nullptr;
  View view = View::both;
  std::string title;  ///< above it, or empty
};

struct PlateOptions {
  Camera camera;  ///< the same for all panels, and for all frames of a movie
  int width = 1280, height = 720;
  Finish finish = Finish::fine;
};

/// The caption is that of the first panel's shot, the colour scale that of its painter: all panels
/// share it. Throws bad input without panels, and as Painter::draw does.
Image plate(const std::vector<Panel>& panels, const PlateOptions& options);

}  // namespace sinew
