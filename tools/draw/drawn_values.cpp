// SPDX-License-Identifier: GPL-3.0-or-later
#include "draw/drawn_values.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/dataset.h"
#include "core/error.h"
#include "core/words.h"
#include "folder/measured_body.h"
#include "io/arrays.h"
#include "metrics/particle_values.h"

namespace sinew {
namespace {

struct MeasuredArray {
  std::string_view name, unit;
  std::vector<double> ParticleValues::*values;
};

constexpr std::array<MeasuredArray, 6> measured_arrays = {{
    {"strain", "", &ParticleValues::strain},
    {"stretch", "", &ParticleValues::stretch},
    {"J", "", &ParticleValues::J},
    {"D2min", "m^2", &ParticleValues::D2min},
    {"von_mises", "Pa", &ParticleValues::von_mises},
    {"speed", "m/s", &ParticleValues::speed},
}};

const MeasuredArray* find_measured(const std::string& name) {
  for (const MeasuredArray& array : measured_arrays)
    if (array.name == name) return &array;
  return nullptr;
}

Error unknown(const std::string& name) {
  std::vector<std::string_view> names;
  for (const MeasuredArray& array : measured_arrays) names.push_back(array.name);
  for (const WrittenArray& array : written_arrays())
    if (array.series == "particles" && array.place == ArrayPlace::point && array.name != "Points")
      names.push_back(array.name);
  return bad_input("particles have no array " + shown(name), suggestion(name, names));
}

Dataset columns_of(const RunFiles& run, std::size_t index, const std::string& name) {
  const auto file = run.folder.path / run.particle_rows[index].file;
  Dataset data = read_vtu(file, {name.c_str()});
  if (!find(data.point_columns, name))
    throw bad_input(Place{file.string()}, "has no array " + shown(name),
                    "choose another one; sinew info FILE lists them");
  if (data.points.size() != run.body.particles.size())
    throw bad_input(Place{file.string()}, "has another number of particles than the run",
                    "run the scene again with --force");
  return data;
}

}  // namespace

DrawnValues::DrawnValues(const RunFiles& run, const std::string& name) : run_(&run), name_(name) {
  if (const MeasuredArray* array = find_measured(name)) {
    unit_ = array->unit;
    rest_ = std::make_shared<RestBody>(rest_body(measured_body(run)));
    if (name == "von_mises" && !rest_->law.force)
      throw bad_input("von_mises cannot be measured in a run with this material", "show strain");
    return;
  }
  const WrittenArray* array = find_written("particles", ArrayPlace::point, name);
  if (!array || name == "Points") throw unknown(name);
  if (array->unit != "1") unit_ = array->unit;
  components_ = std::max<int>(1, static_cast<int>(array->components.size()));
}

std::vector<double> DrawnValues::measured(const RunFrame& frame) const {
  const FrameState state = measured_frame(frame);
  return particle_values(*rest_, state).*find_measured(name_)->values;
}

std::vector<double> DrawnValues::at(std::size_t index, const RunFrame& frame) const {
  if (rest_) return measured(frame);
  if (name_ == "displacement") return frame.displacement;
  if (components_ == 1) {
    const Dataset data = columns_of(*run_, index, name_);
    const Column& column = *find(data.point_columns, name_);
    if (const auto* whole = std::get_if<std::vector<std::int32_t>>(&column.values))
      return {whole->begin(), whole->end()};
    return numbers(data.point_columns, name_);
  }
  std::vector<double> sizes;
  for (const Vec3& vector : drawn_vectors(*run_, index, name_)) sizes.push_back(vector.norm());
  return sizes;
}

DrawnValues::Range DrawnValues::range_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return value != value; });
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t stray = values.size() / 100;
  const double low = values[stray], high = values[values.size() - 1 - stray];
  return {values.front() >= 0 && low < high / 2 ? 0 : low, high};
}

Points drawn_vectors(const RunFiles& run, std::size_t index, const std::string& name) {
  return vectors(columns_of(run, index, name).point_columns, name);
}

}  // namespace sinew
