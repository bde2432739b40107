// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/detail/run_log.h>

#include <algorithm>

#include <sinew/body/grouping.h>
#include <sinew/core/arrays.h>
#include <sinew/core/hash.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/particles.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/series_table.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/check/stiffness.h>
#include <sinew/scene/check/warnings.h>
#include <sinew/settings/table.h>

namespace sinew {
namespace {

using Json = nlohmann::ordered_json;

/// Series that a run may have: readers take those whose files are there.
Json table_of_series() {
  Json series;
  for (const SeriesRow& row : series_table()) {
    Json& one = series[std::string(row.name)];
    one = {{"cells", cells_text(row.cells)}, {"contents", row.contents}};
    if (!row.asked_by.empty()) one["asked_by"] = row.asked_by;
  }
  return series;
}

Json arrays_with_units() {
  Json arrays;
  for (const WrittenArray& array : written_arrays())
    arrays[std::string(array.series)][std::string(array.name)] = {
        {"on", place_text(array.place)}, {"unit", array.unit}, {"meaning", array.help}};
  const Json of_particles = arrays["particles"];
  for (const auto& [name, row] : of_particles.items())  // arrays that output.skin asks for
    if (row["on"] == "point" && !arrays["surface"].contains(name)) arrays["surface"][name] = row;
  return arrays;
}

Json bones_of(const Skeleton& skeleton) {
  Json bones = Json::array();
  for (const Bone& bone : skeleton.bones)
    bones.push_back({{"name", bone.name}, {"parent", bone.parent}, {"length", bone.length}});
  return bones;
}

Json material_of(const Material& material) {
  Json values{{"k1", material.pair.k1},
              {"k2", material.pair.k2},
              {"a", material.pair.a},
              {"b", material.pair.b},
              {"lambda", material.pair.lambda()},
              {"contact_stiffness", material.pair.contact_stiffness()},
              {"tension_stiffness", material.pair.tension_stiffness()},
              {"damping", material.damping},
              {"young_modulus", material.young_modulus()}};
  if (material.bond.yield_shear > 0) values["creep_rate"] = material.bond.creep_rate;
  return values;
}

/// The body's own, where something of it is left, and those of its parts.
Json materials_of(const Settings& settings, const Body& body) {
  std::vector<std::size_t> particles(settings.materials.size() + 1, 0);
  std::vector<double> mass(particles.size(), 0);
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    const auto number = static_cast<std::size_t>(body.material_number[i]);
    ++particles[number];
    mass[number] += mass_of(body, i, body.material.mass);
  }
  Json materials = Json::array();
  for (std::size_t k = 0; k < particles.size(); ++k)
    if (particles[k] > 0)
      materials.push_back({{"name", k == 0 ? "material" : settings.materials[k - 1].name},
                           {"particles", particles[k]},
                           {"mass", mass[k]}});
  return materials;
}

Json lists_of(const ListCounts& counts) {
  return {{"rebuilds", counts.rebuilds},
          {"surveys", counts.surveys},
          {"sorts", counts.sorts},
          {"pieces_listed", counts.listed},
          {"pieces_pruned", counts.pruned}};
}

/// Bytes; none where the file is missing.
std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file, missing);
  return missing ? 0 : size;
}

/// Restores the times that a resumed run has spent and when it began.
void go_on_from(const Json& before, Json& record) {
  for (const char* key : {"started", "seconds", "load_steps", "warnings"})
    if (before.contains(key)) record[key] = before[key];
  record["resumed"] = 1 + before.value("resumed", 0);
}

/// Written before anything else: the record tells that the other files are of a run.
Json written_record(const RunFolder& folder, const std::vector<std::string>& command,
                    bool resumed) {
  Json record = begin_record(command);
  record["seconds"] = Json::object();
  record["resumed"] = 0;
  if (resumed) go_on_from(read_record(folder), record);
  write_record(folder, record);
  return record;
}

}  // namespace

RunLog::RunLog(const RunFolder& folder, const std::vector<std::string>& command, bool resumed)
    : folder_(folder),
      record_(written_record(folder, command, resumed)),
      log_(folder.log(), resumed ? size_of(folder.log()) : 0) {
  std::string words;
  for (const std::string& word : command) words += (words.empty() ? "" : " ") + word;
  log("sinew " + record_["version"].get<std::string>() + ": " + words);
}

void RunLog::log(const std::string& line) {
  const std::string dated =
      time_text("%Y-%m-%d %H:%M:%S", Zone::local) + "  " + printable(line) + "\n";
  log_.add(dated.data(), dated.size());
}

