// SPDX-License-Identifier: GPL-3.0-or-later
// sinew-simulate: moves the bones of a scene and writes what the body does.
#include <algorithm>
#include <cctype>
#include <cstring>

#include "command/command.h"
#include "command/progress.h"
#include "command/results.h"
#include "command/command.h"
#include "command/child.h"
#include <sinew/settings/write_scene.h>
#include <sinew/settings/read_scene.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/core/system.h>
#include <sinew/run/run_log.h>
#include <sinew/run/frame_writer.h>
#include <sinew/run/run_folder.h>
#include <sinew/run/run_checkpoints.h>
#include <sinew/run/run_record.h>
#include <sinew/io/single_files.h>
#include <sinew/io/view_script.h>
#include <sinew/scene/body.h>
#include <sinew/scene/check.h>
#include <sinew/scene/setup.h>

namespace {

using namespace sinew;

/// Whether there is anything to do; refuses to overwrite a run unasked.
bool may_begin(const RunFolder& folder, const RunOptions& options, const Common& common) {
  if (!folder.used()) refuse_foreign_files(folder);
  if (!folder.used()) return true;
  const std::string status = status_of(folder);
  if (options.force) return true;
  if (!options.resume)
    throw bad_input(Place{folder.path.string()}, "holds a run already",
                    "replace it with --force, or choose another folder with -o");
  if (status == "finished") {
    say(common, "the run in " + folder.path.string() + " is finished already");
    return false;
  }
  return true;
}

/// All that is known before the first step.
struct Prepared {
  Surface surface;
  BodyFile body;
  Setup setup;
  double seconds_filling = 0, seconds_binding = 0;
};

Prepared prepare(const Settings& settings, const RunFolder& folder) {
  Stopwatch watch;
  Prepared made;
  made.surface = read_mesh(settings);
  const std::string origin = origin_of(settings);
  auto there = body_of_scene(folder.body(), origin);
  if (!there && !folder.used() && std::filesystem::exists(folder.body()))
    throw bad_input(Place{folder.body().string()}, "is there, and not the body of this scene",
                    "choose another folder with -o, or move the file away");
  made.body = there ? *std::move(there) : body_file(fill_body(settings, made.surface), origin);
  made.seconds_filling = watch.lap();
  made.setup = set_up(settings, made.body.particles);
  made.body.bone = bones_of_particles(made.setup.body);
  made.body.weight = weights_of_particles(made.setup.body);
  made.seconds_binding = watch.lap();
  const Triangles& skin = made.surface.triangles;
  check_space(folder.path, needs_of(settings, made.setup, skin.points.size(), skin.faces.size()),
              size_of_old_run(folder));
  return made;
}

void write_beginning(const Settings& settings, const Prepared& made, const RunFolder& folder) {
  write_body(folder.body(), made.body, settings.output.encoding);
  write_file(folder.scene(), resolved_scene(settings, folder.path));
  write_view_script(folder.path);
}

/// How the run goes on through time.
struct Course {
  int frames = 0;  ///< after the first
  int steps_per_frame = 0;
  double interval = 0;  ///< s between frames
  int there = 0;        ///< frames that are recorded already

