// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/frames.h>

#include <algorithm>
#include <cassert>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

/// Length of an axis relative to its bone: visible beside it, short enough not to overlap others.
constexpr double stub = 0.25;
constexpr std::size_t points_per_piece = 4096;

Dataset dataset_at(Moment moment) {
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  return data;
}

Column displacement_column(const Points& now, const Points& rest) {
  assert(now.size() == rest.size());
  std::vector<double> displacements(3 * now.size());
  parallel_for(now.size(), points_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int axis = 0; axis < 3; ++axis)
        displacements[3 * i + axis] = now[i][axis] - rest[i][axis];
  });
  return {"displacement", 3, std::move(displacements)};
}

std::vector<std::int32_t> copied(std::span<const std::int32_t> values, std::size_t count) {
  assert(values.size() == count);
  (void)count;
  return {values.begin(), values.end()};
}

Points copied(std::span<const Vec3> values, std::size_t count) {
  assert(values.size() == count);
  (void)count;
  return {values.begin(), values.end()};
}

/// W X Y Z, with W >= 0: the unique one of a rotation's two quaternions.
Column orientation_column(const Pose& pose) {
  std::vector<double> values;
  for (const BonePose& bone : pose) {
    const Quat turn(bone.frame.rotation);
    const double sign = turn.w() < 0 ? -1 : 1;
    for (const double part : {turn.w(), turn.x(), turn.y(), turn.z()})
      values.push_back(sign * part);
  }
  return {"orientation", 4, std::move(values)};
}

template <class Of>
Column per_bone(std::string name, const Pose& pose, Of&& of) {
  Points values;
  for (const BonePose& bone : pose) values.push_back(of(bone));
  return column(std::move(name), values);
}

}  // namespace

Dataset surface_dataset(const Triangles& surface, const Points& rest,
                        std::span<const std::int32_t> bone, Moment moment) {
  Dataset data = dataset_at(moment);
  data.points = surface.points;
  data.kind = CellKind::triangle;
  data.connectivity.reserve(3 * surface.faces.size());
  for (const auto& face : surface.faces)
    data.connectivity.insert(data.connectivity.end(), face.begin(), face.end());
  data.point_columns = {displacement_column(surface.points, rest),
                        column("normal", point_normals(surface)),
                        column("bone", copied(bone, surface.points.size()))};
  return data;
}

Dataset obstacles_dataset(std::span<const ObstacleFrame> obstacles, Moment moment) {
  Triangles all;
  std::vector<std::int32_t> number;
  Points velocity, force, moment_of_force;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const ObstacleFrame& now = obstacles[k];
    const int first = static_cast<int>(all.points.size());
    for (const Vec3& point : now.surface.points) {
      const Vec3 offset = now.frame.rotation * point;
      all.points.push_back(now.frame.origin + offset);
      velocity.push_back(now.velocity + now.angular_velocity.cross(offset));
    }
    for (const auto& [a, b, c] : now.surface.faces)
      all.faces.push_back({first + a, first + b, first + c});
    number.resize(all.points.size(), static_cast<std::int32_t>(k));
    force.resize(all.points.size(), now.reaction_force);
    moment_of_force.resize(all.points.size(), now.reaction_moment);
  }
  Dataset data = dataset_at(moment);
  data.points = all.points;
  data.kind = CellKind::triangle;
  for (const auto& face : all.faces)
    data.connectivity.insert(data.connectivity.end(), face.begin(), face.end());
  data.point_columns = {column("obstacle", number), column("velocity", velocity),
                        column("normal", point_normals(all)), column("reaction_force", force),
                        column("reaction_moment", moment_of_force)};
  return data;
}

Dataset supports_dataset(std::span<const SupportFrame> supports, Moment moment) {
  std::vector<std::int32_t> load;
  std::vector<double> power;
  Points force, moment_of_force, displacement;
  Dataset data = dataset_at(moment);
  for (const SupportFrame& now : supports) {
    data.points.push_back(now.place);
    load.push_back(now.load ? 1 : 0);
    force.push_back(now.force);
    moment_of_force.push_back(now.moment);
    power.push_back(now.power);
    displacement.push_back(now.displacement);
  }
  data.connectivity = vertex_cells(supports.size());
  data.point_columns = {column("number", vertex_cells(supports.size())),
                        column("load", load),
                        column("force", force),
                        column("moment", moment_of_force),
                        column("power", power),
                        column("displacement", displacement)};
  return data;
}

Dataset bones_dataset(const Skeleton& skeleton, const Pose& pose, Moment moment) {
  assert(pose.size() == skeleton.size());
  Dataset data = dataset_at(moment);
  data.kind = CellKind::line;
  std::vector<std::int32_t> axis, bone, parent;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const RigidFrame& frame = pose[b].frame;
    const double length = pose[b].stretch * skeleton.bones[b].length;
    const auto head = static_cast<std::int32_t>(data.points.size());
    data.points.push_back(frame.origin);
    for (int line = 0; line < 4; ++line) {
      const Vec3 along = line == 0 ? Vec3(length * pose[b].axis())
                                   : Vec3(stub * length * frame.rotation.col(line - 1));
      data.points.push_back(frame.origin + along);
      data.connectivity.insert(data.connectivity.end(), {head, head + 1 + line});
      axis.push_back(line);
      bone.push_back(static_cast<std::int32_t>(b));
      parent.push_back(skeleton.bones[b].parent);
    }
  }
  data.cell_columns = {column("axis", axis), column("bone", bone), column("parent", parent)};
  return data;
}

Dataset frames_dataset(const Skeleton& skeleton, const Pose& pose, const Reactions& reactions,
                       Moment moment) {
  assert(pose.size() == skeleton.size());
  Dataset data = dataset_at(moment);
  data.connectivity = vertex_cells(pose.size());
  std::vector<std::int32_t> parent;
  std::vector<double> length, twist;
  for (std::size_t b = 0; b < pose.size(); ++b) {
    data.points.push_back(pose[b].frame.origin);
    parent.push_back(skeleton.bones[b].parent);
    length.push_back(pose[b].stretch * skeleton.bones[b].length);
    twist.push_back(degrees(pose[b].twist));
  }
  const auto axis = [](int k) {
    return [k](const BonePose& bone) -> Vec3 { return bone.frame.rotation.col(k); };
  };
  data.point_columns = {
      column("bone", vertex_cells(pose.size())),
      column("parent", parent),
      column("length", length),
      orientation_column(pose),
      per_bone("axis_x", pose, axis(0)),
      per_bone("axis_y", pose, axis(1)),
      per_bone("axis_z", pose, axis(2)),
      column("twist", twist),
      per_bone("velocity", pose, [](const BonePose& bone) { return bone.velocity; }),
      per_bone("angular_velocity", pose,
               [](const BonePose& bone) { return bone.angular_velocity; }),
      column("reaction_force", copied(reactions.force, pose.size())),
      column("reaction_moment", copied(reactions.moment, pose.size())),
  };
  return data;
}

}  // namespace sinew