void RunLog::describe(const Prepared& prepared) {
  const Settings& settings = prepared.settings;
  const StepChoice& steps = prepared.steps;
  record_["particles"] = prepared.body.rest.size();
  if (const Vec3 at = local_origin(bounds(prepared.surface.triangles.points)); !at.isZero(0))
    record_["origin"] = {at.x(), at.y(), at.z()};
  record_["radius"] = prepared.body.material.pair.r;
  record_["particle_mass"] = prepared.body.material.mass;
  record_["material"] = material_of(prepared.body.material);
  if (!settings.materials.empty()) record_["materials"] = materials_of(settings, prepared.body);
  record_["bones"] = bones_of(prepared.body.skeleton);
  for (const BoneStiffness& bone : stiffness_along_bones(prepared.body))
    record_["stiffness_along_bones"].push_back({{"bone", bone.bone},
                                                {"young_modulus", bone.young_modulus},
                                                {"planes_across", bone.planes},
                                                {"lack_of_bending_stiffness", bone.lack}});
  for (const SpanStiffness& span : stiffness_between_grips(prepared))
    record_["stiffness_along_spans"].push_back({{"from", span.from},
                                                {"to", span.to},
                                                {"bends", span.bends},
                                                {"young_modulus", span.young_modulus},
                                                {"planes_across", span.planes},
                                                {"lack", span.lack_shown()}});
  record_["duration"] = settings.solver.duration;
  record_["frame_interval"] = settings.output.interval;
  record_["time_step"] = steps.step;
  record_["time_step_limit"] = steps.limit;
  record_["time_step_factor"] = steps.factor();
  record_["steps_per_frame"] = steps.per_frame;
  describe(prepared.plan, prepared.frames.count);
  describe(stepper_choice(settings.solver));
  describe(prepared.body.grouping.get());
  for (const Intrusion& one : prepared.passing)
    record_["pass_through"].push_back(
        {prepared.body.skeleton.bones[static_cast<std::size_t>(one.bones[0])].name,
         prepared.body.skeleton.bones[static_cast<std::size_t>(one.bones[1])].name});
  if (prepared.beginning.posed) record_["begins"] = "pose";
  record_["steps"] = 0;
  record_["frames"] = 0;
  record_["series"] = table_of_series();
  record_["arrays"] = arrays_with_units();
  write_record(folder_, record_);
  log(std::to_string(prepared.body.rest.size()) + " particles of radius " +
      number_text(prepared.body.material.pair.r) + " m, " + std::to_string(prepared.frames.count) +
      " frames of " + std::to_string(steps.per_frame) + " steps");
  log("stability limit " + number_text(steps.limit) + " s, step " + number_text(steps.step) +
      " s, factor " + number_text(steps.factor()));
}

void RunLog::describe(const Grouping* grouping) {
  if (grouping == nullptr) return;
  record_["hierarchy"] = {{"groups", grouping->size()},
                          {"grouped", grouping->grouped()},
                          {"within", grouping->inside()}};
  log(std::to_string(grouping->size()) + " groups of " + std::to_string(grouping->grouped()) +
      " particles, " + std::to_string(grouping->inside()) + " of them within, where no forces act");
}

/// Frames with shorter steps before them: "shorter_steps": [{"frame": 7, "steps": 400}, ...]
void RunLog::describe(const StepPlan& plan, int frames) {
  if (plan.divided() == 0) return;
  auto& list = record_["shorter_steps"] = nlohmann::ordered_json::array();
  for (int frame = 1; frame <= frames; ++frame)
    if (plan.parts(frame - 1) > 1)
      list.push_back(
          {{"frame", frame}, {"steps", plan.steps_until(frame) - plan.steps_until(frame - 1)}});
  log("shorter steps before " + std::to_string(plan.divided()) +
      " frames, where bones are fast: down to 1/" + std::to_string(plan.max_parts()));
}

void RunLog::describe(const StepperChoice& choice) {
  record_["stepper"] = choice.search == NeighborSearch::lists ? "kernel" : "reference";
  record_["precision"] = name_of(choice.precision);
  record_["neighbor_search"] = name_of(choice.search);
  record_["instruction_set"] = kernel::name_of(choice.instructions);
  log(std::string("steps in ") + name_of(choice.precision) + " precision, neighbors by " +
      name_of(choice.search) + ", instructions " + kernel::name_of(choice.instructions));
}

void RunLog::describe(const RunIdentity& run) {
  record_["body_hash"] = hash_text(run.body);
  record_["motion_hash"] = hash_text(run.motion);
}

void RunLog::describe(const Engine& engine) {
  record_["stepper"] = engine.name;
  record_["ranks"] = engine.ranks;
  record_.erase("instruction_set");  // name of a built-in kernel
  write_record(folder_, record_);
  log("steps by " + engine.name + " on " + std::to_string(engine.ranks) + " ranks");
}

void RunLog::describe(const EngineSteps& steps) {
  record_["particles_on_ranks"] = steps.moment().particles;
  record_["engine_version"] = steps.moment().engine;
}