  std::vector<double> times_there() const {
    std::vector<double> times;
    for (int frame = 0; frame < there; ++frame) times.push_back(frame * interval);
    return times;
  }
};

void save(const Simulation& simulation, RunCheckpoints& run_checkpoints, FrameWriter& frame_writer, RunLog& run_log) {
  run_checkpoints.save(simulation, frame_writer);
  run_log.checkpoint(simulation.steps());
}

/// Steps to the end; stops after any step. A checkpoint comes after the frame of its moment.
Exit step_through(Simulation& simulation, const Course& course, FrameWriter& frame_writer,
                  RunLog& run_log, RunCheckpoints& run_checkpoints, Progress& progress) {
  Stopwatch watch;
  const std::int64_t begun = simulation.steps();
  for (int frame = course.there;; simulation.step()) {
    if (simulation.steps() == std::int64_t{frame} * course.steps_per_frame) {
      const double time = frame * course.interval;
      run_log.spend("stepping", watch.lap());
      frame_writer.add(simulation, time);
      run_log.frame(frame, time);
      run_log.spend("writing", watch.lap());  // what the stepping waited for it
      progress.frame(frame++, time, simulation.steps(), frame_writer.waited());
    }
    if (frame > course.frames) return Exit::done;
    // However little time there is, a run that is resumed again and again comes to its end.
    const bool stop = stop_asked() || (run_checkpoints.out_of_time() && simulation.steps() > begun);
    if (!stop && !run_checkpoints.due()) continue;
    run_log.spend("stepping", watch.lap());
    save(simulation, run_checkpoints, frame_writer, run_log);
    run_log.spend("writing", watch.lap());
    if (stop) return Exit::interrupted;
  }
}

/// Waits for the frames that are still being written.
void close(FrameWriter& frame_writer, RunLog& run_log) {
  Stopwatch watch;
  frame_writer.close();
  run_log.spend("writing", watch.lap());
}

/// The last sound state of an unstable run, with those who failed after it.
void write_last_state(const Simulation& simulation, const std::filesystem::path& path) {
  const Body& body = simulation.body();
  const Particles& before = simulation.particles();
  std::vector<Offence> offence(before.size(), Offence::none);
  std::vector<double> moved(before.size());
  for (const Offender& one : simulation.offenders()) {
    const auto id = static_cast<std::size_t>(before.id[one.particle]);
    offence[id] = one.finite ? Offence::too_fast : Offence::not_finite;
    moved[id] = one.moved / before.radius;
  }
  const auto bone = bones_of_particles(body);
  write_blowup(path, {before, body.rest, bone, offence, moved},
               {simulation.time(), static_cast<std::int32_t>(simulation.steps())});
}

/// Frames up to a state; one that lies after the end is not of this run.
int frames_until(const SimulationState& state, const Course& course) {
  const std::int64_t last = std::int64_t{course.frames} * course.steps_per_frame;
  if (state.steps > last)
    throw bad_input("the checkpoint is of step " + std::to_string(state.steps) +
                        ", and the run ends with step " + std::to_string(last),
                    "begin again with --force");
  return static_cast<int>(state.steps / course.steps_per_frame + 1);
}

/// Steps through and closes the series; the good frames of an unstable run too.
Exit record_run(Simulation& simulation, const Course& course, FrameWriter& frame_writer, RunLog& run_log,
                RunCheckpoints& run_checkpoints, const RunFolder& folder, const Common& common) {
  try {
    Progress progress(course.frames, progress_style(common.quiet));
    const Exit exit = step_through(simulation, course, frame_writer, run_log, run_checkpoints, progress);
    close(frame_writer, run_log);
    return exit;
  } catch (const Error& error) {
    run_log.frames(frame_writer.written());
    if (error.exit() != Exit::unstable) throw;
    close(frame_writer, run_log);
    run_log.frames(frame_writer.written());
    write_last_state(simulation, folder.blowup());
    say(common, "the body before the step that failed is in " + folder.blowup().string());
    throw;
  } catch (...) {
    run_log.frames(frame_writer.written());
    throw;
  }
}

Exit run_to_end(const Settings& settings, Prepared made, const RunFolder& folder, RunLog& run_log,
                RunCheckpoints& run_checkpoints, const std::optional<SimulationState>& state,
                const Common& common) {
  try {
    Stopwatch watch;
    if (!state) write_beginning(settings, made, folder);
    run_log.spend("writing", watch.lap());
    Course course{made.setup.frames, made.setup.steps.per_frame, settings.output.interval};
    std::vector<Triangles> obstacles = std::move(made.setup.obstacles);
    Simulation simulation = start(settings, std::move(made.setup), std::move(made.body.particles));
    made.body = {};  // millions of numbers that nobody needs any more
    if (state) {
      simulation.restore(*state);
      course.there = frames_until(*state, course);
      run_log.frames(course.there);
    }
    FrameWriter frame_writer(folder.path, settings.output, simulation.body(), made.surface.triangles,
                      std::move(obstacles), course.times_there());
    simulation.forces();  // finds the first partners: no part of what writing costs
    run_log.spend("binding", watch.lap());
    const Exit exit = record_run(simulation, course, frame_writer, run_log, run_checkpoints, folder, common);
    run_log.end(exit == Exit::done ? "finished" : "stopped", simulation);
    return exit;
  } catch (const Error& error) {
    run_log.fail(error.exit() == Exit::unstable ? "unstable" : "failed", error.what());
    throw;
  } catch (const std::exception& error) {
    run_log.fail("failed", error.what());
    throw;
  }
}

void print_results(const RunFolder& folder, const RunLog& run_log, bool as_json) {
  const auto& record = run_log.record();
  Results results;
  results.add("folder", folder.path.string());
  for (const char* key : {"status", "particles", "frames", "steps", "time_step", "time_step_limit",
                          "time_step_factor", "precision", "neighbor_search", "instruction_set",
                          "particle_steps_per_second", "state_hash"})
    results.add(key, record[key]);
  results.print(as_json);
}

/// As a shell takes it for one word.
std::string shell_word(const std::string& text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || std::strchr("_./=,:+-", c); };
  if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + '\'';
}

