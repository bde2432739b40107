// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/picture.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/parallel.h>
#include <sinew/render/detail/actors.h>
#include <sinew/render/detail/ground_shadow.h>
#include <sinew/render/detail/text.h>

namespace sinew {
namespace {

constexpr Color ivory{250, 244, 230};

void check(const Snapshot& snapshot, const Shading& skin, const PictureOptions& options) {
  const auto [small, large] = std::minmax(options.width, options.height);
  if (small < 16 || large > largest_picture)
    throw bad_input("a picture cannot have that size",
                    "choose 16 to 8192 pixels in both directions");
  if (!snapshot.values.empty() && snapshot.values.size() != snapshot.particles.size())
    throw bad_input("a snapshot has not one value per particle", "give one each, or none");
  if (!snapshot.marks.empty() && snapshot.marks.size() != snapshot.particles.size())
    throw bad_input("a snapshot has not one mark per particle", "give one each, or none");
  for (const auto* values : {&snapshot.skin_values, &snapshot.skin_sides})
    if (!values->empty() && values->size() != snapshot.surface.points.size())
      throw bad_input("a snapshot has not one value per point of its surface",
                      "give one each, or none");
  if (snapshot.cut.values.size() != snapshot.cut.points.size())
    throw bad_input("a snapshot has not one value per point of its cut", "give one each");
  for (const SnapshotCurve& curve : snapshot.curves)
    if (curve.values.size() != curve.points.size())
      throw bad_input("a snapshot has not one value per point of its curves", "give one each");
  for (const int point : skin.source)
    if (point >= static_cast<int>(snapshot.surface.points.size()))
      throw bad_input("a snapshot's surface has fewer points than at rest",
                      "draw one run at a time");
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

/// What the background leaves of a pixel's part (0 .. 255) that is covered by `coverage`.
float shown_through(const Exposure& exposure, std::size_t part, float coverage) {
  return (1 - coverage) * static_cast<float>(exposure.background[part]);
}

/// Darkens the hollows, but never to black.
void add_shadows(Exposure& exposure, double radius) {
  constexpr float strength = 1.1F, least = 0.3F;
  const std::vector<float> hidden = occlusion(exposure.depth, radius);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (hidden[i] == 0) continue;
    const float light = std::max(least, 1 - strength * hidden[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& part = exposure.image.rgb[3 * i + c];
      const float behind = shown_through(exposure, c, exposure.coverage[i]);
      part = byte_of(light * (static_cast<float>(part) - behind) + behind);
    }
  }
}

/// Blends `over` into the image where it covers anything.
void shine_through(Image& image, const Exposure& over, float strength) {
  for (std::size_t i = 0; i < over.coverage.size(); ++i) {
    const float covered = over.coverage[i];
    if (covered == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& part = image.rgb[3 * i + c];
      const float own =
          static_cast<float>(over.image.rgb[3 * i + c]) - shown_through(over, c, covered);
      part = byte_of(strength * own + (1 - strength * covered) * static_cast<float>(part));
    }
  }
}

/// What lies behind the picture's objects covers nothing.
void hide_behind(const DepthImage& objects, Exposure& over) {
  for (std::size_t i = 0; i < over.coverage.size(); ++i)
    if (over.depth.depth[i] > objects.depth[i]) over.coverage[i] = 0;
}

/// Lightened toward white, so that what is drawn over it is visible.
void pale(Exposure& picture) {
  constexpr float left = 0.45F;
  for (std::size_t i = 0; i < picture.coverage.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& part = picture.image.rgb[3 * i + c];
      const float coverage = picture.coverage[i];
      const float toward = coverage * 255 + shown_through(picture, c, coverage);
      part = byte_of(left * static_cast<float>(part) + (1 - left) * toward);
    }
}

/// With a rim in the background's color: it is read on any other.
void write_rimmed(Image& image, const std::string& text, int x, int y, const Paper& paper) {
  TextStyle words{std::max(11, image.height / 28), paper.background};
  y -= words.size / 2;
  for (int dx = -2; dx <= 2; ++dx)
    for (int dy = -2; dy <= 2; ++dy) write_text(image, text, x + dx, y + dy, words);
  words.color = paper.ink;
  write_text(image, text, x, y, words);
}

/// The labels of the traces, to the right of their particles.
void write_labels(Image& image, const Snapshot& snapshot, const PictureOptions& options,
                  double pixel) {
  if (options.camera.frame.isEmpty()) return;
  const Vec3 center = options.camera.frame.center();
  for (const SnapshotTrace& trace : snapshot.traces) {
    if (trace.path.empty()) continue;
    const Vec3 at = (options.camera.view * trace.path.back() - center) / pixel;
    write_rimmed(image, trace.label,
                 image.width / 2 + static_cast<int>(at.x() + snapshot.radius / pixel) + 4,
                 image.height / 2 - static_cast<int>(at.y()), options.paper);
  }
}

/// A point near what the camera shows: far away graphics lose places, in single precision.
Vec3 origin_of(const Camera& camera) {
  if (camera.frame.isEmpty()) return Vec3::Zero();
  const Vec3 center = camera.view.transpose() * camera.frame.center();
  const Vec3 half = camera.frame.diagonal().norm() / 2 * Vec3::Ones();
  return local_origin(Box(center - half, center + half));
}

Snapshot moved(Snapshot snapshot, const Vec3& by) {
  shift(snapshot, by);
  snapshot.obstacle_space.translate(by);
  return snapshot;
}

PictureOptions moved(PictureOptions options, const Vec3& by) {
  options.camera.frame.translate(options.camera.view * by);
  return options;
}

}  // namespace

double memory_of_picture(int width, int height) {
  // Measured from 1280 x 720 to 8192 x 8192 pixels, with the contact sheet. Tiles take the same
  // from a few million pixels on.
  constexpr double of_program = 300e6, of_tiles = 400e6, bytes_per_pixel = 30, whole_tiles = 8e6;
  const double pixels = static_cast<double>(width) * height;
  return of_program + of_tiles * std::min(1.0, pixels / whole_tiles) + bytes_per_pixel * pixels;
}

/// Sizes in a picture.
struct Painter::Sizes {
  double pixel;  ///< m
  double grain;  ///< unit of shadows and bones: a particle's radius, m
  double line;   ///< width of the skin's edges, in rendered pixels
  bool shadows;
  bool beside;  ///< more is drawn before, behind or around the body
  Color bone;   ///< readable on the paper

