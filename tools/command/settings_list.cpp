// SPDX-License-Identifier: GPL-3.0-or-later
#include "command/settings_list.h"

#include <fmt/format.h>
#include <cmath>
#include <vector>

#include <sinew/core/system.h>
#include <sinew/settings/row.h>
#include <sinew/settings/table.h>
#include <sinew/settings/values.h>

namespace sinew {
namespace {

/// One key as text.
struct Line {
  std::string name, unit, standard, values, help;
};

struct Group {
  std::string title;
  std::vector<Line> rows;
};

/// 1/30 instead of its 16 digits.
std::string short_text(const FieldValue& value, std::string_view absent) {
  const auto* number = std::get_if<double>(&value);
  const double inverse = number == nullptr || *number == 0 ? 0.5 : 1 / *number;
  const bool fraction = inverse == std::round(inverse) && number_text(*number).size() > 8;
  return fraction ? "1/" + number_text(inverse) : scene_text(value, absent);
}

template <class Owner>
Line words_of(const Field<Owner>& row) {
  Rules rules = rules_of(row);
  rules.unit = rules.absent = {};  // they have their own columns
  return {std::string(row.name), std::string(row.unit),
          row.required ? "required" : short_text(row.get(Owner{}), row.absent), values_text(rules),
          std::string(row.help)};
}

template <class Owner>
Group entries(const std::string& title, std::span<const Field<Owner>> rows) {
  Group group = {title, {}};
  for (const auto& row : rows) group.rows.push_back(words_of(row));
  return group;
}

Group section_group(std::string_view section) {
  Group group = {std::string(section), {}};
  for (const auto& row : settings_table())
    if (row.section == section) group.rows.push_back(words_of(row));
  return group;
}

void add_world(std::vector<Group>& all) {
  all.push_back(entries("world.obstacles[]", obstacle_fields()));
  all.push_back(entries("world.obstacles[].keys[]", place_key_fields()));
  all.push_back(entries("world.obstacles[].friction_keys[]", friction_key_fields()));
  all.push_back(entries("world.pins[]", pin_fields()));
  all.push_back(entries("world.fields[]", field_fields()));
  all.push_back(entries("world.fields[].keys[]", strength_fields()));
  all.push_back(entries("world.muscles[]", muscle_fields()));
  all.push_back(entries("world.muscles[].keys[]", activation_fields()));
  all.push_back(entries("world.springs[]", spring_fields()));
  all.push_back(entries("world.springs[].keys[]", spring_key_fields()));
}

void add_machine(std::vector<Group>& all) {
  all.push_back(entries("supports[]", support_fields()));
  all.push_back(entries("supports[].keys[]", place_key_fields()));
  all.push_back(entries("loads[]", load_fields()));
  all.push_back(entries("loads[].keys[]", factor_fields()));
  all.push_back(entries("probes[]", probe_fields()));
  all.push_back(entries("materials[]", material_fields()));
}

std::vector<Group> groups() {
  std::vector<Group> all;
  for (const std::string_view section : sections()) {
    if (Group group = section_group(section); !group.rows.empty()) all.push_back(std::move(group));
    if (section == "body") all.push_back(entries("bodies[]", part_fields()));
    if (section == "skeleton") {
      all.push_back(entries("skeleton.bones[]", bone_fields()));
      all.push_back(entries("skeleton.bones[].limits", limit_fields()));
    }
    if (section == "binding") all.push_back(entries("binding.explicit[]", bound_fields()));
    if (section == "motion") {
      all.push_back(entries("motion.tracks[]", track_fields()));
      all.push_back(entries("motion.tracks[].keys[]", key_fields()));
    }
    if (section == "world") {
      add_world(all);
      add_machine(all);
    }
  }
  return all;
}

}  // namespace

std::string settings_help() {
  std::string text;
  for (const Group& group : groups()) {
    text += "\n  " + group.title + '\n';
    for (const Line& row : group.rows) {
      const std::string unit = row.unit.empty() ? "" : '[' + row.unit + "] ";
      text += fmt::format("    {:<17} {:<17} {}{}\n", row.name, row.standard, unit, row.help);
      if (row.values.find(',') != row.values.npos && row.values.substr(0, 7) == "one of ")
        text += fmt::format("{:40}{}\n", "", row.values);
    }
  }
  return text;
}

namespace {

/// Escapes text, so that roff prints it.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '-') out += '\\';
    if ((c == '.' || c == '\'') && out.empty()) out += "\\&";
    out += c;
  }
  return out;
}

}  // namespace

std::string settings_manual() {
  std::string text =
      ".TH SINEW\\-SCENE 5 \"\" \"sinew " + version() +
      "\" \"File Formats\"\n.SH NAME\n"
      "sinew\\-scene \\- a body, its bones and their motion, for sinew(1)\n.SH DESCRIPTION\n"
      "A scene is a YAML file. Lengths are in meters, times in seconds, all other quantities in SI "
      "units, and angles in degrees; z points up. Paths are relative to the file. Only the mesh, "
      "the radius (or the count) and the bones are required.\n.SH EXAMPLE\n.nf\n"
      "body: {mesh: part.stl, unit: mm, count: 20000}\nskeleton:\n  bones:\n"
      "    \\- {name: lower, head: [0, 0, 0], tail: [0, 0, 0.1]}\n"
      "    \\- {name: upper, parent: lower, tail: [0, 0, 0.2]}\nmotion:\n  tracks:\n"
      "    \\- {bone: upper, keys: [{time: 0}, {time: 1, axis: [0, 1, 0], angle: 90}]}\n.fi\n"
      ".SH KEYS\n";
  for (const Group& group : groups()) {
    text += ".SS " + roff(group.title) + '\n';
    for (const Line& row : group.rows) {
      text += ".TP\n\\fB" + roff(row.name) + "\\fR  " + roff(row.standard) +
              (row.unit.empty() ? "" : "  [" + roff(row.unit) + ']') + '\n' + roff(row.help);
      text += row.values.empty() ? "\n" : "\n.br\n" + roff(row.values) + '\n';
    }
  }
  return text + ".SH SEE ALSO\nsinew(1), sinew\\-run(1), sinew\\-new(1), sinew\\-check(1)\n";
}

std::vector<std::string> setting_keys() {
  std::vector<std::string> keys;
  for (const auto& row : settings_table())
    keys.push_back(std::string(row.section) + '.' + std::string(row.name));
  return keys;
}

std::string settings_markdown() {
  std::string text;
  for (const Group& group : groups()) {
    text += "| " + group.title + " | default | unit | values | meaning |\n|---|---|---|---|---|\n";
    for (const Line& row : group.rows)
      text += markdown_row({'`' + row.name + '`', row.standard, row.unit, row.values, row.help});
    text += '\n';
  }
  text.pop_back();
  return text;
}

}  // namespace sinew
