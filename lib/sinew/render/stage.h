// SPDX-License-Identifier: GPL-3.0-or-later
// The stage in front of the camera: an offscreen window, its lights, and the rendered image.
//
//     stage.aim({camera, width, height, pixel, Finish::fine});
//     add_particles(stage.renderer(), snapshot, scale);
//     const Exposure exposure = stage.render();
#pragma once

#include <memory>

#include <sinew/render/camera.h>
#include <sinew/render/image.h>
#include <sinew/render/shading.h>

class vtkRenderer;

namespace sinew {

enum class Finish {
  quick,  ///< rendered once, its edges smoothed afterwards: for movies
  fine,   ///< rendered at twice the size: for pictures
};

/// What the camera sees: a picture of width x height pixels, each `pixel` (m) in size, about the
/// middle of the camera's frame.
struct Shot {
  Camera camera;
  int width = 960, height = 720;
  double pixel = 1;
  Finish finish = Finish::fine;
  Color background = palette::paper;
  int tile = 2560;  ///< rendered pixels: larger pictures are drawn in tiles, which take less memory
};

struct Exposure {
  Image image;
  DepthImage depth;
  std::vector<float> coverage;        ///< covered part of each pixel, 0 .. 1
  Color background = palette::paper;  ///< which is the rest of it
};

class Stage {
 public:
  Stage();  ///< throws Error (not written) where the display cannot draw
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void aim(const Shot& shot);
  /// To which actors are added.
  vtkRenderer& renderer();
  /// Renders the actors and clears the stage.
  Exposure render();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew
