// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/stage.h>

#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <algorithm>
#include <limits>

#include <sinew/core/error.h>

namespace sinew {
namespace {

/// A light that moves with the viewer, who is at (0, 0, 1) and looks at the origin.
void add_light(vtkRenderer& renderer, const Vec3& from, double strength, const Vec3& color) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(from.x(), from.y(), from.z());
  light->SetFocalPoint(0, 0, 0);
  light->SetIntensity(strength);
  light->SetColor(color.x(), color.y(), color.z());
  renderer.AddLight(light);
}

/// Each light takes time where graphics are computed: movies have one for all three.
void light(vtkRenderer& renderer, Finish finish) {
  renderer.RemoveAllLights();
  renderer.AutomaticLightCreationOff();
  if (finish == Finish::quick) return add_light(renderer, {0.05, 0.35, 1.0}, 1.3, {1, 0.99, 0.98});
  add_light(renderer, {-0.35, 0.55, 1.0}, 0.84, {1.0, 0.99, 0.97});  // key
  add_light(renderer, {1.0, 0.25, 0.7}, 0.54, {0.95, 0.97, 1.0});    // fill, cool
  add_light(renderer, {-0.2, -0.6, 1.0}, 0.24, {1.0, 0.98, 0.95});   // from below
}

/// The box in the view's axes that fills the picture.
Box filled(const Box& frame, int width, int height, double scale) {
  const Vec3 center = frame.isEmpty() ? Vec3::Zero() : Vec3(frame.center());
  const double deep = frame.isEmpty() ? 1 : frame.sizes().z() / 2;
  const Vec3 half(scale * width / 2, scale * height / 2, 1.05 * deep + scale);
  return Box(center - half, center + half);
}

/// Part of a picture, pixels from its upper left corner.
struct Tile {
  int x, y, width, height;
};

constexpr int tile_border = 8;  // pixels: lines and filters reach from one tile into the next

Tile with_border(const Tile& tile, int width, int height) {
  const int left = std::max(0, tile.x - tile_border), top = std::max(0, tile.y - tile_border);
  return {left, top, std::min(width, tile.x + tile.width + tile_border) - left,
          std::min(height, tile.y + tile.height + tile_border) - top};
}

std::vector<Tile> tiles_of(int width, int height, int most) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += most)
    for (int x = 0; x < width; x += most)
      tiles.push_back({x, y, std::min(most, width - x), std::min(most, height - y)});
  return tiles;
}

/// A tile of the picture that `box` fills, in the view's axes.
Box part_of(const Box& box, const Tile& tile, double pixel) {
  const Vec3 low(box.min().x() + tile.x * pixel, box.max().y() - (tile.y + tile.height) * pixel,
                 box.min().z());
  const Vec3 size(tile.width * pixel, tile.height * pixel, box.sizes().z());
  return Box(low, low + size);
}

void aim_at(vtkCamera& out, const Mat3& view, const Box& box, double away) {
  const Vec3 size = box.sizes();
  const Vec3 focus = view.transpose() * box.center();
  const Vec3 eye = focus + away * view.row(2).transpose();
  out.ParallelProjectionOn();
  out.SetFocalPoint(focus.data());
  out.SetPosition(eye.data());
  out.SetViewUp(view(1, 0), view(1, 1), view(1, 2));
  out.SetParallelScale(size.y() / 2);
  out.SetClippingRange(away - size.z() / 2, away + size.z() / 2);
}

Exposure unexposed(int width, int height, double pixel) {
  const auto size = static_cast<std::size_t>(width) * height;
  Exposure exposure;
  exposure.image = Image(width, height);
  exposure.depth = {width, height, pixel, {}};
  exposure.depth.depth.assign(size, std::numeric_limits<float>::infinity());
  exposure.coverage.assign(size, 0);
  return exposure;
}

}  // namespace

struct Stage::Impl {
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  Shot shot;
  Box box;        // in the picture
  int times = 1;  // rendered this many times larger than the picture

