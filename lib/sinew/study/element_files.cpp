// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <nlohmann/json.hpp>

#include <sinew/core/text.h>
#include <sinew/io/frame_table.h>
#include <sinew/study/compare_elements.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

/// The displacements of a probe, with the ends of their columns' names.
std::array<std::pair<const char*, const Points*>, 2> sides_of(const ComparedProbe& probe) {
  return {{{" by elements", &probe.elements}, {"", &probe.run}}};
}

Json json_of(const ElementComparison& compared, std::size_t k) {
  Json row;
  for (const ElementColumn& column : element_columns()) {
    const double value = compared.frames[k].*column.value;
    row[std::string(column.name)] = std::isfinite(value) ? Json(value) : Json();
  }
  for (const ComparedProbe& probe : compared.probes)
    for (const auto& [end, values] : sides_of(probe)) {
      const Vec3& moved = (*values)[k];
      row[probe.name + ": displacement" + end] = {moved.x(), moved.y(), moved.z()};
    }
  return row;
}

}  // namespace

std::string reference_csv(const ElementComparison& compared) {
  std::string text;
  for (const ElementColumn& column : element_columns())
    (text += text.empty() ? "" : ",") += column.name;
  for (const ComparedProbe& probe : compared.probes)
    for (const auto& [end, values] : sides_of(probe))
      for (const char axis : {'x', 'y', 'z'})
        text += ',' + csv_cell(probe.name + ": displacement_" + axis + end);
  text += '\n';
  for (std::size_t k = 0; k < compared.frames.size(); ++k) {
    std::string line;
    const auto add = [&](double value) {
      (line += line.empty() ? "" : ",") += std::isnan(value) ? "nan" : number_text(value);
    };
    for (const ElementColumn& column : element_columns()) add(compared.frames[k].*column.value);
    for (const ComparedProbe& probe : compared.probes)
      for (const auto& [end, values] : sides_of(probe))
        for (int axis = 0; axis < 3; ++axis) add((*values)[k][axis]);
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
  return file.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace sinew
