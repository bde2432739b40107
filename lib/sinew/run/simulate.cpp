// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/simulate.h>

#include <exception>
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/core/arrays.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/io/paraview/view_state.h>
#include <sinew/run/detail/run_checkpoints.h>
#include <sinew/run/detail/run_log.h>
#include <sinew/run/frame_writer.h>
#include <sinew/run/run_record.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/check/warnings.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/prepare.h>
#include <sinew/scene/rig.h>
#include <sinew/settings/read_scene.h>
#include <sinew/settings/write_scene.h>
#include <sinew/stepping/frame_guard.h>

namespace sinew {
namespace {

void say(const SimulateOptions& options, const std::string& line) {
  if (options.message) options.message(line);
}

void warn(const std::string& what, const SimulateOptions& options, RunLog& log) {
  log.warn(what);
  if (options.warning) options.warning(what);
}

/// Whether the run that is in the folder is to be continued. Refuses to overwrite one unasked.
bool resumes(const RunFolder& folder, const SimulateOptions& options) {
  if (!folder.used() || options.force) return false;
  if (!options.resume)
    throw bad_input(Place{folder.path.string()}, "holds a run already",
                    "replace it with --force, or choose another folder with -o");
  return true;
}

/// How the run advances through time.
struct Schedule {
  FrameTimes frames;
  StepPlan plan;
  bool relaxes = false;  ///< steps are iterations, as many as each frame takes
  int there = 0;         ///< frames that are written already

  std::vector<double> times_there() const {
    std::vector<double> times;
    times.reserve(static_cast<std::size_t>(there));
    for (int frame = 0; frame < there; ++frame) times.push_back(frames.at(frame));
    return times;
  }

  /// Frames up to a state; one that lies after the end is not of this run.
  int frames_until(const SimulationState& state) const {
    const StepPlan made = plan_with(plan, guard_in(state));
    const std::int64_t moments = relaxation_in(state).at_rest;
    if (relaxes && (moments < 0 || moments > frames.count + 1))
      throw bad_input("the checkpoint is of load step " + std::to_string(moments) +
                          ", and the run ends with " + std::to_string(frames.count),
                      "begin again with --force");
    if (relaxes) return static_cast<int>(moments);
    const std::int64_t last = made.steps_until(frames.count);
    if (state.steps > last)
      throw bad_input("the checkpoint is of step " + std::to_string(state.steps) +
                          ", and the run ends with step " + std::to_string(last),
                      "begin again with --force");
    return made.intervals_begun(state.steps + 1);
  }
};

/// The last sound state of an unstable run, with the particles that failed after it.
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

const char* status_after(Exit exit) {
  if (exit == Exit::interrupted) return "stopped";
  return exit == Exit::unstable ? "unstable" : "failed";
}

/// One run while it goes on: what is stepped, and who writes of it.
class Run {
 public:
  Run(const Settings& scene, const RunFolder& folder, const SimulateOptions& options, RunLog& log,
      RunCheckpoints& checkpoints)
      : scene_(scene), folder_(folder), options_(options), log_(log), checkpoints_(checkpoints) {}

  /// Steps to the end, from `state` on where there is one.
  Exit to_end(Prepared prepared, const std::optional<SimulationState>& state) {
    try {
      Stopwatch watch;
      if (!state) write_beginning(prepared);
      log_.spend("writing", watch.lap());
      begin(std::move(prepared), state, watch);
      log_.spend("listing", watch.lap());
      const Exit exit = write_frames();
      log_.end(exit == Exit::done ? "finished" : "stopped", *simulation_);
      return exit;
    } catch (const Error& error) {
      log_.fail(status_after(error.exit()), error.what());
      throw;
    } catch (const std::exception& error) {
      log_.fail("failed", error.what());
      throw;
    }
  }

 private:
  void write_beginning(const Prepared& prepared) {
    write_body(folder_.body(), prepared.filled, scene_.output.encoding);
    write_mesh_files(scene_);
    write_file(folder_.scene(), resolved_scene(scene_, folder_.path));
  }