/// The command that goes on with this run.
std::string resume_words(const RunOptions& options, const Common& common, const RunFolder& folder) {
  std::string words = "sinew " + options.asked_of + ' ' + shell_word(options.scene);
  for (const Override& one : common.overrides)
    if (one.path != "solver.wall_time") words += " --set " + shell_word(one.path + '=' + one.value);
  return words + " -o " + shell_word(folder.path.string()) + " --resume";
}

/// The state to go on with, when that is asked for and there is one.
std::optional<SimulationState> state_to_resume(const RunFolder& folder, const RunOptions& options,
                                               const RunIdentity& run, RunCheckpoints& run_checkpoints,
                                               const Common& common) {
  if (!options.resume || !folder.used()) return std::nullopt;
  std::string complaint;
  auto state = run_checkpoints.resume(run, complaint);
  if (!complaint.empty()) say(common, "passed over: " + complaint);
  say(common, state ? "going on from step " + std::to_string(state->steps)
                    : "no checkpoint in " + folder.path.string() + ": beginning again");
  return state;
}

Exit simulate(int argc, char** argv, const RunOptions& options, const Common& common) {
  const Settings settings = read_scene(options.scene, common.overrides);
  const RunFolder folder = run_folder(options.scene, options.folder);
  create(folder);
  const FolderLock lock(folder);
  if (!lock.left_by().empty())
    say(common, "taking over from " + lock.left_by() + ", which ended without a word");
  if (!may_begin(folder, options, common)) return Exit::done;

  const std::string resolved = resolved_scene(settings, folder.path);
  if (options.resume && folder.used()) check_same_scene(folder, resolved);
  Prepared made = prepare(settings, folder);
  RunCheckpoints run_checkpoints(folder, settings);
  const RunIdentity run = identity_of(resolved, made.setup, made.surface.triangles);
  const auto state = state_to_resume(folder, options, run, run_checkpoints, common);
  if (!state) remove_old_run(folder);
  run_checkpoints.keep_for(run);
  RunLog run_log(folder, argc, argv, state.has_value());
  run_log.spend("filling", made.seconds_filling);
  run_log.spend("binding", made.seconds_binding);
  run_log.describe(settings, made.setup);
  say(common, "step " + three_digits(made.setup.steps.step) + " s, " +
                  three_digits(made.setup.steps.factor()) + " of the stability limit " +
                  three_digits(made.setup.steps.limit) + " s");

  for (const std::string& warning :
       warnings_of(made.setup, settings.solver, bone_speed(made.setup, settings.output.interval)))
    say(common, "sinew: warning: " + warning);

  catch_stop_signals();
  const Exit exit = run_to_end(settings, std::move(made), folder, run_log, run_checkpoints, state, common);
  print_results(folder, run_log, common.json);
  if (exit == Exit::interrupted)
    say(common, "sinew: stopped; go on with: " + resume_words(options, common, folder));
  return exit;
}

}  // namespace

int main(int argc, char** argv) {
  RunOptions options;
  return run_command(
      argc, argv,
      {"simulate",
       "Moves the bones of a scene and writes the motion of the body.",
       {"sinew simulate configs/box_bend.yaml",
        "sinew simulate configs/box_bend.yaml -o /tmp/soft --set material.young_modulus=5000"}},
      [&](CLI::App& app) { declare(app, options); },
      [&](const Common& common) { return simulate(argc, argv, options, common); });
}
