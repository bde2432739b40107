// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/report_input.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command/command.h"
#include "core/number_text.h"
#include "folder/run_record.h"
#include "measure/law_curves.h"

namespace sinew {
namespace {

std::string with_unit(double value, const char* unit) {
  return three_digits(value) + (*unit ? std::string(" ") + unit : "");
}

/// A value of JSON for people.
std::string shown_value(const nlohmann::ordered_json& value) {
  if (value.is_number_float()) return three_digits(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string list;
  for (const auto& item : value) (list += list.empty() ? "" : ", ") += shown_value(item);
  return list;
}

/// The report of the fill, as body.vtu keeps it.
FactGroup fill_facts(const std::string& body_meta) {
  FactGroup group{"Filling", {}};
  const auto meta = nlohmann::ordered_json::parse(body_meta, nullptr, false);
  if (!meta.is_object() || !meta.contains("fill")) return group;
  const auto units = meta.value("fill_units", nlohmann::ordered_json::object());
  for (const auto& [key, value] : meta["fill"].items()) {
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    const std::string unit = units.value(key, "");
    group.facts.push_back({name, shown_value(value) + (unit.empty() ? "" : ' ' + unit)});
  }
  return group;
}

std::vector<FactGroup> facts_of(const RunFolder& folder, const std::string& body_meta) {
  const auto record = read_record(folder);
  const auto number = [&](const char* key, const char* unit) {
    return with_unit(record.value(key, 0.0), unit);
  };
  const auto material = record.value("material", nlohmann::ordered_json::object());
  const auto constant = [&](const char* key, const char* unit) {
    return with_unit(material.value(key, 0.0), unit);
  };
  return {{"Run",
           {{"status", record.value("status", "")},
            {"particles", std::to_string(record.value("particles", 0))},
            {"frames", std::to_string(record.value("frames", 0))},
            {"steps", std::to_string(record.value("steps", std::int64_t{0}))},
            {"time step", number("time_step", "s")},
            {"share of the stability limit", number("time_step_factor", "")},
            {"precision", record.value("precision", "")},
            {"neighbour search", record.value("neighbour_search", "")},
            {"instruction set", record.value("instruction_set", "")},
            {"particle-steps per second", number("particle_steps_per_second", "")},
            {"state hash", record.value("state_hash", "")},
            {"started", record.value("started", "")}}},
          {"Material",
           {{"Young's modulus", constant("young_modulus", "Pa")},
            {"k1", constant("k1", "Pa")},
            {"k2", constant("k2", "Pa")},
            {"a", constant("a", "m")},
            {"b", constant("b", "m")},
            {"lambda", constant("lambda", "")},
            {"damping constant C", constant("damping", "kg/s")},
            {"particle radius", number("radius", "m")},
            {"particle mass", number("particle_mass", "kg")}}},
          fill_facts(body_meta)};
}

/// "0.533 s" for the picture of frame 16, else the file's own name.
std::string caption_of(const std::filesystem::path& picture, const Measured& measured) {
  const std::string name = picture.stem().string();
  const auto digits = name.find_first_of("0123456789");
  if (digits == std::string::npos) return "Over time";
  const auto frame = std::strtoul(name.c_str() + digits, nullptr, 10);
  return frame < measured.frames.size() ? three_digits(measured.frames[frame].time) + " s" : name;
}

/// The pictures that render has left: the contact sheet, then single moments in order.
std::vector<Picture> pictures_in(const RunFolder& folder, const Measured& measured) {
  std::vector<Picture> pictures;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder.pictures(), none))
    if (entry.path().extension() == ".png")
      pictures.push_back(
          {"pictures/" + entry.path().filename().string(), caption_of(entry.path(), measured)});
  const auto is_sheet = [](const Picture& picture) {
    return picture.path.find("contact_sheet") != std::string::npos;
  };
  std::sort(pictures.begin(), pictures.end(), [&](const Picture& a, const Picture& b) {
    return is_sheet(a) != is_sheet(b) ? is_sheet(a) : a.path < b.path;
  });
  return pictures;
}

std::string title_of(const RunFolder& folder) {
  return std::filesystem::absolute(folder.path / ".").lexically_normal().parent_path().filename();
}

}  // namespace

ReportInput report_input(const RunFiles& run, Measured measured) {
  ReportInput input;
  input.title = title_of(run.folder);
  input.version = version();
  input.radius = run.body.particles.radius;
  try {
    input.facts = facts_of(run.folder, run.body.meta);
  } catch (const nlohmann::json::exception&) {
    throw bad_input(Place{run.folder.record().string()}, "is not the record of a run",
                    "run the scene again with --force");
  }
  input.pictures = pictures_in(run.folder, measured);
  input.frames = std::move(measured.frames);
  input.summary = std::move(measured.summary);
  input.checks = std::move(measured.checks);
  input.film = std::move(measured.film);
  input.curves = law_curves(run);
  if (std::filesystem::exists(run.folder.pictures() / "movie.mp4"))
    input.movie = "pictures/movie.mp4";
  input.scene_text = run.scene_text;
  return input;
}

}  // namespace sinew
