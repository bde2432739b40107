// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/drawn_values.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/core/text.h>
#include <sinew/metrics/pair_forces.h>
#include <sinew/metrics/particle_values.h>

namespace sinew {
namespace {

struct MeasuredArray {
  std::string_view name, unit;
  std::vector<double> ParticleValues::*values;
  std::string_view on_surface;  ///< name of the same in files; empty: it has none
};

constexpr std::array<MeasuredArray, 6> measured_arrays = {{
    {"strain", "", &ParticleValues::strain, "strain_eq"},
    {"stretch", "", &ParticleValues::stretch, ""},
    {"J", "", &ParticleValues::J, "J"},
    {"D2min", "m^2", &ParticleValues::D2min, "D2min"},
    {"von_mises", "Pa", &ParticleValues::von_mises, "von_mises"},
    {"speed", "m/s", &ParticleValues::speed, ""},
}};

const MeasuredArray* find_measured(const std::string& name) {
  for (const MeasuredArray& array : measured_arrays)
    if (array.name == name) return &array;
  return nullptr;
}

/// The frames' own names are read once more where one is wrong.
std::vector<std::string> names_in(const RunFiles& run, const PvdRow& row) {
  std::vector<std::string> names;
  for (const Column& column : read_vtu(run.folder.path / row.file).point_columns)
    names.push_back(column.name);
  return names;
}

Error unknown(const RunFiles& run, const std::string& name) {
  std::vector<std::string> names;
  for (const MeasuredArray& array : measured_arrays) names.emplace_back(array.name);
  for (const auto* rows : {&run.particle_rows, &run.surface_rows})
    if (!rows->empty())
      for (const std::string& found : names_in(run, rows->front()))
        if (std::find(names.begin(), names.end(), found) == names.end()) names.push_back(found);
  const std::vector<std::string_view> known(names.begin(), names.end());
  return bad_input(Place{run.folder.path.string()}, "has no array " + shown(name) + " to show",
                   suggestion(name, known));
}

/// Dataset of a file of a series with this one array.
Dataset columns_of(const RunFiles& run, const PvdRow& row, const std::string& name,
                   std::size_t points) {
  const auto file = run.folder.path / row.file;
  Dataset data = read_vtu(file, {name.c_str()});
  if (!find(data.point_columns, name)) {
    const std::vector<std::string> there = names_in(run, row);
    const std::vector<std::string_view> names(there.begin(), there.end());
    throw bad_input(Place{file.string()}, "has no array " + shown(name), suggestion(name, names));
  }
  if (data.points.size() != points)
    throw bad_input(Place{file.string()}, "has another number of points than the run",
                    "run the scene again with --force");
  return data;
}

Column column_of(const RunFiles& run, const PvdRow& row, const std::string& name,
                 std::size_t points) {
  return *find(columns_of(run, row, name, points).point_columns, name);
}

/// The size of each row: for one component the number itself.
std::vector<double> sizes_of(const Column& column) {
  const auto sizes = [&](const auto& values) {
    const auto width = static_cast<std::size_t>(column.components);
    std::vector<double> found;
    found.reserve(values.size() / width);
    for (std::size_t i = 0; i < values.size(); i += width) {
      double sum = 0;
      for (std::size_t c = 0; c < width; ++c) {
        const auto part = static_cast<double>(values[i + c]);
        sum += part * part;
      }
      found.push_back(width == 1 ? static_cast<double>(values[i]) : std::sqrt(sum));
    }
    return found;
  };
  return std::visit(sizes, column.values);
}

/// Throws bad input where the run's forces, and so its stresses, do not follow from positions.
void check_forces(const RestBody& rest, const std::string& name) {
  if (!knows_forces(rest, {}))
    throw bad_input("the forces of this run do not follow from its positions alone",
                    "run the scene with output.arrays " + name);
}

bool is_measured(std::string_view name) {
  const auto names = sinew::measured_arrays();
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool has_array(const RunFiles& run, const PvdRow& row, const std::string& name) {
  if (name.empty()) return false;
  return find(read_vtu(run.folder.path / row.file, {name.c_str()}).point_columns, name) != nullptr;
}

DrawnValues::DrawnValues(const RunFiles& run, const std::string& name) : run_(&run), name_(name) {
  if (const MeasuredArray* array = find_measured(name)) {
    unit_ = array->unit;
    rest_ = std::make_shared<RestBody>(rest_body(measured_body(run)));
    if (name == "von_mises" && read_frame(run, 0).von_mises.empty()) check_forces(*rest_, name);
    return;
  }
  const WrittenArray* array = find_written("surface", ArrayPlace::point, name);
  if (!array || name == "Points") throw unknown(run, name);
  if (array->unit != "1") unit_ = array->unit;
  of_particles_ = name == "displacement" || has_array(run, run.particle_rows.front(), name);
  if (of_particles_ || !is_measured(name)) return;
  of_particles_ = true;
  rest_ = std::make_shared<RestBody>(rest_body(measured_body(run)));
  if (array->unit == "Pa") check_forces(*rest_, name);
}

Column DrawnValues::column(std::size_t index, const FrameState& frame) const {
  if (rest_) {
    if (const MeasuredArray* array = find_measured(name_))
      return {name_, 1, particle_values(*rest_, frame).*array->values};
    const std::string_view name = name_;
    return particle_arrays(*rest_, frame, {&name, 1}).front();
  }
  if (name_ == "displacement") return {name_, 1, displacements(*run_, frame)};
  return column_of(*run_, run_->particle_rows[index], name_, run_->body.particles.size());
}

std::vector<double> DrawnValues::at(std::size_t index, const FrameState& frame) const {
  return sizes_of(column(index, frame));
}

DrawnSkin::DrawnSkin(const RunFiles& run, const DrawnValues& values) : run_(&run), values_(values) {
  const MeasuredArray* measured = find_measured(values.name());
  const std::string name(measured ? std::string(measured->on_surface) : values.name());
  if (has_array(run, run.surface_rows.front(), name)) {
    written_ = name;
    return;
  }
  const BodyFile body = run.ids.empty() ? run.body : read_body(run.folder.body());
  Binding binding{{0}, {}, {}};
  for (const std::int32_t bone : body.bone.value()) {
    if (bone != no_bone) binding.influences.push_back({bone, 1, 0});
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  skin_ = make_skin(run.surface.points, positions_of(body.particles), body.particles.radius,
                    run.skeleton, binding);
  place_.assign(body.particles.size(), -1);
  if (run.ids.empty()) std::iota(place_.begin(), place_.end(), 0);
  std::int32_t place = 0;
  for (const std::int32_t id : run.ids) place_[static_cast<std::size_t>(id)] = place++;
}

/// Particles that are not written have no value.
Column DrawnSkin::carried(const Column& of_particles) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto width = static_cast<std::size_t>(of_particles.components);
  if (const auto* reals = std::get_if<std::vector<double>>(&of_particles.values)) {
    std::vector<double> of_body;
    for (const std::int32_t place : place_)
      for (std::size_t c = 0; c < width; ++c)
        of_body.push_back(place < 0 ? none : (*reals)[width * static_cast<std::size_t>(place) + c]);
    return at_vertices(skin_, {of_particles.name, of_particles.components, std::move(of_body)});
  }
  const auto& whole = std::get<std::vector<std::int32_t>>(of_particles.values);
  const Column at = at_vertices(skin_, sinew::column("place", place_));
  std::vector<double> found;
  for (const std::int32_t place : std::get<std::vector<std::int32_t>>(at.values))
    for (std::size_t c = 0; c < width; ++c)
      found.push_back(place < 0 ? none : whole[width * static_cast<std::size_t>(place) + c]);
  return {of_particles.name, of_particles.components, std::move(found)};
}

std::vector<double> DrawnSkin::at(std::size_t index, const FrameState& frame) const {
  if (written_.empty()) return sizes_of(carried(values_.column(index, frame)));
  return sizes_of(
      column_of(*run_, run_->surface_rows[index], written_, run_->surface.points.size()));
}

Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name) {
  const Dataset data = columns_of(run, run.particle_rows[index], name, run.body.particles.size());
  return vectors(data.point_columns, name);
}

}  // namespace sinew