  void begin(Prepared prepared, const std::optional<SimulationState>& state, Stopwatch& watch) {
    schedule_ = {prepared.frames, prepared.plan, prepared.load_steps.has_value()};
    const StepChoice steps = prepared.steps;
    const Motion motion = prepared.motion;
    std::optional<VolumeCells> cells = cells_to_write(prepared);
    if (cells)
      if (const auto lost = lost_by_cells(*cells, prepared.filled.particles,
                                          prepared.settings.material.density, prepared.surface))
        warn(*lost);
    FrameScene around{std::move(prepared.surface.triangles),
                      std::move(prepared.obstacles),
                      std::move(prepared.look),
                      std::move(prepared.probes),
                      prepared.body.neighbors,
                      std::move(cells)};
    if (state) prepared.beginning = {};  // it is at another moment
    const bool posed = prepared.beginning.posed;
    simulation_.emplace(start(std::move(prepared), [&](std::int64_t iterations, double residual) {
      if (asked_to_stop(false))
        throw Error(Exit::interrupted,
                    "stopped before the first frame; give the same command and --resume");
      if (options_.progress)
        options_.progress({0, schedule_.frames.count, 0, 0, 0, iterations, residual});
    }));
    if (posed) log_.spend("relaxing", watch.lap());
    prepared = Prepared();  // millions of numbers that nobody needs any more
    if (!schedule_.relaxes && !options_.engine) watch_frames();
    if (state) {
      schedule_.there = schedule_.frames_until(*state);
      if (guard_)
        guard_->restore(*state, schedule_.there);
      else
        simulation_->restore(*state);
      log_.frames(schedule_.there);
    }
    writer_.emplace(folder_.path, scene_.output, simulation_->body(), std::move(around),
                    schedule_.times_there(),
                    ranks_write() ? StrainInFrames::on_request : StrainInFrames::by_default);
    if (options_.engine)
      elsewhere_.emplace(*options_.engine, folder_.engine(), *simulation_, motion,
                         stepping_of(scene_.solver, steps.step), schedule_.plan, steps.per_frame,
                         schedule_.frames.count, pieces());
    simulation_->forces();     // finds the first neighbors: no part of what writing costs
    give_back_freed_memory();  // much more than stepping needs
  }

  /// Frames in which steps fail are taken anew. Engines stop there.
  void watch_frames() {
    guard_.emplace(*simulation_, schedule_.plan);
    guard_->on_retake = [this](const Retake& why) { log_.retake(why); };
  }

  bool ranks_write() const {
    return options_.engine && options_.engine->ranks > 1 && !options_.engine->gathers &&
           scene_.output.encoding != Encoding::raw;
  }

  /// Several ranks write the particles of frames themselves.
  std::optional<EnginePieces> pieces() const {
    if (!ranks_write() || !writer_->can_be_begun()) return std::nullopt;
    const OutputSettings& output = scene_.output;
    const auto arrays = frame_arrays(output.only);
    return EnginePieces{std::filesystem::absolute(folder_.path).string(),
                        output.encoding,
                        output.double_precision,
                        {arrays.begin(), arrays.end()},
                        output.every};
  }

  /// Steps through and closes the series; the sound frames of an unstable run too.
  Exit write_frames() {
    try {
      const Exit exit = step_through();
      close();
      return exit;
    } catch (const Error& error) {
      log_.frames(writer_->written());
      if (error.exit() != Exit::unstable) throw;
      close_after(error);
      log_.frames(writer_->written());
      if (is_unfinished()) throw;
      write_last_state(*simulation_, folder_.blowup());
      say(options_, "the body before the step that failed is in " + folder_.blowup().string());
      throw;
    } catch (...) {
      log_.frames(writer_->written());
      throw;
    }
  }

  void warn(const std::string& what) const { sinew::warn(what, options_, log_); }

  /// The reason why the run ends is not lost where closing fails as well.
  void close_after(const Error& reason) {
    try {
      if (is_unfinished()) save();
      close();
    } catch (const std::exception& failed) {
      warn(failed.what());
      throw reason;
    }
  }

  /// Whether a relaxation was given up that can go on: no step of it failed.
  bool is_unfinished() const {
    return simulation_->relaxation() != nullptr && simulation_->offenders().empty();
  }

