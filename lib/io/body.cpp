// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/body.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/vtu.h"

namespace sinew {
namespace {

Error refused(const std::string& what) { return bad_input(what, "fill the body again"); }

/// The one positive value that all particles share.
double shared(const std::vector<Column>& columns, const char* name) {
  const std::vector<double>& values = numbers(columns, name);
  const double value = values.front();
  if (!(std::isfinite(value) && value > 0))
    throw refused(std::string("the ") + name + " of a particle is not positive");
  if (!std::all_of(values.begin(), values.end(), [&](double other) { return other == value; }))
    throw refused(std::string("particles differ in ") + name);
  return value;
}

void check(const Dataset& data) {
  if (data.points.empty()) throw refused("it holds no particles");
  if (data.kind != CellKind::vertex) throw refused("its cells are not particles");
  if (!std::all_of(data.points.begin(), data.points.end(),
                   [](const Vec3& p) { return p.allFinite(); }))
    throw refused("a coordinate is not finite");
  if (integers(data.point_columns, "id") != vertex_cells(data.points.size()))
    throw refused("its ids are not 0, 1, 2, ...");
}

void check_weights(const std::vector<double>& weights) {
  constexpr double rounding = 1e-9;
  for (const double weight : weights)
    if (!(weight >= 0 && weight <= 1 + rounding))
      throw refused("the weight " + std::to_string(weight) + " of a bone is not between 0 and 1");
}

BodyFile body_of(const Dataset& data) {
  check(data);
  BodyFile body;
  body.particles = particles_at(data.points, shared(data.point_columns, "radius"),
                                shared(data.point_columns, "mass"));
  body.neighbours = integers(data.point_columns, "neighbours");
  body.component = integers(data.point_columns, "component");
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
  data.point_columns.push_back(column("mass", std::vector<double>(count, mass)));
  data.point_columns.push_back(column("neighbours", std::move(body.neighbours)));
  data.point_columns.push_back(column("component", std::move(body.component)));
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
    throw error.within({path.string()});
  }
}

}  // namespace sinew
