// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/kept_free.h>

#include <algorithm>
#include <cstddef>
#include <variant>

#include <sinew/body/body.h>
#include <sinew/groups/detail/carried_cells.h>
#include <sinew/world/world.h>

namespace sinew {
namespace {

constexpr int moments_of_contact = 400;
constexpr double contact_widths = 2;     // free up to here from an obstacle
constexpr double min_body_width = 0.25;  // the body may be that far from where its bones carry it

/// The distance to a shape, m; far from a mesh, that to its bounds, which is less.
double distance_to(const Shape& shape, const Vec3& point, double limit) {
  const auto* mesh = std::get_if<MeshShape>(&shape);
  const double outside = mesh ? mesh->bounds.exteriorDistance(point) : 0;
  return outside > limit ? outside : signed_distance(shape, point).distance;
}

/// How near the bones carry points to obstacles.
class Approach {
 public:
  Approach(const Body& body, const Motion& motion, double end) : body_(body) {
    PoseCursor cursor(body.skeleton, motion);
    for (int n = 0; n <= moments_of_contact; ++n) {
      const double time = end * n / moments_of_contact;
      const Pose& pose = cursor.at(time);
      moments_.push_back({pose, {}});
      for (const Obstacle& obstacle : body.world->obstacles)
        moments_.back().frames.push_back(obstacle.at(time, pose).frame);
    }
  }

  /// Whether an obstacle comes nearer than `limit` (m) to what is at `rest` on a bone, at a moment
  /// or between two: along a path the distance changes by no more than the path is long, so that it
  /// is measured again only where it may have become less.
  bool is_within(double limit, std::size_t obstacle, int bone, const Vec3& rest) const {
    const Shape& shape = body_.world->obstacles[obstacle].shape;
    Vec3 before = local(moments_.front(), obstacle, bone, rest);
    double spare = distance_to(shape, before, limit) - limit;
    for (const Moment& now : moments_) {
      if (spare < 0) return true;
      const Vec3 at = local(now, obstacle, bone, rest);
      const double moved = (at - before).norm();
      spare -= moved;
      if (spare < 0) {
        const double distance = distance_to(shape, at, limit);
        if (distance_to(shape, before, limit) + distance - moved < 2 * limit) return true;
        spare = distance - limit;
      }
      before = at;
    }
    return false;
  }

 private:
  struct Moment {
    Pose pose;
    std::vector<RigidFrame> frames;  ///< frames of the obstacles
  };

  /// Returns where it is in the obstacle's coordinates.
  Vec3 local(const Moment& now, std::size_t obstacle, int bone, const Vec3& rest) const {
    const auto b = static_cast<std::size_t>(bone);
    const RigidFrame& frame = now.frames[obstacle];
    return frame.rotation.transpose() *
           (now.pose[b].carried(rest, body_.skeleton.bones[b]) - frame.origin);
  }

  const Body& body_;
  std::vector<Moment> moments_;
};

/// Returns how wide what an obstacle presses is at rest, m; 0: it presses nothing.
double contact_width(const Body& body, const Approach& approach, std::size_t obstacle,
                     const std::vector<Cell>& cells) {
  const double r = body.material.pair.r;
  std::vector<Box> pressed(cells.size());
  on_cells(cells, [&](std::size_t n) {
    const Cell& cell = cells[n];
    if (!approach.is_within(cell.radius() + r, obstacle, cell.bone, cell.box.center())) return;
    for (const std::uint32_t i : cell.particles)
      if (approach.is_within(r, obstacle, cell.bone, body.rest[i])) pressed[n].extend(body.rest[i]);
  });
  Box all;
  for (const Box& box : pressed) all.extend(box);
  return all.isEmpty() ? 0 : all.sizes().maxCoeff() + 2 * r;
}

}  // namespace

std::vector<std::uint8_t> near_obstacles(const Body& body, const Motion& motion, double end) {
  if (!body.world || body.world->obstacles.empty() || body.skeleton.size() == 0) return {};
  const double r = body.material.pair.r;
  const std::vector<double> width = widths_of(body);
  const std::vector<Cell> cells = cells_of(body, width);
  const Approach approach(body, motion, end);
  std::vector<std::uint8_t> near(cells.size(), 0);
  for (std::size_t k = 0; k < body.world->obstacles.size(); ++k) {
    const double deep = contact_widths * contact_width(body, approach, k, cells);
    on_cells(cells, [&](std::size_t n) {
      const Cell& cell = cells[n];
      const double across = width[static_cast<std::size_t>(cell.bone)];
      const double limit = std::clamp(deep, min_body_width * across, across) + cell.radius() + r;
      if (near[n] == 0 && approach.is_within(limit, k, cell.bone, cell.box.center())) near[n] = 1;
    });
  }
  return particles_of(cells, near, body.rest.size());
}

}  // namespace sinew
