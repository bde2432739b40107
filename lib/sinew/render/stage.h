// SPDX-License-Identifier: GPL-3.0-or-later
// The place in front of the camera: a window nobody sees, its lights, and what the camera records.
#pragma once

#include <memory>

#include <sinew/render/camera.h>
#include <sinew/render/image.h>
#include <sinew/render/shading.h>

class vtkRenderer;

namespace sinew {

enum class Finish {
  quick,  ///< edges smoothed afterwards: for movies
  fine,   ///< drawn at twice the size: for pictures
};

struct Exposure {
  Image image;
  DepthImage depth;
  std::vector<float> coverage;  ///< how much of each pixel something covers, 0 .. 1
};

class Stage {
 public:
  Stage();  ///< throws Error (not written) when the display cannot draw
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Sets up the camera for pictures of width x height pixels, each `pixel` (m) in size, about the
  /// middle of its frame.
  void aim(const Camera& camera, int width, int height, double pixel, Finish finish);
  /// Put things here.
  vtkRenderer& renderer();
  /// Draws what was put there and clears the stage.
  Exposure render();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sinew
