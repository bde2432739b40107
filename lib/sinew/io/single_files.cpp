// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/single_files.h>

#include <algorithm>
#include <cmath>

#include <sinew/core/dataset.h>
#include <sinew/core/error.h>
#include <sinew/io/vtu.h>

namespace sinew {

Dataset blowup_dataset(const BlowupFrame& frame, Moment moment) {
  const Particles& before = frame.before;
  const std::size_t n = before.size();
  Points displacement(n), velocity(n);
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  data.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto id = static_cast<std::size_t>(before.id[i]);
    data.points[id] = before.position(i);
    displacement[id] = before.position(i) - frame.rest[id];
    velocity[id] = before.velocity(i);
  }
  std::vector<std::int32_t> offence;
  for (const Offence one : frame.offence) offence.push_back(static_cast<std::int32_t>(one));
  data.connectivity = vertex_cells(n);
  data.point_columns = {
      column("id", vertex_cells(n)),
      column("bone", std::vector<std::int32_t>(frame.bone.begin(), frame.bone.end())),
      column("radius", std::vector<double>(n, before.radius)),
      column("displacement", displacement),
      column("velocity", velocity),
      column("offender", std::move(offence)),
      column("moved", std::vector<double>(frame.moved.begin(), frame.moved.end()))};
  return data;
}

void write_blowup(const std::filesystem::path& path, const BlowupFrame& frame, Moment moment) {
  VtuFormat format;
  format.series = "blowup";
  format.radius = frame.before.radius;
  write_vtu(path, blowup_dataset(frame, moment), format);
}

Dataset defects_dataset(const DefectsFile& defects) {
  Dataset data;
  data.points = defects.surface.points;
  data.kind = CellKind::triangle;
  for (const auto& face : defects.surface.faces)
    data.connectivity.insert(data.connectivity.end(), face.begin(), face.end());
  for (const auto& edge : defects.edges)
    data.lines.insert(data.lines.end(), edge.begin(), edge.end());
  data.cell_columns = {column("defect", defects.defect), column("component", defects.component),
                       column("hole", defects.hole)};
  return data;
}

void write_defects(const std::filesystem::path& path, const DefectsFile& defects) {
  VtuFormat format;
  format.series = "defects";
  write_vtu(path, defects_dataset(defects), format);
}

namespace {

Error no_body_file(const std::string& what) { return bad_input(what, "fill the body again"); }

/// The one positive value that all particles have.
double shared(const std::vector<Column>& columns, const char* name) {
  const std::vector<double>& values = numbers(columns, name);
  const double value = values.front();
  if (!(is_computable(value) && value > 0))
    throw no_body_file(std::string("the ") + name + " of a particle is not positive");
  if (!std::all_of(values.begin(), values.end(), [&](double other) { return other == value; }))
    throw no_body_file(std::string("particles differ in ") + name);
  return value;
}

void check_values(const std::vector<double>& values, const std::string& name) {
  for (const double value : values)
    if (!(value >= 0) || !is_computable(value))
      throw no_body_file("the " + name + ' ' + std::to_string(value) + " of a particle is none");
}

void check(const Dataset& data) {
  if (data.points.empty()) throw no_body_file("it holds no particles");
  if (data.kind != CellKind::vertex) throw no_body_file("its cells are not particles");
  if (!std::all_of(data.points.begin(), data.points.end(),
                   [](const Vec3& p) { return is_computable(p); }))
    throw no_body_file("a coordinate is too large or not finite");
  if (integers(data.point_columns, "id") != vertex_cells(data.points.size()))
    throw no_body_file("its ids are not 0, 1, 2, ...");
}

void check_weights(const std::vector<double>& weights) {
  constexpr double rounding = 1e-9;
  for (const double weight : weights)
    if (!(weight >= 0 && weight <= 1 + rounding))
      throw no_body_file("the weight " + std::to_string(weight) +
                         " of a bone is not between 0 and 1");
}

BodyFile body_of(const Dataset& data) {
  check(data);
  BodyFile body;
  body.particles = particles_at(
      data.points, shared(data.point_columns, "radius"),
      shared(data.point_columns, find(data.point_columns, "density") ? "common_mass" : "mass"));
  body.neighbors = integers(data.point_columns, "neighbors");
  body.component = integers(data.point_columns, "component");
  if (find(data.point_columns, "share")) body.volume_share = numbers(data.point_columns, "share");
  if (body.volume_share) check_values(*body.volume_share, "share");
  if (find(data.point_columns, "stiffness"))
    body.stiffness = numbers(data.point_columns, "stiffness");
  if (body.stiffness) check_values(*body.stiffness, "stiffness");
  if (find(data.point_columns, "density")) body.density = numbers(data.point_columns, "density");
  if (body.density) check_values(*body.density, "density");
  if (find(data.point_columns, "volume_stiffness"))
    body.volume_stiffness = numbers(data.point_columns, "volume_stiffness");
  if (body.volume_stiffness) check_values(*body.volume_stiffness, "volume_stiffness");
  if (find(data.point_columns, "bone")) body.bone = integers(data.point_columns, "bone");
  if (find(data.point_columns, "weight")) body.weight = numbers(data.point_columns, "weight");
  if (body.weight) check_weights(*body.weight);
  body.meta = data.meta;
  return body;
}

}  // namespace

Dataset body_dataset(BodyFile body) {
  const std::size_t count = body.particles.size();
  const double radius = body.particles.radius, mass = body.particles.mass;
  Dataset data;
  data.points = positions_of(body.particles);
  Column id = column("id", std::move(body.particles.id));
  body.particles = {};
  data.connectivity = vertex_cells(count);
  data.point_columns.push_back(std::move(id));
  data.point_columns.push_back(column("radius", std::vector<double>(count, radius)));
  std::vector<double> masses(count, mass);
  for (std::size_t i = 0; i < count && body.density; ++i) masses[i] *= (*body.density)[i];
  data.point_columns.push_back(column("mass", std::move(masses)));
  data.point_columns.push_back(column("neighbors", std::move(body.neighbors)));
  data.point_columns.push_back(column("component", std::move(body.component)));
  if (body.volume_share)
    data.point_columns.push_back(column("share", std::move(*body.volume_share)));
  if (body.stiffness) data.point_columns.push_back(column("stiffness", std::move(*body.stiffness)));
  if (body.density) {
    data.point_columns.push_back(column("density", std::move(*body.density)));
    data.point_columns.push_back(column("common_mass", std::vector<double>(count, mass)));
  }
  if (body.volume_stiffness)
    data.point_columns.push_back(column("volume_stiffness", std::move(*body.volume_stiffness)));
  if (body.bone) data.point_columns.push_back(column("bone", std::move(*body.bone)));
  if (body.weight) data.point_columns.push_back(column("weight", std::move(*body.weight)));
  data.meta = std::move(body.meta);
  return data;
}

void write_body(const std::filesystem::path& path, BodyFile body, Encoding encoding) {
  VtuFormat format;
  format.encoding = encoding;
  format.series = "body";
  format.radius = body.particles.radius;
  write_vtu(path, body_dataset(std::move(body)), format);
}

BodyFile read_body(const std::filesystem::path& path) {
  const Dataset data = read_vtu(path);
  try {
    return body_of(data);
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

}  // namespace sinew
