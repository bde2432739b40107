// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/picture.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/render/actors.h>

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
  for (const int point : skin.source)
    if (point >= static_cast<int>(snapshot.surface.points.size()))
      throw bad_input("a snapshot's surface has fewer points than at rest",
                      "draw one run at a time");
}

/// Of a value of 0 to 255.
std::uint8_t byte_of(float value) { return static_cast<std::uint8_t>(value + 0.5F); }

/// Darkens the hollows, but never to black.
void add_shadows(Exposure& exposure, double radius, Sampled sampled) {
  constexpr float strength = 1.1F, least = 0.3F;
  std::vector<std::uint8_t>& rgb = exposure.image.rgb;
  const std::vector<float> hidden = occlusion(exposure.depth, radius, sampled);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (hidden[i] == 0) continue;
    const float light = std::max(least, 1 - strength * hidden[i]);
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      rgb[c] = byte_of(light * static_cast<float>(rgb[c]));
  }
}

Exposure with_shadows(Exposure exposure, double radius, Sampled sampled) {
  add_shadows(exposure, radius, sampled);
  exposure.coverage = {};  // unused, and large in large pictures
  return exposure;
}

/// Blends `over` into the image where it covers anything.
void shine_through(Image& image, const Exposure& over, float strength) {
  for (std::size_t i = 0; i < over.coverage.size(); ++i) {
    if (over.coverage[i] == 0) continue;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const float part = strength * over.coverage[i];
      image.rgb[c] = byte_of(part * static_cast<float>(over.image.rgb[c]) +
                             (1 - part) * static_cast<float>(image.rgb[c]));
    }
  }
}

/// What lies behind the picture's objects covers nothing.
void hide_behind(const DepthImage& objects, Exposure& over) {
  for (std::size_t i = 0; i < over.coverage.size(); ++i)
    if (over.depth.depth[i] > objects.depth[i]) over.coverage[i] = 0;
}

/// Lightened toward white, so that what is drawn over it is visible.
void pale(Image& image) {
  constexpr float left = 0.45F;
  for (std::uint8_t& part : image.rgb) part = byte_of(255 - left * static_cast<float>(255 - part));
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
  Sampled shadows;
};

Painter::Painter(const Triangles& rest, ColorScale scale)
    : skin_(make_shading(rest)), scale_(std::move(scale)) {}

Exposure Painter::particles(const Snapshot& snapshot, const Sizes& sizes, bool skin_and_bones) {
  add_particles(stage_.renderer(), snapshot, scale_);
  if (skin_and_bones) {
    add_creases(stage_.renderer(), snapshot, skin_,
                {sizes.line, 0.35 * snapshot.radius, sizes.pixel});
    add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, ivory);
  }
  Exposure picture = with_shadows(stage_.render(), 2 * sizes.grain, sizes.shadows);
  if (!skin_and_bones || snapshot.bones.empty()) return picture;
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, ivory);
  shine_through(picture.image, stage_.render(), 0.6F);
  return picture;
}

Exposure Painter::surface(const Snapshot& snapshot, const Sizes& sizes) {
  add_skin(stage_.renderer(), snapshot, skin_);
  add_net(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  add_creases(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, palette::bone);
  Exposure picture = with_shadows(stage_.render(), 5 * sizes.grain, sizes.shadows);
  const Snapshot held = marked(snapshot, Mark::held);
  if (snapshot.bones.empty() && held.particles.empty()) return picture;
  add_bones(stage_.renderer(), snapshot, 1.6 * sizes.grain, palette::bone);
  add_particles(stage_.renderer(), held, scale_);
  shine_through(picture.image, stage_.render(), 0.6F);
  return picture;
}

Exposure Painter::pale_skin(const Snapshot& snapshot, const Sizes& sizes) {
  add_skin(stage_.renderer(), snapshot, skin_);
  add_creases(stage_.renderer(), snapshot, skin_, {sizes.line, 0.6 * sizes.pixel, sizes.pixel});
  Exposure picture = with_shadows(stage_.render(), 5 * sizes.grain, sizes.shadows);
  pale(picture.image);
  return picture;
}

void Painter::tint_muscles(Exposure& picture, const Snapshot& snapshot) {
  const Snapshot muscles = marked(snapshot, Mark::muscle);
  if (muscles.particles.empty()) return;
  add_particles(stage_.renderer(), muscles, scale_);
  shine_through(picture.image, stage_.render(), 0.4F);
}

/// Seen through the obstacles, where they are in front.
void Painter::put_obstacles(Exposure& picture, const Snapshot& snapshot, const Sizes& sizes) {
  if (snapshot.obstacles.faces.empty()) return;
  add_obstacles(stage_.renderer(), snapshot, sizes.line);
  Exposure over = stage_.render();
  hide_behind(picture.depth, over);
  shine_through(picture.image, over, 0.38F);
}

Image Painter::draw(const Snapshot& snapshot, const PictureOptions& options) {
  check(snapshot, skin_, options);
  const Image image = drawn(snapshot, options);
  return options.finish == Finish::quick ? with_smooth_edges(image) : image;
}

Exposure Painter::body(const Snapshot& snapshot, const Sizes& sizes, View view) {
  if (view == View::surface) return surface(snapshot, sizes);
  if (view == View::particles || view == View::both)
    return particles(snapshot, sizes, view == View::both);

  Exposure picture = pale_skin(snapshot, sizes);
  if (view == View::plan) tint_muscles(picture, snapshot);
  if (view == View::plan || view == View::bones)
    add_bones(stage_.renderer(), snapshot, 2.2 * sizes.grain, palette::bone);
  if (view == View::arrows) add_arrows(stage_.renderer(), snapshot, scale_);
  if (view == View::plan)
    for (const Mark mark : {Mark::held, Mark::sample})
      add_particles(stage_.renderer(), marked(snapshot, mark), scale_);
  Exposure over = stage_.render();
  add_shadows(over, 2 * sizes.grain, sizes.shadows);
  shine_through(picture.image, over, 1);
  return picture;
}

Image Painter::drawn(const Snapshot& snapshot, const PictureOptions& options) {
  const double pixel =
      meters_per_pixel(options.camera.frame, std::max(1, options.width - 2 * options.margin),
                       std::max(1, options.height - 2 * options.margin));
  stage_.aim({options.camera, options.width, options.height, pixel, options.finish, options.tile});
  constexpr double least_grain = 4;  // pixels: thinner bones would not be seen in a plan
  const bool fine = options.finish == Finish::fine;
  Sizes sizes{pixel, snapshot.radius > 0 ? snapshot.radius : 8 * pixel, fine ? 2.4 : 1.4,
              fine ? Sampled::every_pixel : Sampled::every_second};
  if (options.view == View::plan) sizes.grain = std::max(sizes.grain, least_grain * pixel);
  Exposure picture = body(snapshot, sizes, options.view);
  put_obstacles(picture, snapshot, sizes);
  return std::move(picture.image);
}

}  // namespace sinew
