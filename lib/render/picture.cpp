// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "render/actors.h"

namespace sinew {
namespace {

constexpr Colour slate{44, 58, 92}, ivory{250, 244, 230};

void check(const Shot& shot, const Shading& skin, const PictureOptions& options) {
  const auto [small, large] = std::minmax(options.width, options.height);
  if (small < 16 || large > 8192)
    throw bad_input("a picture cannot have that size", "choose 16 to 8192 pixels each way");
  if (!shot.values.empty() && shot.values.size() != shot.particles.size())
    throw bad_input("a shot has not one value per particle", "give one each, or none");
  for (const int point : skin.source)
    if (point >= static_cast<int>(shot.surface.points.size()))
      throw bad_input("a shot's surface has fewer points than at rest", "draw one run at a time");
}

/// The exposure with its hollows darkened; not to black: some light always gets in.
Image with_shadows(const Exposure& exposure, double radius) {
  constexpr float strength = 1.1F, least = 0.3F;
  Image image = exposure.image;
  const std::vector<float> hidden = occlusion(exposure.depth, radius);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const float light = std::max(least, 1 - strength * hidden[i]);
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      image.rgb[c] = static_cast<std::uint8_t>(light * static_cast<float>(image.rgb[c]) + 0.5F);
  }
  return image;
}

/// Lets `over` shine through where it covers anything.
void shine_through(Image& image, const Exposure& over, float strength) {
  for (std::size_t i = 0; i < over.coverage.size(); ++i)
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const float part = strength * over.coverage[i];
      image.rgb[c] =
          static_cast<std::uint8_t>(part * static_cast<float>(over.image.rgb[c]) +
                                    (1 - part) * static_cast<float>(image.rgb[c]) + 0.5F);
    }
}

}  // namespace

Painter::Painter(const Triangles& rest, ColourScale scale)
    : skin_(make_shading(rest)), scale_(std::move(scale)) {}

Image Painter::draw(const Shot& shot, const PictureOptions& options) {
  check(shot, skin_, options);
  const double pixel =
      metres_per_pixel(options.camera.frame, std::max(1, options.width - 2 * options.margin),
                       std::max(1, options.height - 2 * options.margin));
  stage_.aim(options.camera, options.width, options.height, pixel, options.finish);
  const double grain = shot.radius > 0 ? shot.radius : 8 * pixel;
  const double line = options.finish == Finish::fine ? 2.4 : 1.4;   // in drawn pixels
  const Colour bones = options.view == View::both ? ivory : slate;  // each stands out
  vtkRenderer& renderer = stage_.renderer();

  if (options.view == View::surface) {
    add_skin(renderer, shot, skin_);
    add_net(renderer, shot, skin_, {line, 0.6 * pixel, pixel});
    add_creases(renderer, shot, skin_, {line, 0.6 * pixel, pixel});
  } else {
    add_particles(renderer, shot, scale_);
  }
  if (options.view == View::both)
    add_creases(renderer, shot, skin_, {line, 0.35 * shot.radius, pixel});
  if (options.view != View::particles) add_bones(renderer, shot, 1.6 * grain, bones);
  Image image = with_shadows(stage_.shoot(), (options.view == View::surface ? 5 : 2) * grain);
  if (options.view == View::particles || shot.bones.empty()) return image;

  add_bones(renderer, shot, 1.6 * grain, bones);
  shine_through(image, stage_.shoot(), 0.6F);
  return image;
}

}  // namespace sinew