  /// What is needed of the body's picture.
  Readback body() const { return shadows || beside ? Readback::all : Readback::colors; }
};

Painter::Painter(const Triangles& rest, ColorScale scale)
    : skin_(make_shading(rest)), scale_(std::move(scale)) {}

/// What is on the stage, with shadows in hollows of about `radius` (m) where it has any.
Exposure Painter::shaded(Readback readback, const Sizes& sizes, double radius) {
  Exposure picture = stage_.render(readback);
  if (sizes.shadows) add_shadows(picture, radius);
  return picture;
}

/// The same without its coverage, which is large in large pictures.
Exposure Painter::opaque(const Sizes& sizes, double radius) {
  Exposure picture = shaded(sizes.body(), sizes, radius);
  picture.coverage = {};
  return picture;
}

Exposure Painter::particles(const Snapshot& snapshot, const Sizes& sizes, bool skin_and_bones) {
  add_particles(stage_.renderer(), snapshot, scale_, stage_.view());
  if (skin_and_bones) {
    add_creases(stage_.renderer(), snapshot, skin_,
                {sizes.line, 0.35 * snapshot.radius, sizes.pixel});
    add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, ivory);
  }
  Exposure picture = opaque(sizes, 2 * sizes.grain);
  if (!skin_and_bones || snapshot.bones.empty()) return picture;
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, ivory);
  shine_through(picture.image, stage_.render(), 0.6F);
  return picture;
}

