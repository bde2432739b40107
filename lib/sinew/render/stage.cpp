// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/stage.h>

#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <algorithm>
#include <array>
#include <cmath>
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
  add_light(renderer, {-0.2, -0.6, 1.0}, 0.24, {1.0, 0.98, 0.95});   // light from below
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

Tile common(const Tile& a, const Tile& b) {
  const int left = std::max(a.x, b.x), top = std::max(a.y, b.y);
  return {left, top, std::min(a.x + a.width, b.x + b.width) - left,
          std::min(a.y + a.height, b.y + b.height) - top};
}

Exposure unexposed(const Shot& shot, Readback readback) {
  Exposure exposure;
  exposure.image = Image(shot.width, shot.height, shot.background);
  exposure.background = shot.background;
  if (readback == Readback::colors) return exposure;
  const auto size = static_cast<std::size_t>(shot.width) * shot.height;
  exposure.depth = {shot.width, shot.height, shot.pixel, {}};
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

  Tile covered() const;
  void expose(const Tile& tile, const Tile& used, Readback readback, Exposure& exposure);
  Image pixels(const Tile& drawn, const Tile& used) const;
  void measure(const Tile& drawn, const Tile& used, Exposure& exposure) const;
};

/// What the actors may cover of the picture.
Tile Stage::Impl::covered() const {
  constexpr int line = 6;  // pixels: half of the widest one, and of what is smoothed
  std::array<double, 6> sides;
  renderer->ComputeVisiblePropBounds(sides.data());
  if (!vtkMath::AreBoundsInitialized(sides.data())) return {0, 0, 0, 0};
  const Box bounds(Vec3(sides[0], sides[2], sides[4]), Vec3(sides[1], sides[3], sides[5]));
  Box in_view;
  for (int corner = 0; corner < 8; ++corner)
    in_view.extend(shot.camera.view * bounds.corner(static_cast<Box::CornerType>(corner)));
  const double around = shot.reach + line * shot.pixel;
  const auto place = [&](double meters, int most) {
    return static_cast<int>(std::clamp(std::floor(meters / shot.pixel), 0.0, double(most)));
  };
  const int left = place(in_view.min().x() - around - box.min().x(), shot.width),
            right = place(in_view.max().x() + around - box.min().x(), shot.width),
            top = place(box.max().y() - in_view.max().y() - around, shot.height),
            bottom = place(box.max().y() - in_view.min().y() + around, shot.height);
  return {left, top, right - left, bottom - top};
}

/// Renders a tile into its part of the exposure, of which `used` is covered.
void Stage::Impl::expose(const Tile& tile, const Tile& used, Readback readback,
                         Exposure& exposure) {
  const Tile drawn = with_border(tile, shot.width, shot.height);
  window->SetSize(times * drawn.width, times * drawn.height);
  aim_at(*renderer->GetActiveCamera(), shot.camera.view, part_of(box, drawn, shot.pixel),
         box.sizes().norm());
  window->Render();
  const Image image = pixels(drawn, used);
  for (int y = 0; y < used.height; ++y)
    std::copy_n(image.at(0, y), 3 * used.width, exposure.image.at(used.x, used.y + y));
  if (readback == Readback::all) measure(drawn, used, exposure);
}

Image Stage::Impl::pixels(const Tile& drawn, const Tile& used) const {
  Image image(times * used.width, times * used.height);
  const int left = times * (used.x - drawn.x),
            low = times * (drawn.y + drawn.height - used.y - used.height);
  vtkNew<vtkUnsignedCharArray> rgba;  // layout of the frame: repacking to three bytes is slow
  window->GetRGBACharPixelData(left, low, left + image.width - 1, low + image.height - 1, 0, rgba);
  for (int y = 0; y < image.height; ++y) {  // VTK counts rows from below
    const std::uint8_t* from =
        rgba->GetPointer(4 * static_cast<vtkIdType>(image.height - 1 - y) * image.width);
    std::uint8_t* to = image.at(0, y);
    for (int x = 0; x < image.width; ++x, from += 4, to += 3) std::copy_n(from, 3, to);
  }
  return times == 2 ? halved(image) : image;
}

/// Depth at every pixel, coverage averaged over the rendered pixels.
void Stage::Impl::measure(const Tile& drawn, const Tile& used, Exposure& exposure) const {
  const int wide = times * used.width, high = times * used.height;
  const int left = times * (used.x - drawn.x),
            low = times * (drawn.y + drawn.height - used.y - used.height);
  vtkNew<vtkFloatArray> buffer;  // 0 (near) .. 1 (background)
  window->GetZbufferData(left, low, left + wide - 1, low + high - 1, buffer);
  const float* z = buffer->GetPointer(0);
  const auto deep = static_cast<float>(box.sizes().z());
  const float weight = 1.0F / static_cast<float>(times * times);
  for (int y = 0; y < high; ++y)
    for (int x = 0; x < wide; ++x) {
      const float part = z[static_cast<std::size_t>(high - 1 - y) * wide + x];
      if (part >= 1) continue;
      const auto pixel = static_cast<std::size_t>(used.y + y / times) * shot.width + used.x +
                         static_cast<std::size_t>(x / times);
      exposure.coverage[pixel] += weight;
      if (y % times == 0 && x % times == 0) exposure.depth.depth[pixel] = part * deep;
    }
}

Stage::Stage() : impl_(std::make_unique<Impl>()) {
  impl_->window->SetOffScreenRendering(1);
  impl_->window->SetMultiSamples(0);
  impl_->window->SwapBuffersOff();  // the picture is read from the frame that was drawn
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

const Mat3& Stage::view() const { return impl_->shot.camera.view; }

Vec3 Stage::place_at(int x, int y, double depth) const {
  const Box& box = impl_->box;
  const double pixel = impl_->shot.pixel;
  return view().transpose() * Vec3(box.min().x() + (x + 0.5) * pixel,
                                   box.max().y() - (y + 0.5) * pixel, box.max().z() - depth);
}

vtkRenderer& Stage::renderer() { return *impl_->renderer; }

Exposure Stage::render(Readback readback) {
  const Shot& shot = impl_->shot;
  Exposure exposure = unexposed(shot, readback);
  const Tile covered = impl_->covered();
  for (const Tile& tile : tiles_of(shot.width, shot.height, shot.tile / impl_->times)) {
    const Tile used = common(tile, covered);
    if (used.width > 0 && used.height > 0) impl_->expose(tile, used, readback, exposure);
  }
  impl_->renderer->RemoveAllViewProps();
  return exposure;
}

}  // namespace sinew