  /// Stops after any step. A checkpoint comes after the frame of its moment.
  Exit step_through() {
    Stopwatch watch;
    bool has_stepped = false;
    for (int frame = schedule_.there;; advance(), has_stepped = true) {
      if (is_there(frame)) {
        log_.spend("stepping", watch.lap());
        add_frame(frame);
        log_.spend("writing", watch.lap());  // what the stepping waited for it
        report(frame++);
        if (guard_ && frame <= schedule_.frames.count) guard_->begin(frame);
      }
      if (frame > schedule_.frames.count) return Exit::done;
      report_iterations(frame);
      const bool stop = asked_to_stop(has_stepped);
      if (!stop && !checkpoints_.due()) continue;
      log_.spend("stepping", watch.lap());
      save();
      log_.spend("writing", watch.lap());
      if (stop) return Exit::interrupted;
    }
  }

  /// Whether the simulation has come to the moment of a frame.
  bool is_there(int frame) const {
    if (const Relaxation* relaxation = simulation_->relaxation())
      return relaxation->moments() > frame;
    if (guard_ && frame > 0) return guard_->is_there();
    return simulation_->steps() == schedule_.plan.steps_until(frame);
  }

  /// However little time there is, a run that is resumed again and again comes to its end.
  bool asked_to_stop(bool has_stepped) const {
    const bool asked = options_.stop_requested && options_.stop_requested();
    return asked || (has_stepped && checkpoints_.out_of_time());
  }

  void advance() {
    if (guard_) return guard_->step();
    if (!elsewhere_) return simulation_->step();
    elsewhere_->advance(*simulation_, [this] {
      if (asked_to_stop(true)) return Interruption::stop;
      return checkpoints_.due() ? Interruption::state : Interruption::none;
    });
  }

  void add_frame(int frame) {
    const double time = schedule_.frames.at(frame);
    const Unbalanced unbalanced = simulation_->unbalanced();
    const bool moved = elsewhere_ && elsewhere_->moment().steps == simulation_->steps();
    writer_->add(*simulation_, time, moved && elsewhere_->moment().in_frame);
    log_.frame(frame, time);
    if (frame == 0)  // a run may end at any moment: the state is there from the first frame on
      writer_->then([this] { return [this] { write_state(); }; });
    if (const Relaxation* relaxation = simulation_->relaxation()) {
      log_.load_step(frame, relaxation->last(), unbalanced);
      warn_of_unbalanced(relaxation->last(), unbalanced, time);
      if (relaxation->last().inverted > inverted_.particles)
        inverted_ = {relaxation->last().inverted, time};
      if (relaxation->last().unstable > 0 && !buckles_at_) buckles_at_ = time;
    }
  }

  /// Once: what is wrong in one frame may be in all.
  void warn_of_unbalanced(const Equilibrium& found, const Unbalanced& left, double time) {
    constexpr double slack = 10;
    const double arm = bounds(simulation_->body().rest).sizes().maxCoeff();
    const double least = slack * found.tolerance;
    if (unbalanced_ || (left.force <= least && left.moment <= least * arm)) return;
    unbalanced_ = true;
    warn("at " + three_digits(time) + " s the forces on the body sum to " +
         quantity_text(left.force, "N") + " and " + three_digits(left.moment) +
         " N m, where its equilibrium allows " + quantity_text(found.tolerance, "N") +
         ": do not trust this frame; set solver.precision to double, or make solver.residual "
         "smaller");
  }

  void warn_of_inverted() const {
    if (inverted_.particles == 0) return;
    warn("at " + three_digits(inverted_.time) + " s " + std::to_string(inverted_.particles) +
         " of " + std::to_string(simulation_->body().rest.size()) +
         " particles are inverted: this equilibrium is not to be trusted; make the load smaller, "
         "or body.radius");
  }

  void describe_retakes() {
    if (!guard_) return;
    const GuardState& guard = guard_->state();
    const LimitedSpeeds& limited = simulation_->limited();
    log_.describe(guard, limited);
    std::string what;
    if (!guard.divided.empty()) {
      int divisor = 1;
      for (std::size_t k = 1; k < guard.divided.size(); k += 2)
        divisor = std::max(divisor, guard.divided[k]);
      what = std::to_string(guard.divided.size() / 2) + " of " +
             std::to_string(schedule_.frames.count) + " frames had shorter steps, down to 1/" +
             std::to_string(divisor) +
             ", where particles moved too far or energies did not balance";
    }
    if (limited.times > 0)
      what += "; speeds were limited " + std::to_string(limited.times) + " times, which took " +
              quantity_text(limited.energy, "J") + " (array limited)";
    if (!what.empty()) say(options_, what);
  }