Exposure Painter::surface(const Snapshot& snapshot, const Sizes& sizes, bool beside_particles) {
  add_skin(stage_.renderer(), snapshot, skin_, scale_);
  if (beside_particles) add_particles(stage_.renderer(), snapshot, scale_, stage_.view());
  add_cut(stage_.renderer(), snapshot, scale_, {1.4 * sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  add_net(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  add_creases(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, sizes.bone);
  const double hollow = (beside_particles ? 2 : 5) * sizes.grain;
  Exposure picture = opaque(sizes, hollow);
  const bool holds =
      std::find(snapshot.marks.begin(), snapshot.marks.end(), Mark::held) != snapshot.marks.end();
  if (snapshot.bones.empty() && !holds) return picture;
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, sizes.bone);
  add_held_dots(stage_.renderer(), snapshot, stage_.view());
  shine_through(picture.image, stage_.render(), 0.6F);
  return picture;
}

Exposure Painter::pale_skin(const Snapshot& snapshot, const Sizes& sizes) {
  add_skin(stage_.renderer(), snapshot, skin_, scale_);
  add_creases(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  Exposure picture = shaded(Readback::all, sizes, 5 * sizes.grain);
  pale(picture);
  return picture;
}

void Painter::add_binding(const Snapshot& snapshot, const Sizes& sizes) {
  vtkRenderer& renderer = stage_.renderer();
  add_bare_bones(renderer, snapshot, 1.2 * sizes.grain, sizes.bone);
  add_references(renderer, snapshot, 0.6 * sizes.grain);
  add_particles(renderer, snapshot, scale_, stage_.view());
  add_lines(renderer, snapshot, scale_, 1.5 * sizes.line);
  add_arrows(renderer, snapshot, scale_);
}

void Painter::tint_muscles(Exposure& picture, const Snapshot& snapshot) {
  const Snapshot muscles = marked(snapshot, Mark::muscle);
  if (muscles.particles.empty()) return;
  add_particles(stage_.renderer(), muscles, scale_, stage_.view());
  shine_through(picture.image, stage_.render(), 0.4F);
}

/// The skin of what a view has left out, pale, where the picture is empty: it changes no color.
void Painter::put_left_out(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes) {
  if (!snapshot.opened) return;
  Snapshot skin;
  skin.surface = snapshot.surface;
  skin.radius = snapshot.radius;
  Exposure around = pale_skin(skin, sizes);
  for (std::size_t i = 0; i < around.coverage.size(); ++i)
    if (std::isfinite(picture.depth.depth[i])) around.coverage[i] = 0;
  shine_through(picture.image, around, 0.55F);
}

/// Seen through the obstacles, where they are in front.
void Painter::put_obstacles(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes) {
  if (snapshot.obstacles.faces.empty()) return;
  add_obstacles(stage_.renderer(), snapshot, sizes.line);
  Exposure over = stage_.render();
  throw_shadow(over, snapshot);
  hide_behind(picture.depth, over);
  shine_through(picture.image, over, 0.38F);
}

/// Darkens what lies below the body.
void Painter::throw_shadow(Exposure& ground, const Snapshot& snapshot) const {
  constexpr double strength = 0.85;
  const GroundShadow shadow(snapshot.particles, snapshot.radius);
  parallel_for(static_cast<std::size_t>(ground.image.height), 16,
               [&](std::size_t begin, std::size_t end) {
                 for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                   for (int x = 0; x < ground.image.width; ++x) {
                     const float depth = ground.depth.at(x, y);
                     if (!std::isfinite(depth)) continue;
                     const double light = 1 - strength * shadow.at(stage_.place_at(x, y, depth));
                     for (int c = 0; c < 3; ++c) {
                       std::uint8_t& part = ground.image.at(x, y)[c];
                       part = static_cast<std::uint8_t>(light * part);
                     }
                   }
               });
}

/// Nothing hides them: they often lie within the body.
void Painter::put_traces(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes) {
  if (snapshot.traces.empty()) return;
  constexpr double least = 3;  // pixels
  add_traces(stage_.renderer(), snapshot, std::max(0.5 * sizes.grain, least * sizes.pixel));
  shine_through(picture.image, stage_.render(), 1);
}

/// Nothing hides them either.
void Painter::put_forces(Exposure& picture, const Snapshot& snapshot, const Paper& paper) {
  if (snapshot.forces.empty()) return;
  add_forces(stage_.renderer(), snapshot, paper);
  shine_through(picture.image, stage_.render(), 1);
}

Image Painter::draw(const Snapshot& snapshot, const PictureOptions& options) {
  check(snapshot, skin_, options);
  const Vec3 origin = origin_of(options.camera);
  const Image image = origin.isZero(0) ? drawn(snapshot, options)
                                       : drawn(moved(snapshot, -origin), moved(options, -origin));
  return options.finish == Finish::quick ? with_smooth_edges(image) : image;
}

Exposure Painter::body(const Snapshot& snapshot, const Sizes& sizes, View view) {
  const bool of_skin = view == View::surface || view == View::halves || view == View::cut;
  if (shows_particles_or_skin(view)) {
    Exposure picture = of_skin ? surface(snapshot, sizes, view != View::surface)
                               : particles(snapshot, sizes, view == View::both);
    put_left_out(picture, snapshot, sizes);
    return picture;
  }

  Exposure picture = pale_skin(snapshot, sizes);
  picture.coverage = {};
  put_left_out(picture, snapshot, sizes);
  if (view == View::plan) tint_muscles(picture, snapshot);
  if (view == View::plan || view == View::bones)
    add_bones(stage_.renderer(), snapshot, 2.2 * sizes.grain, sizes.bone);
  if (view == View::binding) add_binding(snapshot, sizes);
  if (view == View::arrows) add_arrows(stage_.renderer(), snapshot, scale_);
  if (view == View::lines) add_lines(stage_.renderer(), snapshot, scale_, sizes.line);
  if (view == View::curves)
    add_curves(stage_.renderer(), snapshot, scale_, std::max(0.5 * sizes.grain, 3 * sizes.pixel));
  if (view == View::plan)
    for (const Mark mark : {Mark::held, Mark::loaded, Mark::sample, Mark::within})
      add_particles(stage_.renderer(), marked(snapshot, mark), scale_, stage_.view());
  shine_through(picture.image, shaded(Readback::all, sizes, 2 * sizes.grain), 1);
  return picture;
}

Image Painter::drawn(const Snapshot& snapshot, const PictureOptions& options) {
  const double pixel =
      meters_per_pixel(options.camera.frame, std::max(1, options.width - 2 * options.margin),
                       std::max(1, options.height - 2 * options.margin));
  stage_.aim({options.camera, options.width, options.height, pixel, options.finish,
              options.paper.background, snapshot.radius, options.tile});
  constexpr double min_grain = 4;  // pixels: thinner bones would not be seen in a plan
  const bool fine = options.finish == Finish::fine;
  Sizes sizes{pixel,
              snapshot.radius > 0 ? snapshot.radius : 8 * pixel,
              fine ? 2.4 : 1.4,
              fine,
              snapshot.opened || !snapshot.obstacles.faces.empty(),
              readable_on(options.paper.background, palette::bone)};
  if (options.view == View::plan) sizes.grain = std::max(sizes.grain, min_grain * pixel);
  Exposure picture = body(snapshot, sizes, options.view);
  put_obstacles(picture, snapshot, sizes);
  put_traces(picture, snapshot, sizes);
  put_forces(picture, snapshot, options.paper);
  write_labels(picture.image, snapshot, options, pixel);
  return std::move(picture.image);
}

}  // namespace sinew
