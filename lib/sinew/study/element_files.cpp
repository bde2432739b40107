// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/io/frame_table.h>
#include <sinew/study/compare_elements.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

/// Vectors of each frame, under "clamp: force by elements" and the like.
struct NamedVectors {
  std::string owner, quantity, end;
  const Points& values;
};

std::vector<NamedVectors> vectors_of(const ElementComparison& compared) {
  std::vector<NamedVectors> all;
  const auto add = [&](const std::string& owner, const std::string& quantity,
                       const Points& elements, const Points& run) {
    all.push_back({owner, quantity, " by elements", elements});
    all.push_back({owner, quantity, "", run});
  };
  for (const ComparedProbe& probe : compared.probes)
    add(probe.name, "displacement", probe.elements, probe.run);
  for (const ComparedSupport& support : compared.supports)
    add(support.name, "force", support.elements_force, support.run_force);
  return all;
}

Json json_of(const ElementComparison& compared, std::size_t k) {
  Json row;
  for (const ElementColumn& column : element_columns()) {
    const double value = compared.frames[k].*column.value;
    row[std::string(column.name)] = std::isfinite(value) ? Json(value) : Json();
  }
  for (const NamedVectors& one : vectors_of(compared)) {
    const Vec3& value = one.values[k];
    row[one.owner + ": " + one.quantity + one.end] = {value.x(), value.y(), value.z()};
  }
  return row;
}

}  // namespace

std::string reference_csv(const ElementComparison& compared) {
  std::string text;
  for (const ElementColumn& column : element_columns())
    (text += text.empty() ? "" : ",") += column.name;
  const std::vector<NamedVectors> vectors = vectors_of(compared);
  for (const NamedVectors& one : vectors)
    for (const char axis : {'x', 'y', 'z'})
      text += ',' + csv_cell(one.owner + ": " + one.quantity + '_' + axis + one.end);
  text += '\n';
  for (std::size_t k = 0; k < compared.frames.size(); ++k) {
    std::string line;
    const auto add = [&](double value) {
      (line += line.empty() ? "" : ",") += std::isnan(value) ? "nan" : number_text(value);
    };
    for (const ElementColumn& column : element_columns()) add(compared.frames[k].*column.value);
    for (const NamedVectors& one : vectors)
      for (int axis = 0; axis < 3; ++axis) add(one.values[k][axis]);
    text += line + '\n';
  }
  return text;
}

std::string reference_json(const ElementComparison& compared) {
  Json file{{"schema_version", 1},
            {"result", compared.name},
            {"run", compared.metrics.second.name},
            {"elements", compared.elements},
            {"nodes", compared.nodes},
            {"particles", compared.particles},
            {"frames", Json::array()}};
  for (std::size_t k = 0; k < compared.frames.size(); ++k)
    file["frames"].push_back(json_of(compared, k));
  return json_text(file, 2) + '\n';
}

}  // namespace sinew
