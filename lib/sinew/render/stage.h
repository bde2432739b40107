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
  quick,  ///< rendered once, its edges smoothed afterwards, without soft shadows: for movies
  fine,   ///< rendered at twice the size, with soft shadows: for pictures
};

/// What the camera sees: a picture of width x height pixels, each `pixel` (m) in size, about the
/// middle of the camera's frame.
struct Shot {
  Camera camera;
  int width = 960, height = 720;
  double pixel = 1;
  Finish finish = Finish::fine;
  Color background = palette::paper;
  double reach = 0;  ///< reach of what is drawn beyond its points, such as the radius of spheres, m
  int tile = 2560;  ///< rendered pixels: larger pictures are drawn in tiles, which take less memory
};

struct Exposure {
  Image image;
  DepthImage depth;                   ///< empty where not measured
  std::vector<float> coverage;        ///< covered part of each pixel, 0 .. 1; likewise
  Color background = palette::paper;  ///< which is the rest of it
};

/// Depth and coverage take a third of the time where graphics are computed.
enum class Readback { all, colors };

class Stage {
 public:
  Stage();  ///< throws Error (not written) where the display cannot draw
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void aim(const Shot& shot);
  const Mat3& view() const;  ///< axes of the camera
  /// Where something `depth` (m) deep in a pixel is, m.
  Vec3 place_at(int x, int y, double depth) const;
  /// To which actors are added.
  vtkRenderer& renderer();
  /// Renders the actors and clears the stage.
  Exposure render(Readback readback = Readback::all);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew
