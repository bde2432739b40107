// SPDX-License-Identifier: GPL-3.0-or-later
// The directions of the scene's axes in a corner of a picture.
//
//     draw_tripod(image, camera.view, 10, image.height - 10, tripod_size(image.width,
//     image.height));
#pragma once

#include <sinew/render/image.h>

namespace sinew {

/// Length of an axis that lies in the picture, for a panel of this size, pixels.
int tripod_size(int width, int height);

/// X, Y and Z in red, green and blue as `view` (rows: right, up, toward the viewer) shows them, in
/// a square above and to the right of (x, y), about 2.8 times `size` wide.
void draw_tripod(Image& image, const Mat3& view, int x, int y, int size);

}  // namespace sinew