  void expose(const Tile& tile, Exposure& exposure);
  Image pixels(const Tile& drawn) const;
  void measure(const Tile& drawn, const Tile& tile, Exposure& exposure) const;
};

/// Renders a tile into its part of the exposure.
void Stage::Impl::expose(const Tile& tile, Exposure& exposure) {
  const Tile drawn = with_border(tile, shot.width, shot.height);
  window->SetSize(times * drawn.width, times * drawn.height);
  aim_at(*renderer->GetActiveCamera(), shot.camera.view, part_of(box, drawn, shot.pixel),
         box.sizes().norm());
  window->Render();
  const Image image = pixels(drawn);
  for (int y = 0; y < tile.height; ++y)
    std::copy_n(image.at(tile.x - drawn.x, tile.y - drawn.y + y), 3 * tile.width,
                exposure.image.at(tile.x, tile.y + y));
  measure(drawn, tile, exposure);
}

Image Stage::Impl::pixels(const Tile& drawn) const {
  Image image(times * drawn.width, times * drawn.height);
  vtkNew<vtkUnsignedCharArray> rgb;
  window->GetPixelData(0, 0, image.width - 1, image.height - 1, 0, rgb);
  for (int y = 0; y < image.height; ++y)  // VTK counts rows from below
    std::copy_n(rgb->GetPointer(3 * static_cast<vtkIdType>(image.height - 1 - y) * image.width),
                3 * image.width, image.at(0, y));
  return times == 2 ? halved(image) : image;
}

/// Depth at every pixel of the tile, coverage averaged over the rendered pixels.
void Stage::Impl::measure(const Tile& drawn, const Tile& tile, Exposure& exposure) const {
  const int wide = times * drawn.width, high = times * drawn.height;
  const int left = times * (tile.x - drawn.x), top = times * (tile.y - drawn.y);
  vtkNew<vtkFloatArray> buffer;  // 0 (near) .. 1 (background)
  window->GetZbufferData(0, 0, wide - 1, high - 1, buffer);
  const float* z = buffer->GetPointer(0);
  const auto deep = static_cast<float>(box.sizes().z());
  const float weight = 1.0F / static_cast<float>(times * times);
  for (int y = 0; y < times * tile.height; ++y)
    for (int x = 0; x < times * tile.width; ++x) {
      const float part = z[static_cast<std::size_t>(high - 1 - top - y) * wide + left + x];
      if (part >= 1) continue;
      const auto pixel = static_cast<std::size_t>(tile.y + y / times) * shot.width + tile.x +
                         static_cast<std::size_t>(x / times);
      exposure.coverage[pixel] += weight;
      if (y % times == 0 && x % times == 0) exposure.depth.depth[pixel] = part * deep;
    }
}

Stage::Stage() : impl_(std::make_unique<Impl>()) {
  impl_->window->SetOffScreenRendering(1);
  impl_->window->SetMultiSamples(0);
  impl_->window->AddRenderer(impl_->renderer);
  if (!impl_->window->SupportsOpenGL())
    throw Error(Exit::not_written,
                "the display has no OpenGL 3.2; unset DISPLAY to draw without a screen");
}

Stage::~Stage() = default;

void Stage::aim(const Shot& shot) {
  impl_->shot = shot;
  impl_->times = shot.finish == Finish::fine ? 2 : 1;
  light(*impl_->renderer, shot.finish);
  const auto& [red, green, blue] = shot.background;
  impl_->renderer->SetBackground(red / 255.0, green / 255.0, blue / 255.0);
  impl_->box = filled(shot.camera.frame, shot.width, shot.height, shot.pixel);
}

vtkRenderer& Stage::renderer() { return *impl_->renderer; }

Exposure Stage::render() {
  const Shot& shot = impl_->shot;
  Exposure exposure = unexposed(shot.width, shot.height, shot.pixel);
  exposure.background = shot.background;
  for (const Tile& tile : tiles_of(shot.width, shot.height, shot.tile / impl_->times))
    impl_->expose(tile, exposure);
  impl_->renderer->RemoveAllViewProps();
  return exposure;
}

}  // namespace sinew
