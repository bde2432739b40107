// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/frames.h>

#include <algorithm>
#include <cassert>
#include <functional>

#include <sinew/core/parallel.h>

namespace sinew {
namespace {

/// Length of an axis relative to its bone: visible beside it, short enough not to overlap others.
constexpr double stub = 0.25;
constexpr std::size_t particles_per_piece = 4096;

Dataset dataset_at(Moment moment) {
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  return data;
}

/// value(i) of the particles in their order, rearranged into the written order.
template <class Value>
Column written_column(const char* name, const Particles& particles, const Value& value) {
  assert(particles.id.size() == particles.size());
  std::vector<double> written(3 * particles.size());
  parallel_for(particles.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 vector = value(i);
      std::copy_n(vector.data(), 3, &written[3 * static_cast<std::size_t>(particles.id[i])]);
    }
  });
  return {name, 3, std::move(written)};
}

Points written_positions(const Particles& particles) {
  Points written(particles.size());
  parallel_for(particles.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) written[particles.id[i]] = particles.position(i);
  });
  return written;
}

std::vector<std::int32_t> in_written_order(std::span<const std::int32_t> values,
                                           const std::vector<std::int32_t>& id) {
  assert(values.size() == id.size());
  std::vector<std::int32_t> written(id.size());
  parallel_for(id.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) written[id[i]] = values[i];
  });
  return written;
}

Column displacement_column(const Points& now, const Points& rest) {
  assert(now.size() == rest.size());
  std::vector<double> displacements(3 * now.size());
  parallel_for(now.size(), particles_per_piece, [&](std::size_t begin, std::size_t end) {
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

std::vector<double> copied(std::span<const double> values, std::size_t count) {
  assert(values.size() == count);
  (void)count;
  return {values.begin(), values.end()};
}

Points copied(std::span<const Vec3> values, std::size_t count) {
  assert(values.size() == count);
  (void)count;
  return {values.begin(), values.end()};
}

std::vector<Column> columns_of(const Energies& energies) {
  const auto single = [](const char* name, double value) {
    return column(name, std::vector<double>{value});
  };
  return {single("kinetic_energy", energies.kinetic),
          single("pair_energy", energies.pair),
          single("bone_energy", energies.bone),
          single("gravity_energy", energies.gravity),
          single("work_of_bones", energies.work_of_bones),
          single("dissipation", energies.dissipation),
          single("contact_energy", energies.contact),
          single("work_of_world", energies.work_of_world)};
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

/// The columns in parallel, because the first touch of their memory takes longest.
std::vector<Column> made(const std::vector<std::function<Column()>>& makes) {
  std::vector<Column> columns(makes.size());
  parallel_for(makes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) columns[k] = makes[k]();
  });
  return columns;
}

}  // namespace

Dataset particles_dataset(const ParticleFrame& frame, Moment moment) {
  const Particles& now = frame.now;
  const auto forces = [&](const char* name, std::span<const Vec3> values) {
    return written_column(name, now, [values](std::size_t i) { return values[i]; });
  };
  const auto force = [&](std::size_t i) -> Vec3 {
    const Vec3 own = frame.force_pair[i] + frame.force_damping[i] + frame.force_bone[i];
    return frame.force_world.empty() ? own : Vec3(own + frame.force_world[i]);
  };
  Dataset data = dataset_at(moment);
  data.points = written_positions(now);
  data.connectivity = vertex_cells(now.size());
  std::vector<std::function<Column()>> makes = {
      [&] { return column("id", vertex_cells(now.size())); },
      [&] { return column("bone", copied(frame.bone, now.size())); },
      [&] { return column("weight", copied(frame.weight, now.size())); },
      [&] { return column("radius", std::vector<double>(now.size(), now.radius)); },
      [&] { return displacement_column(data.points, frame.rest); },
      [&] { return written_column("velocity", now, [&](auto i) { return now.velocity(i); }); },
      [&] { return written_column("force", now, force); },
      [&] { return forces("force_pair", frame.force_pair); },
      [&] { return forces("force_damping", frame.force_damping); },
      [&] { return forces("force_bone", frame.force_bone); },
      [&] { return column("neighbors", in_written_order(frame.neighbors, now.id)); },
  };
  if (!frame.force_world.empty())
    makes.emplace_back([&] { return forces("force_world", frame.force_world); });
  if (!frame.broken_bonds.empty())
    makes.emplace_back(
        [&] { return column("broken_bonds", in_written_order(frame.broken_bonds, now.id)); });
  data.point_columns = made(makes);
  data.field_columns = columns_of(frame.energies);
  return data;
}

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