  /// " of load 'tip' 0.84 to 0.86 N", of each whose force grows between the moments.
  std::string loads_between(const std::array<double, 2>& times) const {
    std::string text;
    if (!simulation_->body().world) return text;
    for (const Load& load : simulation_->body().world->loads) {
      const double force = load.force.norm(), from = force * load.scale.at(times[0]),
                   to = force * load.scale.at(times[1]);
      if (from != to)
        text += ", at " + quantity_text(from, "N") + " to " + quantity_text(to, "N") + " of load " +
                shown(load.name);
    }
    return text;
  }

  void warn_of_buckling() const {
    if (!buckles_at_) return;
    const auto& between = simulation_->relaxation()->buckled();
    const std::string when = between ? "between " + three_digits((*between)[0]) + " and " +
                                           three_digits((*between)[1]) + " s" +
                                           loads_between(*between) + ", "
                                     : "before " + three_digits(*buckles_at_) + " s ";
    warn(when +
         "the body comes to an equilibrium that is unstable, by negative pivots of its tangent: it "
         "would buckle, to a side that a small imperfection decides; put a small load to the side "
         "that is meant, or move supports by keys in place of a load to go past it");
  }

  void report(int frame) const {
    if (options_.progress)
      options_.progress({frame, schedule_.frames.count, schedule_.frames.at(frame),
                         simulation_->steps(), writer_->waited()});
  }

  void report_iterations(int frame) const {
    const Relaxation* relaxation = simulation_->relaxation();
    if (relaxation == nullptr || !options_.progress) return;
    const std::int64_t iterations = relaxation->state().iterations;
    if (iterations == 0 || iterations % 1000 != 0) return;
    options_.progress({frame, schedule_.frames.count, schedule_.frames.at(frame),
                       simulation_->steps(), writer_->waited(), iterations,
                       relaxation->residual()});
  }

  void save() {
    checkpoints_.save([this] { return guard_ ? guard_->save() : simulation_->save(); }, *writer_);
    log_.checkpoint(simulation_->steps());
  }

  /// Waits for the frames that are still being written.
  void close() {
    Stopwatch watch;
    if (elsewhere_) {
      elsewhere_->finish();
      log_.describe(*elsewhere_);
    }
    writer_->close();
    if (const ProbeTable* probes = writer_->probes())
      for (const std::string& name : probes->unknown())
        warn("probe " + shown(name) + " has no strain or stress in some frames, empty cells of " +
             "probes.csv: its particles are inverted or have too few neighbors; make the load " +
             "smaller, or place it where the body is thicker");
    if (const ProbeTable* probes = writer_->probes())
      log_.describe(probes->moduli(simulation_->body()));
    warn_of_inverted();
    warn_of_buckling();
    describe_retakes();
    if (writer_->written() > 0) write_state();
    log_.spend("writing", watch.lap());
  }

  /// Unless the user has saved another one in its place. No run fails for it, unless the disk does.
  void write_state() const {
    try {
      if (!is_foreign_state(folder_.view())) write_view_state(folder_.path, folder_.view());
    } catch (const std::exception& error) {
      const auto* known = dynamic_cast<const Error*>(&error);
      if (known != nullptr && known->exit() == Exit::not_written) throw;
      warn("view.pvsm is not written: " + std::string(error.what()));
    }
  }

