// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-simulate: moves the bones of a scene and writes what the body does.
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/core/json.h>
#include <sinew/core/text.h>
#include <sinew/run/run_record.h>
#include <sinew/run/simulate.h>
#include <sinew/scene/scene_files.h>
#include <sinew/settings/read_scene.h>

#include "command/child.h"
#include "command/command.h"
#include "command/engine_process.h"
#include "command/progress.h"
#include "command/results.h"

namespace {

using namespace sinew;

struct Options : RunOptions {
  EngineOptions engine;
};

void print_results(const RunFolder& folder, const nlohmann::ordered_json& record,
                   const Common& common) {
  Results results;
  results.add("folder", folder.path.string());
  for (const char* key : {"status", "particles", "frames", "steps", "time_step", "time_step_limit",
                          "time_step_factor", "precision", "neighbor_search", "instruction_set",
                          "particle_steps_per_second", "state_hash"})
    if (record.contains(key)) results.add(key, record[key]);
  for (const char* key : {"moduli_at_probes", "warnings"})
    if (record.contains(key)) results.add_value(key, record[key]);
  results.add_headline("status", record["status"]);
  results.add_headline("particles", std::to_string(record["particles"].get<std::int64_t>()));
  const std::string steps = std::to_string(record["steps"].get<std::int64_t>());
  results.add_headline(
      "frames",
      std::to_string(record["frames"].get<std::int64_t>()) + " (" +
          (record.contains("load_steps")
               ? steps + " iterations)"
               : steps + " steps of " + three_digits(record["time_step"].get<double>()) + " s)"));
  for (const auto& entry : record.value("moduli_at_probes", nlohmann::ordered_json::array()))
    results.add_headline("young_modulus at " + entry.value("probe", ""), modulus_text(entry));
  results.add_headline("folder", folder.path.string());
  results.print(common);
}

/// The command that goes on with this run.
std::string resume_words(const Options& options, const Common& common, const RunFolder& folder) {
  std::string words = "sinew " + options.invoked_as + ' ' + shell_quoted(options.scene);
  for (const std::string& word : words_of(options.engine)) words += ' ' + shell_quoted(word);
  for (const Override& one : common.overrides)
    if (one.path != "solver.wall_time")
      words += " --set " + shell_quoted(one.path + '=' + one.value);
  return words + " -o " + shell_quoted(folder.path.string()) + " --resume";
}

Exit simulate_scene(int argc, char** argv, const Options& options, const Common& common) {
  end_at_stop_signals(!common.quiet, FolderLock::release_held);
  catch_lost_reader();  // guards the first warnings, too
  refuse_mesh_as_scene(options.scene);
  const Settings settings = read_scene(options.scene, common.overrides);
  const RunFolder folder = run_folder(options.scene, options.folder);
  std::optional<Progress> progress;
  SimulateOptions how{
      options.force, options.resume, {argv, argv + argc}, engine_of(options.engine)};
  how.message = [&](const std::string& line) {
    progress.reset();
    say(common, line);
  };
  std::vector<std::string> warnings;
  how.warning = [&](const std::string& line) { warnings.push_back(line); };
  how.stop_requested = stop_requested;
  how.before_writing = catch_stop_signals;
  how.progress = [&](const RunProgress& at) {
    if (!progress) progress.emplace(at.frames, progress_style(common.quiet));
    if (at.iterations > 0)
      return progress->iterations(at.frame, at.time, at.iterations, at.residual);
    progress->frame(at.frame, at.time, at.steps, at.waited);
    if (at.frame == at.frames) progress.reset();
  };
  RunResult result;
  try {
    result = simulate(settings, folder, how);
  } catch (...) {
    progress.reset();
    if (options.invoked_as != "run") print_warnings(warnings, common);
    throw;
  }
  progress.reset();
  if (result.was_finished) return Exit::done;
  const auto record = parsed_json<nlohmann::ordered_json>(result.record);
  print_results(folder, record, common);
  if (options.invoked_as != "run") print_warnings(warnings_in(record), common);
  if (result.exit == Exit::interrupted)
    say(common, "sinew: stopped; go on with: " + resume_words(options, common, folder));
  return result.exit;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return run_command(
      argc, argv,
      {"simulate",
       "Moves the bones of a scene and writes the motion of the body.",
       {"sinew simulate configs/box_bend.yaml",
        "sinew simulate configs/box_bend.yaml -o /tmp/soft --set material.young_modulus=5000",
        "sinew simulate configs/box_bend.yaml --engine lammps --ranks 2"}},
      [&](OptionList& list) {
        declare(list, options);
        declare(list, options.engine);
      },
      [&](const Common& common) { return simulate_scene(argc, argv, options, common); });
}