void RunLog::warn(const std::string& what) {
  std::vector<std::string> all = warnings_in(record_);
  if (std::find(all.begin(), all.end(), what) != all.end()) return;
  all.push_back(what);
  shortest_first(all);
  record_["warnings"] = std::move(all);
  log("warning: " + what);
}

void RunLog::spend(const std::string& stage, double seconds) {
  record_["seconds"][stage] = record_["seconds"].value(stage, 0.0) + seconds;
}

void RunLog::checkpoint(std::int64_t steps) {
  record_["steps"] = steps;
  write_record(folder_, record_);
  log("checkpoint at step " + std::to_string(steps));
}

void RunLog::frame(int frame, double time) {
  record_["frames"] = frame + 1;
  log("frame " + std::to_string(frame) + " at " + number_text(time) + " s");
}

void RunLog::retake(const Retake& why) {
  log("frame " + std::to_string(why.frame) + " is taken anew with steps of 1/" +
      std::to_string(why.divisor) + ": " +
      (why.moved_too_far
           ? "a particle moved too far in one"
           : "its energies are out of balance by " + three_digits(100 * why.residual) + " %"));
}

void RunLog::describe(const GuardState& guard, const LimitedSpeeds& limited) {
  auto& list = record_["taken_anew"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k + 1 < guard.divided.size(); k += 2)
    list.push_back({{"frame", guard.divided[k]}, {"divisor", guard.divided[k + 1]}});
  record_["limited"] = limited.times;
  record_["limited_energy"] = limited.energy;
  record_["limited_impulse"] = {limited.impulse.x(), limited.impulse.y(), limited.impulse.z()};
}

void RunLog::load_step(int frame, const Equilibrium& found, const Unbalanced& left) {
  record_["load_steps"].push_back({{"frame", frame},
                                   {"iterations", found.iterations},
                                   {"increments", found.increments},
                                   {"residual", found.residual},
                                   {"inverted", found.inverted},
                                   {"unbalanced_force", left.force},
                                   {"unbalanced_moment", left.moment}});
  describe_unbalanced();
  log("at rest after " + std::to_string(found.iterations) + " iterations in " +
      std::to_string(found.increments) + (found.increments == 1 ? " increment" : " increments") +
      ", with a residual of " + three_digits(found.residual));
}

/// The largest over the frames.
void RunLog::describe_unbalanced() {
  for (const char* key : {"unbalanced_force", "unbalanced_moment"}) {
    double largest = 0;
    for (const Json& frame : record_["load_steps"])
      largest = std::max(largest, frame.value(key, 0.0));
    record_[key] = largest;
  }
}

void RunLog::frames(int written) {
  record_["frames"] = written;
  if (!record_.contains("load_steps")) return;
  auto& steps = record_["load_steps"];
  while (steps.size() > static_cast<std::size_t>(written)) steps.erase(steps.size() - 1);
  describe_unbalanced();
}

void RunLog::describe(const std::vector<ShownModulus>& moduli) {
  if (!moduli.empty()) record_["moduli_at_probes"] = Json::array();
  for (const ShownModulus& one : moduli) {
    Json row{{"probe", one.probe},
             {"young_modulus", one.young_modulus()},
             {"stress", one.stress},
             {"strain", one.strain}};
    if (one.asked) row["young_modulus_asked"] = *one.asked;
    log("Young's modulus at probe " + shown(one.probe) + ": " + modulus_text(row));
    record_["moduli_at_probes"].push_back(std::move(row));
  }
}

void RunLog::end(const std::string& status, const Simulation& simulation) {
  const double stepping = record_["seconds"].value("stepping", 0.0);
  const auto steps = static_cast<double>(simulation.steps());
  record_["status"] = status;
  record_["steps"] = simulation.steps();
  record_["particle_steps_per_second"] =
      stepping > 0 ? steps * static_cast<double>(simulation.particles().size()) / stepping : 0.0;
  if (simulation.body().grouping) {
    describe(simulation.body().grouping.get());
    record_["hierarchy"]["regroupings"] = simulation.regroupings();
    record_["hierarchy"]["lost_by_merging"] = simulation.lost_by_merging();
  }
  record_["lists"] = lists_of(simulation.list_counts());
  record_["state_hash"] = hash_text(state_hash(simulation.particles()));
  write_record(folder_, record_);
  log(status + " after " + std::to_string(simulation.steps()) + " steps");
}

void RunLog::fail(const std::string& status, const std::string& why) {
  record_["status"] = status;
  record_["error"] = why;
  try {
    write_record(folder_, record_);
    log(status + ": " + why);
  } catch (const Error&) {
    // The original error is reported; that the log cannot be written is ignored.
  }
}

}  // namespace sinew