  const Settings& scene_;
  const RunFolder& folder_;
  const SimulateOptions& options_;
  RunLog& log_;
  RunCheckpoints& checkpoints_;
  Schedule schedule_;
  struct {
    std::size_t particles = 0;
    double time = 0;                  ///< s
  } inverted_;                        ///< in the worst equilibrium
  std::optional<double> buckles_at_;  ///< s
  bool unbalanced_ = false;           ///< whether a warning said so
  std::optional<Simulation> simulation_;
  std::optional<FrameGuard> guard_;
  std::optional<EngineSteps> elsewhere_;
  std::optional<FrameWriter> writer_;
};

Prepared prepare_in(const Settings& scene, const RunFolder& folder) {
  const std::string origin = origin_of(scene);
  auto there = body_of_scene(folder.body(), origin);
  if (!there && !folder.used() && std::filesystem::exists(folder.body()))
    throw bad_input(Place{folder.body().string()}, "is there, and not the body of this scene",
                    "choose another folder with -o, or move the file away");
  return prepare({scene, std::move(there)});
}

/// The state to continue with, where there is one.
std::optional<SimulationState> state_to_resume(const RunFolder& folder,
                                               const SimulateOptions& options,
                                               const RunIdentity& run,
                                               RunCheckpoints& checkpoints) {
  std::string complaint;
  auto state = checkpoints.resume(run, complaint);
  if (!complaint.empty()) say(options, "passed over: " + complaint);
  say(options, state ? "going on from step " + std::to_string(state->steps)
                     : "no checkpoint in " + folder.path.string() + ": beginning again");
  return state;
}

void say_what_is_doubtful(const Prepared& prepared, const RunFolder& folder,
                          const SimulateOptions& options, RunLog& log) {
  if (const auto& relaxed = prepared.load_steps)
    say(options, "equilibria at " + std::to_string(relaxed->count) +
                     " moments, each to a residual of " + three_digits(relaxed->residual) +
                     " within " + std::to_string(relaxed->max_iterations) + " iterations of " +
                     (relaxed->solver == StaticSolver::newton ? "Newton's method" : "relaxation"));
  else
    say(options, "step " + three_digits(prepared.steps.step) + " s, " +
                     three_digits(prepared.steps.factor()) + " of the stability limit " +
                     three_digits(prepared.steps.limit) + " s");
  if (prepared.beginning.posed) say(options, prepared.beginning.why);
  if (!prepared.passing.empty())
    say(options, "flesh passes through flesh: " + intrusions_text(prepared.passing, prepared.body));
  const auto warnings = warnings_before_trials(prepared, farthest_carried(prepared));
  for (const std::string& warning : warnings) warn(warning, options, log);
  if (!warnings.empty())
    say(options, counted(warnings.size(), "warning", "warnings") + " at the end, and in " +
                     folder.log().string());
}

}  // namespace

RunResult simulate(const Settings& given, const RunFolder& folder, const SimulateOptions& options) {
  const Settings scene = with_mesh_files(with_fit(given), folder.meshes());
  if (options.engine) check_features(scene, {Feature::lammps});
  if (given.skeleton.fit != Fit::none) say(options, fit_text(scene.skeleton));
  refuse_foreign_files(folder);  // before anything is written there, a lock included
  const FolderLock lock(folder, create(folder));
  if (!lock.left_by().empty())
    say(options, "taking over from " + lock.left_by() + ", which ended without a word");
  const bool resumed = resumes(folder, options);

  const std::string resolved = readable_scene(scene, folder.scene());
  if (resumed) check_same_scene(folder, resolved);
  Prepared prepared = prepare_in(scene, folder);
  const RunIdentity identity = identity_of(resolved, prepared);
  if (resumed && status_of(folder) == "finished") {
    check_same_files(folder, identity);
    say(options, "the run in " + folder.path.string() + " is finished already");
    return {Exit::done, true, ""};
  }
  if (options.before_writing) options.before_writing();
  check_space(folder.path, needs_of(prepared), size_of_old_run(folder));
  RunCheckpoints checkpoints(folder, scene);
  std::optional<SimulationState> state;
  if (resumed) state = state_to_resume(folder, options, identity, checkpoints);
  if (!state) remove_old_run(folder);
  checkpoints.keep_for(identity);
  RunLog log(folder, options.command, state.has_value());
  log.spend("filling", prepared.seconds_filling);
  log.spend("binding", prepared.seconds_binding);
  log.describe(prepared);
  log.describe(identity);
  if (options.engine) log.describe(*options.engine);
  say_what_is_doubtful(prepared, folder, options, log);
  const Exit exit =
      Run(scene, folder, options, log, checkpoints).to_end(std::move(prepared), state);
  return {exit, false, json_text(log.record())};
}

}  // namespace sinew
