// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/body_options.h"

#include <algorithm>
#include <array>
#include <utility>

#include <sinew/settings/row.h>
#include <sinew/settings/table.h>

namespace sinew {
namespace {

using Row = Field<Settings>;

bool is_wanted(const Row& row, BodyFlags::Kind kind) {
  static constexpr std::array<std::string_view, 9> of_mesh = {
      "unit", "scale", "up", "forward", "level", "weld", "rule", "close_holes", "wrap"};
  if (row.section == "body" && kind == BodyFlags::Kind::mesh)
    return std::find(of_mesh.begin(), of_mesh.end(), row.name) != of_mesh.end();
  if (kind == BodyFlags::Kind::mesh) return false;
  const bool moves = row.name == "velocity" || row.name == "angular_velocity";
  return (row.section == "body" && row.name != "mesh" && !moves) ||
         (row.section == "material" && row.name == "density");
}

std::vector<const Row*> wanted_rows(BodyFlags::Kind kind) {
  std::vector<const Row*> wanted;
  for (const Row& row : settings_table())
    if (is_wanted(row, kind)) wanted.push_back(&row);
  return wanted;
}

std::string option_name(const Row& row) {
  std::string name = "--";
  name += row.name;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string type_name(const Row& row) {
  if (row.kind == FieldKind::vector) return "X,Y,Z";
  if (row.kind != FieldKind::choice) return row.kind == FieldKind::whole ? "N" : "NUMBER";
  std::string names;
  for (const std::string_view choice : row.choices) (names += names.empty() ? "" : "|") += choice;
  return names;
}

std::string help_of(const Row& row) {
  std::string help(row.help);
  if (!row.unit.empty()) (help += ", ") += row.unit;
  if (row.absent.empty() && row.kind != FieldKind::flag)
    help += " [" + scene_text(row.get(Settings{}), "") + ']';
  return help;
}

}  // namespace

void BodyFlags::declare(OptionList& list, Kind kind) {
  const auto wanted = wanted_rows(kind);
  given_.resize(wanted.size());  // options keep pointers to their values
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Row& row = *wanted[i];
    Given& one = given_[i];
    one.path = std::string(row.section) + '.' + std::string(row.name);
    one.option = option_name(row);
    one.flag = row.kind == FieldKind::flag;
    const std::string help = help_of(row);
    one.parsed = one.flag ? list.add_flag(one.option, help)
                          : list.add(one.option, one.value, help).type_name(type_name(row));
    one.parsed->group("Options for a mesh");
  }
}

std::vector<Override> BodyFlags::overrides() const {
  std::vector<Override> all;
  for (const Given& one : given_) {
    if (!one.parsed->given()) continue;
    std::string value = one.flag ? "true" : one.value;
    if (value.find(',') != std::string::npos && value.front() != '[')
      value.insert(0, "[").append("]");
    std::string given = one.option;
    if (!one.flag) given.append(" ").append(one.value);
    all.push_back({one.path, value, std::move(given)});
  }
  return all;
}

}  // namespace sinew
