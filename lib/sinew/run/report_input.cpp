// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/report_input.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include <sinew/body/bone_force.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/material/laws.h>
#include <sinew/metrics/files.h>
#include <sinew/rig/binding.h>
#include <sinew/run/machine_columns.h>
#include <sinew/run/run_files.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/check/stiffness.h>

namespace sinew {

namespace {

constexpr int samples = 300;

/// y at evenly spaced x, both ends included.
template <class Law>
CurveLine sampled(const char* name, double low, double high, const Law& law) {
  CurveLine line{name, {}, {}};
  for (int i = 0; i <= samples; ++i) {
    line.x.push_back(low + (high - low) * i / samples);
    line.y.push_back(law(line.x.back()));
  }
  return line;
}

std::string number(const char* name, double value, const char* unit) {
  return std::string(name) + " = " + quantity_text(value, unit);
}

LawCurve pair_curve(const Material& material) {
  const PairForce pair = material.pair;
  LawCurve curve{
      "Force between two particles", "", "distance d in r", "f in N, repulsion positive", {}};
  curve.note = "f = k1 (4r² − d²) below 2r, −k2 (d − a)(b − d) from a to b, nothing beyond; " +
               number("k1", pair.k1, "Pa, ") + number("k2", pair.k2, "Pa, ") +
               number("a", pair.a / pair.r, "r, ") + number("b", pair.b / pair.r, "r.");
  const ForceLaw& law = law_of(material);
  curve.note += law.remark;
  curve.lines.push_back(sampled("force", 1.5, 1.15 * pair.b / pair.r,
                                [&](double d) { return pair.force(d * pair.r); }));
  if (!law.has_bonds) return curve;
  curve.lines.push_back(sampled("bond", 1.5, 1.15 * pair.b / pair.r, [&](double d) {
    return law.bond_force(material, {2 * pair.r, material.bond.stiffness}, d * pair.r);
  }));
  return curve;
}

LawCurve energy_curve(const PairForce& pair) {
  LawCurve curve{"Energy of two particles", "", "distance d in r", "phi in J", {}};
  curve.note = "Its slope is the force; its depth is the energy that separates two particles.";
  curve.lines.push_back(sampled("energy", 1.5, 1.15 * pair.b / pair.r,
                                [&](double d) { return pair.potential(d * pair.r); }));
  return curve;
}

LawCurve bone_curve(const std::vector<BoneSprings>& springs, const Skeleton& skeleton, double r) {
  LawCurve curve{
      "Force of a bone on a particle", "", "away from its place, in r", "force in N", {}};
  const bool anchored = springs.front().form == BoneForce::anchor;
  curve.note = anchored ? "f = −k_b (x − q), q its position in the rigid pose of the bone."
                        : "Radial: f = −k_b (|x − p| − l0), p the nearest point of the bone.";
  constexpr std::size_t max_bones = 6;  // lines that can be distinguished
  for (std::size_t b = 0; b < std::min(springs.size(), max_bones); ++b)
    curve.lines.push_back(sampled(skeleton.bones[b].name.c_str(), -2, 2,
                                  [&](double x) { return -springs[b].radial * x * r; }));
  return curve;
}

LawCurve twist_curve(const std::vector<BoneSprings>& springs, const Skeleton& skeleton, double r) {
  LawCurve curve{"Turning pull of a bone", "", "turned away by, degrees", "force in N", {}};
  curve.note = "f = −k_tau rho alpha for a particle at a distance rho = 5 r from the bone.";
  constexpr std::size_t max_bones = 6;
  for (std::size_t b = 0; b < std::min(springs.size(), max_bones); ++b)
    curve.lines.push_back(sampled(skeleton.bones[b].name.c_str(), -90, 90, [&](double angle) {
      return -springs[b].twist * 5 * r * radians(angle);
    }));
  return curve;
}

}  // namespace

std::vector<LawCurve> law_curves(const RunFiles& run) {
  const Material& material = run.material;
  std::vector<LawCurve> curves{pair_curve(material)};
  if (!law_of(material).has_bonds) curves.push_back(energy_curve(material.pair));
  if (run.skeleton.size() == 0) return curves;
  const double r = run.body.particles.radius;
  const Points rest =
      positions_of(run.ids.empty() ? run.body.particles : read_body(run.folder.body()).particles);
  const Binding binding =
      bind_to_bones(rest, run.skeleton, volume_per_particle(r), run.settings.binding.joint_zone);
  const std::vector<BoneSprings> springs = bone_springs(run.settings.binding, material, binding);
  curves.push_back(bone_curve(springs, run.skeleton, r));
  if (springs.front().form == BoneForce::paper && springs.front().twist_form == TwistForm::servo)
    curves.push_back(twist_curve(springs, run.skeleton, r));
  return curves;
}

namespace {

std::string with_unit(double value, const char* unit) {
  return *unit ? quantity_text(value, unit) : three_digits(value);
}

/// A JSON value as text.
std::string shown_value(const nlohmann::ordered_json& value) {
  if (value.is_number_float()) return three_digits(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return json_text(value);
  std::string list;
  for (const auto& item : value) (list += list.empty() ? "" : ", ") += shown_value(item);
  return list;
}

/// The report of the fill, from body.vtu.
FactGroup fill_facts(const std::string& body_meta) {
  FactGroup group{"Filling", {}};
  const auto meta = own_json<nlohmann::ordered_json>(body_meta);
  if (!meta.is_object() || !meta.contains("fill")) return group;
  const auto units = meta.contains("fill_units") ? meta["fill_units"] : nlohmann::ordered_json();
  for (const auto& [key, value] : meta["fill"].items()) {
    if (key == "warnings") continue;  // above, with the others
    std::string name = key;
    std::replace(name.begin(), name.end(), '_', ' ');
    const bool known = units.is_object() && units.contains(key) && units[key].is_string();
    const std::string unit = known ? units[key].get<std::string>() : "";
    group.facts.push_back({name, shown_value(value) + (unit.empty() ? "" : ' ' + unit)});
  }
  return group;
}

/// "80 kPa: 100 kPa along it, less up to 20 % for 5 planes across".
std::string less_by_size(double along, double lack, double planes) {
  return with_unit(along * (1 - lack), "Pa") + ": " + parts_of_modulus(along, lack, planes);
}

/// What a body that bends along each bone shows, from run.json.
FactGroup stiffness_facts(const nlohmann::ordered_json& record) {
  FactGroup group{"Young's modulus in bending, along bones", {}};
  for (const auto& bone : record.value("stiffness_along_bones", nlohmann::ordered_json::array())) {
    const double along = bone.value("young_modulus", 0.0);
    const double lack = bone.value("lack_of_bending_stiffness", 0.0);
    group.facts.push_back(
        {bone.value("bone", ""), less_by_size(along, lack, bone.value("planes_across", 0.0))});
  }
  return group;
}

/// What a body shows that supports and loads strain, from run.json: as foreseen, and at probes.
FactGroup modulus_facts(const nlohmann::ordered_json& record) {
  FactGroup group{"Young's modulus, between supports and loads", {}};
  const auto none = nlohmann::ordered_json::array();
  for (const auto& span : record.value("stiffness_along_spans", none)) {
    const double along = span.value("young_modulus", 0.0), lack = span.value("lack", 0.0);
    group.facts.push_back({span.value("from", "") + " to " + span.value("to", ""),
                           less_by_size(along, lack, span.value("planes_across", 0.0)) +
                               (span.value("bends", false) ? ", in bending" : "")});
  }
  for (const auto& entry : record.value("moduli_at_probes", none))
    group.facts.push_back({"at probe " + entry.value("probe", ""), modulus_text(entry)});
  return group;
}

/// The parts of a body that differ in material, from run.json.
FactGroup material_facts(const nlohmann::ordered_json& record) {
  FactGroup group{"Parts", {}};
  for (const auto& one : record.value("materials", nlohmann::ordered_json::array()))
    group.facts.push_back({one.value("name", ""), std::to_string(one.value("particles", 0)) +
                                                      " particles, " +
                                                      with_unit(one.value("mass", 0.0), "kg")});
  return group;
}

/// How a body was brought to rest in each frame, from run.json.
FactGroup load_step_facts(const nlohmann::ordered_json& record) {
  FactGroup group{"Load steps", {}};
  const double interval = record.value("frame_interval", 0.0);
  const double end = record.value("duration", std::numeric_limits<double>::infinity());
  for (const auto& one : record.value("load_steps", nlohmann::ordered_json::array())) {
    const int frame = one.value("frame", 0);
    group.facts.push_back(
        {"frame " + std::to_string(frame) + ", " + with_unit(std::min(frame * interval, end), "s"),
         std::to_string(one.value("iterations", std::int64_t{0})) + " iterations, residual " +
             three_digits(one.value("residual", 0.0))});
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
            {"neighbor search", record.value("neighbor_search", "")},
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
          material_facts(record),
          load_step_facts(record),
          stiffness_facts(record),
          modulus_facts(record),
          fill_facts(body_meta)};
}

/// "0.533 s" for the picture of frame 16; those without a number have captions of their own.
std::string caption_of(const std::filesystem::path& picture, const Measured& measured) {
  const std::string name = picture.stem().string();
  const auto digits = name.find_first_of("0123456789");
  if (name == "scene") return "The scene at rest from two sides, with axes in meters";
  const std::string bonds = name.starts_with("bonds_") ? "The bonds, " : "";
  if (digits == std::string::npos) return bonds.empty() ? "Over time" : bonds + "over time";
  const auto frame = std::strtoul(name.c_str() + digits, nullptr, 10);
  return frame < measured.frames.size() ? bonds + three_digits(measured.frames[frame].time) + " s"
                                        : name;
}

/// The pictures in the folder, but for links to others elsewhere: the scene, the contact sheet,
/// then single moments in order.
std::vector<Picture> pictures_in(const RunFolder& folder, const Measured& measured) {
  std::vector<Picture> pictures;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder.pictures(), none))
    if (entry.path().extension() == ".png" &&
        !file_below(folder.pictures(), entry.path().filename()).empty())
      pictures.push_back(
          {"pictures/" + entry.path().filename().string(), caption_of(entry.path(), measured)});
  const auto place = [](const Picture& picture) {
    if (picture.path == "pictures/scene.png") return 0;
    return picture.path.find("contact_sheet") != std::string::npos ? 1 : 2;
  };
  const auto is_sheet = [](const Picture& picture) {
    return picture.path == "pictures/contact_sheet.png";
  };
  if (std::any_of(pictures.begin(), pictures.end(), is_sheet))  // which has the same moments
    std::erase_if(pictures, [](const Picture& picture) {
      return picture.path.starts_with("pictures/body_");
    });
  std::sort(pictures.begin(), pictures.end(), [&](const Picture& a, const Picture& b) {
    return place(a) != place(b) ? place(a) < place(b) : a.path < b.path;
  });
  return pictures;
}

/// What was run, in a sentence, from run.json.
std::string subject_of(const RunFolder& folder, const Settings& settings) {
  const auto record = read_record(folder);
  const auto material = record.value("material", nlohmann::ordered_json::object());
  const bool paper = settings.material.model == MaterialModel::paper;
  std::string text = std::to_string(record.value("particles", 0)) + " particles of radius " +
                     with_unit(record.value("radius", 0.0), "m") + ", " +
                     (paper ? "the paper's material" : "bonded") + ", Young's modulus " +
                     with_unit(material.value("young_modulus", 0.0), "Pa");
  if (paper) text += ", lambda " + three_digits(material.value("lambda", 0.0));
  if (const double step = record.value("time_step", 0.0);
      step > 0 && settings.solver.method == Method::dynamic)
    text += "; steps of " + with_unit(step, "s");
  return text + "; sinew " + record.value("version", "") + ", " + record.value("started", "") + '.';
}

/// How the run ended, from run.json.
RunEnd end_of(const RunFolder& folder, const std::vector<FrameMetrics>& frames) {
  const auto record = read_record(folder);
  const std::string status = record.value("status", "finished");
  RunEnd end;
  if (status == "finished" || frames.empty()) return end;
  end.kind = status == "unstable" || status == "failed" ? RunEnd::Kind::broke : RunEnd::Kind::waits;
  end.time = frames.back().time;
  end.of = record.value("duration", 0.0);
  if (end.kind == RunEnd::Kind::broke)
    end.why = record.value("error", "");
  else
    end.why = status == "running" ? "It is still in progress." : "Go on with --resume.";
  return end;
}

}  // namespace

