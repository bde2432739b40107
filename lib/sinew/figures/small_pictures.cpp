// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/small_pictures.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include <sinew/core/parallel.h>
#include <sinew/core/threads.h>
#include <sinew/figures/snapshots.h>
#include <sinew/render/image.h>
#include <sinew/render/picture.h>

namespace sinew {
namespace {

DrawnRunOptions particles_of_one_moment() {
  DrawnRunOptions what;
  what.presets = {view_preset_named("particles")};
  what.ahead = false;
  return what;
}

/// Visits runs in their order. Few are open at a time: many bodies do not fit into memory.
void visit(const std::vector<std::filesystem::path>& runs,
           const std::function<void(std::size_t, const DrawnRun&)>& job) {
  const std::size_t at_once = static_cast<std::size_t>(std::clamp(threads_allowed(), 1, 8));
  for (std::size_t first = 0; first < runs.size(); first += at_once) {
    std::vector<std::unique_ptr<DrawnRun>> open(std::min(at_once, runs.size() - first));
    parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        open[k] = std::make_unique<DrawnRun>(runs[first + k].string(), particles_of_one_moment());
    });
    for (std::size_t k = 0; k < open.size(); ++k) job(first + k, *open[k]);
  }
}

/// Whether two surfaces at rest are one but for the rounding of a last moment, less displacements.
bool are_alike(const Triangles& a, const Triangles& b) {
  constexpr double rounding = 1e-5;  // fraction of the size
  if (a.faces != b.faces || a.points.size() != b.points.size()) return false;
  const double near = rounding * bounds(a.points).diagonal().norm();
  for (std::size_t k = 0; k < a.points.size(); ++k)
    if (!((a.points[k] - b.points[k]).norm() <= near)) return false;
  return true;
}

}  // namespace

void write_small_pictures(const std::vector<std::filesystem::path>& runs, int width, int height) {
  PictureOptions picture;
  picture.view = View::particles;
  picture.width = width, picture.height = height, picture.margin = 4;
  double high = 0;
  visit(runs, [&](std::size_t, const DrawnRun& run) {
    picture.camera.view = run.view();
    picture.camera.frame.extend(run.overview().frame);
    high = std::max(high, run.view_presets().front().range.high);
  });
  std::optional<Painter> painter;
  Triangles painted;
  visit(runs, [&](std::size_t k, const DrawnRun& run) {
    const DrawnView& drawn = run.view_presets().front();
    const Triangles& surface = run.files().surface;
    if (!painter || !are_alike(surface, painted)) {
      painted = surface;
      painter.emplace(surface, ColorScale{drawn.name(), drawn.unit(), 0, high > 0 ? high : 1,
                                          ColorMap::indigo});
    }
    write_png(painter->draw(run.snapshot(run.files().frames() - 1, drawn), picture),
              (runs[k] / "picture.png").string());
  });
}

}  // namespace sinew
