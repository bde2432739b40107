// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/kept_free.h>

#include <algorithm>
#include <cstddef>

#include <sinew/body/body.h>
#include <sinew/core/cell_grid.h>
#include <sinew/core/particles.h>
#include <sinew/groups/detail/carried_cells.h>
#include <sinew/groups/static_groups.h>

namespace sinew {
namespace {

constexpr int moments_of_touch = 100;
constexpr double min_approach = 0.5;  // radii: what moves by less does not press

/// Cells at the surfaces of bodies, and which of them meet those of others.
class SurfaceCells {
 public:
  /// `bodies`: by particle, the number of what hangs together.
  SurfaceCells(const Body& body, const NeighborLists& near, const std::vector<std::int32_t>& bodies,
               const std::vector<Cell>& cells, const std::vector<double>& width)
      : body_(body), width_(width) {
    const auto is_outside = [&](std::uint32_t i) {
      return near.of(i).size() < max_neighbors_at_rest;
    };
    for (const Cell& cell : cells)
      if (std::any_of(cell.particles.begin(), cell.particles.end(), is_outside)) {
        cells_.push_back(cell);
        body_of_.push_back(bodies[cell.particles.front()]);
        rest_.push_back(cell.box.center());
        largest_ = std::max(largest_, cell.radius());
      }
    meets_.assign(cells_.size(), 0);
  }

  void look_at(const Pose& pose) {
    Points at(rest_.size());
    on_cells(cells_, [&](std::size_t n) {
      const auto b = static_cast<std::size_t>(cells_[n].bone);
      at[n] = pose[b].carried(rest_[n], body_.skeleton.bones[b]);
    });
    const CellGrid grid(at, 2 * (largest_ + body_.material.pair.r));
    on_cells(cells_, [&](std::size_t n) {
      if (meets_[n] == 0)
        grid.for_each_near(at[n], [&](std::size_t j) {
          if (do_meet(n, j, (at[n] - at[j]).norm())) meets_[n] = 1;
        });
    });
  }

  /// Marks the cells within a width of those that meet others; none: empty.
  std::vector<std::uint8_t> near(const std::vector<Cell>& cells) const {
    Points places;
    for (std::size_t n = 0; n < cells_.size(); ++n)
      if (meets_[n] != 0) places.push_back(rest_[n]);
    if (places.empty()) return {};
    const double widest = *std::max_element(width_.begin(), width_.end());
    const CellGrid grid(places, widest + 2 * largest_);
    std::vector<std::uint8_t> near(cells.size(), 0);
    on_cells(cells, [&](std::size_t n) {
      const double reach = width_[static_cast<std::size_t>(cells[n].bone)] + 2 * largest_;
      grid.for_each_near(cells[n].box.center(), [&](std::size_t j) {
        if ((cells[n].box.center() - places[j]).norm() < reach) near[n] = 1;
      });
    });
    return near;
  }

 private:
  bool do_meet(std::size_t n, std::size_t j, double distance) const {
    const double r = body_.material.pair.r;
    return body_of_[n] != body_of_[j] &&
           distance < cells_[n].radius() + cells_[j].radius() + 2 * r &&
           distance < (rest_[n] - rest_[j]).norm() - min_approach * r;
  }

  const Body& body_;
  const std::vector<double>& width_;
  std::vector<Cell> cells_;
  Points rest_;  ///< their centers
  std::vector<std::int32_t> body_of_;
  double largest_ = 0;
  std::vector<std::uint8_t> meets_;
};

}  // namespace

std::vector<std::uint8_t> touching_bodies(const Body& body, const Motion& motion, double end) {
  if (motion.tracks.empty() || body.skeleton.size() < 2) return {};
  const SharedNeighbors shared = neighbors_of(body);
  std::vector<std::int32_t> bodies(body.rest.size(), 0);
  separate(shared->nearest, 0, bodies);
  if (*std::max_element(bodies.begin(), bodies.end()) == 0) return {};
  const std::vector<double> width = widths_of(body);
  const std::vector<Cell> cells = cells_of(body, width);
  SurfaceCells surface(body, shared->nearest, bodies, cells, width);
  PoseCursor cursor(body.skeleton, motion);
  for (int n = 0; n <= moments_of_touch; ++n)
    surface.look_at(cursor.at(end * n / moments_of_touch));
  const std::vector<std::uint8_t> near = surface.near(cells);
  return near.empty() ? near : particles_of(cells, near, body.rest.size());
}

}  // namespace sinew