ReportInput report_input(const RunFiles& run, Measured measured, MovieLink movie) {
  ReportInput input;
  input.title = scene_name(run.folder);
  input.version = version();
  input.radius = run.body.particles.radius;
  input.particles = run.ids.empty() ? run.body.particles.size() : run.ids.size();
  input.modulus = run.material.young_modulus();
  try {
    input.facts = facts_of(run.folder, run.body.meta);
    input.subject = subject_of(run.folder, run.settings);
    input.end = end_of(run.folder, measured.frames);
    input.warnings = warnings_in(read_record(run.folder));
  } catch (const nlohmann::json::exception&) {
    throw bad_input(Place{run.folder.record().string()}, "is not the record of a run",
                    "run the scene again with --force");
  }
  input.pictures = pictures_in(run.folder, measured);
  input.frames = std::move(measured.frames);
  input.summary = std::move(measured.summary);
  input.checks = std::move(measured.checks);
  input.playback = std::move(measured.playback);
  input.curves = law_curves(run);
  input.machine = machine_columns(run.folder.path);
  input.charts = table_charts(run.folder.path);
  if (movie == MovieLink::follows || std::filesystem::exists(run.folder.pictures() / "movie.mp4"))
    input.movie = "pictures/movie.mp4";
  input.scene_text = run.scene_text;
  return input;
}

void write_tables(const RunFiles& run, const Measured& measured) {
  const std::filesystem::path& folder = run.folder.path;
  write_file(folder / "metrics.csv", metrics_csv(measured.frames));
  write_file(folder / "metrics_bones.csv", bone_metrics_csv(measured.bones));
  write_file(folder / "sections.csv", sections_csv(measured.sections));
  write_file(folder / "metrics.json",
             metrics_json(measured.frames, measured.summary, measured.checks));
}

void write_report(const RunFiles& run, Measured measured, MovieLink movie) {
  write_file(run.folder.path / "report.html",
             report_html(report_input(run, std::move(measured), movie)));
}

}  // namespace sinew
