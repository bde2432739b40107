// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/stage.h>

#include <vtkCamera.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkOpenGLFXAAPass.h>
#include <vtkRenderStepsPass.h>
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

void add_lights(vtkRenderer& renderer) {
  renderer.AutomaticLightCreationOff();
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

void aim_at(vtkCamera& out, const Mat3& view, const Box& box) {
  const Vec3 size = box.sizes();
  const double away = size.norm();
  const Vec3 focus = view.transpose() * box.center();
  const Vec3 eye = focus + away * view.row(2).transpose();
  out.ParallelProjectionOn();
  out.SetFocalPoint(focus.data());
  out.SetPosition(eye.data());
  out.SetViewUp(view(1, 0), view(1, 1), view(1, 2));
  out.SetParallelScale(size.y() / 2);
  out.SetClippingRange(away - size.z() / 2, away + size.z() / 2);
}

}  // namespace

struct Stage::Parts {
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderStepsPass> steps;
  vtkNew<vtkOpenGLFXAAPass> smoothing;
  Box box;        // in the picture
  int times = 1;  // rendered this many times larger than the picture

  int width() const { return window->GetSize()[0]; }
  int height() const { return window->GetSize()[1]; }
  Image pixels() const;
  void measure(Exposure& exposure) const;
};

Image Stage::Parts::pixels() const {
  Image image(width(), height());
  vtkNew<vtkUnsignedCharArray> rgb;
  window->GetPixelData(0, 0, image.width - 1, image.height - 1, 0, rgb);
  for (int y = 0; y < image.height; ++y)  // VTK counts rows from below
    std::copy_n(rgb->GetPointer(3 * static_cast<vtkIdType>(image.height - 1 - y) * image.width),
                3 * image.width, image.at(0, y));
  return image;
}

/// Depth at every pixel of the picture, coverage averaged over the rendered pixels.
void Stage::Parts::measure(Exposure& exposure) const {
  const int wide = width(), high = height(), columns = wide / times, rows = high / times;
  vtkNew<vtkFloatArray> buffer;  // 0 (near) .. 1 (background)
  window->GetZbufferData(0, 0, wide - 1, high - 1, buffer);
  const float* z = buffer->GetPointer(0);
  const auto deep = static_cast<float>(box.sizes().z());
  const float share = 1.0F / static_cast<float>(times * times);
  const auto size = static_cast<std::size_t>(columns) * rows;
  exposure.depth = {columns, rows, box.sizes().y() / rows, {}};
  exposure.depth.depth.assign(size, std::numeric_limits<float>::infinity());
  exposure.coverage.assign(size, 0);
  for (int y = 0; y < rows * times; ++y)
    for (int x = 0; x < columns * times; ++x) {
      const float part = z[static_cast<std::size_t>(high - 1 - y) * wide + x];
      if (part >= 1) continue;
      const auto pixel = static_cast<std::size_t>(y / times) * columns + x / times;
      exposure.coverage[pixel] += share;
      if (y % times == 0 && x % times == 0) exposure.depth.depth[pixel] = part * deep;
    }
}

Stage::Stage() : parts_(std::make_unique<Parts>()) {
  parts_->window->SetOffScreenRendering(1);
  parts_->window->SetMultiSamples(0);
  parts_->window->AddRenderer(parts_->renderer);
  if (!parts_->window->SupportsOpenGL())
    throw Error(Exit::not_written,
                "the display has no OpenGL 3.2; unset DISPLAY to draw without a screen");
  parts_->renderer->SetBackground(1, 1, 1);
  parts_->smoothing->SetDelegatePass(parts_->steps);
  add_lights(*parts_->renderer);
}

Stage::~Stage() = default;

void Stage::aim(const Camera& camera, int width, int height, double pixel, Finish finish) {
  parts_->times = finish == Finish::fine ? 2 : 1;
  parts_->window->SetSize(parts_->times * width, parts_->times * height);
  parts_->renderer->SetPass(finish == Finish::quick ? parts_->smoothing.Get() : nullptr);
  parts_->box = filled(camera.frame, width, height, pixel);
  aim_at(*parts_->renderer->GetActiveCamera(), camera.view, parts_->box);
}

vtkRenderer& Stage::renderer() { return *parts_->renderer; }

Exposure Stage::render() {
  parts_->window->Render();
  Exposure exposure;
  exposure.image = parts_->times == 2 ? halved(parts_->pixels()) : parts_->pixels();
  parts_->measure(exposure);
  parts_->renderer->RemoveAllViewProps();
  return exposure;
}

}  // namespace sinew
