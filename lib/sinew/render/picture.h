// SPDX-License-Identifier: GPL-3.0-or-later
// Draws a snapshot. Needs an X display (<sinew/display/display.h>).
//
//     Painter painter(rest_surface, scale);
//     const Image image = painter.draw(snapshot, {.view = View::particles, .camera = camera});
#pragma once

#include <sinew/render/shading.h>
#include <sinew/render/stage.h>

namespace sinew {

enum class View {
  surface,    ///< the skin, colored by its values if it has some, the bones visible through it
  particles,  ///< spheres of their true size, colored by their values
  halves,     ///< a part of the skin, and beside it the particles, with the bones through both
  cut,      ///< the skin of one side of the snapshot's cut, the cut, colored by its values, and the
            ///< particles behind it, where its cells are torn
  both,     ///< the particles inside the wireframe of the skin, and the bones
  arrows,   ///< the snapshot's arrows inside a pale skin
  lines,    ///< the snapshot's lines inside a pale skin
  curves,   ///< the snapshot's curves inside a pale skin
  bones,    ///< the bones and their axes inside a pale skin
  binding,  ///< the bones, the particles with the lines to their reference points and the arrows
            ///< of their forces inside a pale skin
  plan,     ///< the bones and marked particles inside a pale skin, muscles as a red tint
};

/// Whether the colors of this view of a snapshot show values.
inline bool shows_values(View view, const Snapshot& snapshot) {
  return view == View::particles || view == View::halves || view == View::cut ||
         view == View::both || view == View::arrows || view == View::lines ||
         view == View::curves || view == View::binding ||
         (view == View::surface && !snapshot.skin_values.empty());
}

/// Whether this view shows the body itself, with dots on held particles, not what is within it.
inline bool shows_particles_or_skin(View view) {
  return view == View::surface || view == View::halves || view == View::cut ||
         view == View::particles || view == View::both;
}

/// Whether this view shows the axes of bones.
inline bool shows_axes(View view) {
  return view == View::surface || view == View::halves || view == View::cut || view == View::both ||
         view == View::bones || view == View::plan;
}

struct PictureOptions {
  View view = View::both;
  Camera camera;
  int width = 960, height = 720;  ///< pixels
  int margin = 24;                ///< pixels around the camera's frame, at least
  Finish finish = Finish::fine;
  Paper paper = {};
  int tile = Shot().tile;  ///< see Shot
};

inline constexpr int largest_picture = 8192;  ///< pixels in either direction

/// The most memory that drawing and writing a page of this size takes, bytes.
double memory_of_picture(int width, int height);

/// Holds what all pictures of a run share: the stage, the skin's edges and the color scale.
class Painter {
 public:
  /// `rest` is the surface at rest; the snapshots have its faces. Throws as Stage does.
  Painter(const Triangles& rest, ColorScale scale);

  const ColorScale& scale() const { return scale_; }

  /// Throws bad input for a snapshot that does not fit the rest surface or has not one value per
  /// particle and point of the surface (or none), and for a size outside 16 .. 8192.
  Image draw(const Snapshot& snapshot, const PictureOptions& options);

 private:
  struct Sizes;
  Image drawn(const Snapshot& snapshot, const PictureOptions& options);
  Exposure shaded(Readback readback, const Sizes& sizes, double radius);
  Exposure opaque(const Sizes& sizes, double radius);
  Exposure body(const Snapshot& snapshot, const Sizes& sizes, View view);
  Exposure particles(const Snapshot& snapshot, const Sizes& sizes, bool skin_and_bones);
  Exposure surface(const Snapshot& snapshot, const Sizes& sizes, bool beside_particles);
  Exposure pale_skin(const Snapshot& snapshot, const Sizes& sizes);
  void add_binding(const Snapshot& snapshot, const Sizes& sizes);
  void tint_muscles(Exposure& picture, const Snapshot& snapshot);
  void put_left_out(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes);
  void put_traces(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes);
  void put_forces(Exposure& picture, const Snapshot& snapshot, const Paper& paper);
  void throw_shadow(Exposure& ground, const Snapshot& snapshot) const;
  void put_obstacles(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes);

  Shading skin_;
  ColorScale scale_;
  Stage stage_;
};

}  // namespace sinew
