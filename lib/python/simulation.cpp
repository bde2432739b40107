// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation that Python steps, poses and pushes.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <map>

#include <sinew/core/archive.h>
#include <sinew/core/hash.h>
#include <sinew/core/text.h>
#include <sinew/io/state_archive.h>
#include <sinew/run/stepped_run.h>
#include <sinew/scene/rig.h>
#include "arrays.h"
#include "body.h"
#include "given.h"
#include "without_gil.h"

namespace sinew::python {
namespace {

/// A moment, with what Python had set until then.
struct SavedMoment {
  SimulationState state;
  std::optional<PosedTurn> posed;  ///< where set_pose() was called
  Points own_forces;
};

/// Members in memory alone included, for core/archive.h.
template <class Archive>
void serialize(Archive& archive, SavedMoment& saved) {
  archive(saved.state);
  archive(saved.state.body);
  EvenSteps& even = saved.state.even;
  archive(even.from);
  for (double* one : {&even.since, &even.step, &even.made}) archive(*one);
  archive(saved.own_forces);
  archive(saved.posed);
}

constexpr std::string_view state_mark = "sinew state\n";

std::string state_bytes(const SavedMoment& saved) {
  const std::string state = archived(std::string(version())) + archived(saved);
  Hash hash;
  hash.add(state);
  return std::string(state_mark) + archived(hash.value()) + state;
}

SavedMoment state_of_bytes(const std::string& text) {
  std::string_view bytes = text;
  const auto refused = [](const std::string& what) {
    return bad_input("the saved state " + what, "save it anew by the simulation of its scene");
  };
  if (bytes.substr(0, state_mark.size()) != state_mark) throw refused("is no state of sinew");
  bytes.remove_prefix(state_mark.size());
  Hash hash;
  hash.add(bytes.substr(std::min(bytes.size(), sizeof(std::uint64_t))));
  ArchiveReader reader(bytes);
  std::uint64_t written = 0;
  std::string by;
  SavedMoment saved;
  if (bytes.size() < sizeof written) throw refused("is truncated");
  reader(written);
  if (written != hash.value()) throw refused("is damaged");
  reader(by);
  if (by != version()) throw refused("is of sinew " + shown(by) + ", not " + version());
  reader(saved);
  if (!reader.done()) throw refused("is damaged");
  return saved;
}

/// A scene's simulation, with what Python sees of it: arrays at places that stay.
class Stepped {
 public:
  Stepped(const Settings& scene, const std::shared_ptr<FilledBody>& body, bool own_forces)
      : scene_(scene), filled_(body) {
    const WithoutGil free;
    begin(prepared(), own_forces);
  }

  /// Asks between steps whether Ctrl-C was pressed.
  void step(std::int64_t count) {
    if (count < 0) throw bad_input("a number of steps is below 0", "give 0 or more");
    run([&] { return count-- > 0; });
  }
  void run_until(double time) {
    if (!std::isfinite(time)) throw bad_input("the time is not finite", "give seconds");
    constexpr double rounding = 1e-12;  // fraction of times, which are numbers of steps
    refuse_while_stepping();
    if (time < simulation_->time() && time * (1 + rounding) <= before_)
      throw bad_input(number_text(time) + " s is past: the simulation is at " +
                          number_text(simulation_->time()) + " s",
                      "give a later time, or restore() a state that was saved before");
    run([&, end = time * (1 - rounding)] { return simulation_->time() < end; });
  }

  double time() const { return simulation_->time(); }
  /// Returns what other threads may ask for in the meantime.
  double time_told() const { return time_; }
  std::int64_t steps_told() const { return steps_; }

  const Points& positions() { return read().positions_; }
  const Points& velocities() { return read().velocities_; }
  const Points& forces() {
    refuse_while_stepping();
    const Forces& all = simulation_->forces();
    const auto& ids = simulation_->particles().id;
    forces_.resize(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
      forces_[static_cast<std::size_t>(ids[i])] = all.total(i);
    return forces_;
  }
  const Points& surface() {
    refuse_without_surface();
    const Points moved = follow(*skin_, positions());
    surface_.resize(moved.size());  // views of it stay valid
    std::copy(moved.begin(), moved.end(), surface_.begin());
    return surface_;
  }
  const std::vector<std::array<int, 3>>& faces() const { return faces_; }

  std::vector<std::string> bones() const {
    std::vector<std::string> names;
    for (const Bone& bone : simulation_->body().skeleton.bones) names.push_back(bone.name);
    return names;
  }
  std::map<std::string, double> energies() {
    refuse_while_stepping();
    const Energies e = simulation_->energies();
    return {{"kinetic", e.kinetic},       {"pair", e.pair},       {"bone", e.bone},
            {"gravity", e.gravity},       {"contact", e.contact}, {"work", e.work()},
            {"dissipated", e.dissipation}};
  }

  void set_forces(const py::object& given) {
    refuse_while_stepping();
    if (!own_forces_)
      throw bad_input("this simulation takes no forces",
                      "make it with sinew.Simulation(scene, own_forces=True)");
    own_forces_->set(points_of(given, "forces"));
  }

  void set_pose(const std::map<std::string, std::array<double, 4>>& rotations, double over) {
    refuse_while_stepping();
    BoneRotations turned;
    for (const auto& [name, q] : rotations) turned[name] = Quat(q[0], q[1], q[2], q[3]);
    Posing next = *posing_;
    next.turn(turned, time(), over);
    simulation_->play(next.motion());  // which may refuse: what is remembered stays true
    posing_ = std::move(next);
  }

  std::vector<RigidFrame> bone_frames() const {
    refuse_while_stepping();
    std::vector<RigidFrame> frames;
    for (const BonePose& bone : simulation_->pose()) frames.push_back(bone.frame);
    return frames;
  }
  /// Force and moment of the body on each bone, a row each.
  std::vector<std::array<double, 6>> reactions() {
    refuse_while_stepping();
    std::vector<std::array<double, 6>> rows;
    for (const Reaction& one : simulation_->reactions_of_bones().sums())
      rows.push_back(
          {one.force[0], one.force[1], one.force[2], one.moment[0], one.moment[1], one.moment[2]});
    return rows;
  }
  /// An array of the particles, as output.arrays names it.
  Column measured(const std::string& name) {
    const Busy busy(stepping_);  // other threads may run meanwhile
    const WithoutGil free;
    if (!meter_) {
      refuse_without_surface();
      meter_.emplace(simulation_->body(), skin_at_rest_);
    }
    std::vector<Column> found = meter_->arrays(*simulation_, name);
    if (found.size() != 1)
      throw bad_input("'" + name + "' names " + std::to_string(found.size()) + " arrays",
                      "name one, such as stress");
    return std::move(found[0]);
  }
  /// The same at the vertices of the surface.
  Column measured_on_surface(const std::string& name) {
    const Column of_particles = measured(name);
    refuse_without_surface();
    return at_vertices(*skin_, of_particles);
  }

  /// What a file of that series would hold.
  std::shared_ptr<Dataset> dataset(const std::string& series) {
    if (series == "surface") refuse_without_surface();
    const Busy busy(stepping_);
    const WithoutGil free;
    if (!frame_data_)
      frame_data_.emplace(output_, simulation_->body(), frame_scene_,
                          faces_.empty() ? StrainInFrames::on_request : StrainInFrames::by_default);
    if (taken_at_ != simulation_->steps()) frame_data_->take(*simulation_);
    taken_at_ = simulation_->steps();
    return shared(frame_data_->dataset(series));
  }

  /// Adds a frame of the present moment to the run in a folder, which the first call begins.
  int write(const std::filesystem::path& folder, bool force) {
    const Busy busy(stepping_);
    const WithoutGil free;
    if (run_ && folder != run_->folder().path)
      throw bad_input(Place{run_->folder().path.string()}, "is the run of this simulation",
                      "finish() it before another begins");
    if (!run_) {
      written_of_.emplace(prepared());
      run_.emplace(RunFolder{folder}, *written_of_, *simulation_,
                   SteppedRunOptions{force, {"sinew.Simulation.write"}});
    }
    run_->add(*simulation_);
    return run_->frames();
  }
  /// The folder of the run, which has come to its end.
  std::filesystem::path finish() {
    const Busy busy(stepping_);
    const WithoutGil free;
    if (!run_) throw bad_input("no run is being written", "begin one with write(folder)");
    std::filesystem::path folder = run_->folder().path;
    try {
      run_->end();
    } catch (const Error&) {
      run_.reset();
      throw;
    }
    run_.reset(), written_of_.reset();
    return folder;
  }

  SavedMoment save() const {
    refuse_while_stepping();
    SavedMoment saved{simulation_->save(), posing_->last(), {}};
    if (own_forces_) saved.own_forces = own_forces_->now();
    return saved;
  }
  void restore(const SavedMoment& saved) {
    refuse_while_stepping();
    simulation_->restore(saved.state);
    time_ = before_ = simulation_->time(), steps_ = simulation_->steps();
    read_at_ = taken_at_ = -1;
    Posing posing = *first_posing_;
    if (saved.posed) posing.repeat(*saved.posed);
    if (posing_->last() || saved.posed) simulation_->play(posing.motion());
    posing_ = std::move(posing);
    if (own_forces_)
      own_forces_->set(saved.own_forces.empty() ? Points(positions_.size(), Vec3::Zero())
                                                : saved.own_forces);
  }

 private:
  [[noreturn]] static void refuse() {
    throw bad_input("another thread steps this simulation", "wait until its step() has returned");
  }
  void refuse_without_surface() const {
    if (!skin_) throw bad_input("this body has no surface", "make it from a scene with a mesh");
  }
  void refuse_while_stepping() const {
    if (stepping_) refuse();
  }

  Prepared prepared() const {
    return filled_ ? prepare({scene_, filled_->file(), false}) : prepare({scene_});
  }

  void begin(Prepared prepared, bool own_forces) {
    const Body& body = prepared.body;
    faces_ = prepared.surface.triangles.faces;
    if (!faces_.empty())
      skin_ = make_skin(prepared.surface.triangles.points, body.rest,
                        prepared.filled.particles.radius, body.skeleton, body.binding);
    skin_at_rest_ = prepared.surface.triangles;
    output_ = prepared.settings.output;
    if (faces_.empty()) output_.skin = "none";  // nor is anything measured for it
    frame_scene_.surface = skin_at_rest_;
    frame_scene_.obstacles = prepared.obstacles;
    frame_scene_.neighbors = body.neighbors;
    frame_scene_.volume = cells_to_write(prepared);
    if (own_forces) {
      own_forces_.emplace(body.rest.size());
      prepared.body.world = own_forces_->added_to(body.world);
    }
    first_posing_.emplace(body.skeleton, prepared.motion);
    posing_ = first_posing_;
    simulation_.emplace(start(std::move(prepared)));
    read();
  }

  /// Until its end, of a block: other threads are refused.
  struct Busy {
    explicit Busy(std::atomic<bool>& flag) : flag_(flag) {
      if (flag_.exchange(true)) refuse();
    }
    ~Busy() { flag_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    std::atomic<bool>& flag_;
  };

  template <class Goes>
  void run(const Goes& goes) {
    Listener listener;
    const Busy busy(stepping_);
    {
      const WithoutGil free;
      while (!listener.ended() && goes()) {
        before_ = simulation_->time();
        simulation_->step();
        time_ = simulation_->time(), steps_ = simulation_->steps();
      }
    }
    listener.raise();
  }

  Stepped& read() {
    refuse_while_stepping();
    if (read_at_ == simulation_->steps()) return *this;
    const Particles& now = simulation_->particles();
    find_positions_by_id(now, positions_);
    find_velocities_by_id(now, velocities_);
    read_at_ = simulation_->steps();
    return *this;
  }

  Settings scene_;
  std::shared_ptr<FilledBody> filled_;  ///< null: what the scene says
  std::optional<Simulation> simulation_;
  std::optional<Posing> first_posing_, posing_;
  std::optional<OwnForces> own_forces_;
  std::optional<ParticleMeter> meter_;  ///< where arrays were asked for
  OutputSettings output_;
  FrameScene frame_scene_;
  std::optional<FrameData> frame_data_;  ///< where data sets were asked for
  Triangles skin_at_rest_;
  std::optional<Skin> skin_;
  std::vector<std::array<int, 3>> faces_;
  Points positions_, velocities_, forces_, surface_;
  std::int64_t read_at_ = -1, taken_at_ = -1;
  std::atomic<bool> stepping_ = false;
  std::atomic<double> time_ = 0;
  double before_ = 0;  ///< time before the last step, s
  std::atomic<std::int64_t> steps_ = 0;
  std::optional<Prepared> written_of_;  ///< start of what is written
  std::optional<SteppedRun> run_;       ///< the last member: writes of the simulation
};

}  // namespace
}  // namespace sinew::python

template <>
class pybind11::detail::type_caster<sinew::python::Stepped>
    : public pybind11::detail::made_caster<sinew::python::Stepped> {};
template <>
class pybind11::detail::type_caster<sinew::python::SavedMoment>
    : public pybind11::detail::made_caster<sinew::python::SavedMoment> {};

namespace sinew::python {

void bind_simulation(py::module_& module) {
  py::class_<SavedMoment>(module, "_State")
      .def("bytes", [](const SavedMoment& saved) { return py::bytes(state_bytes(saved)); })
      .def_property_readonly("steps", [](const SavedMoment& saved) { return saved.state.steps; });
  module.def("_state_of", &state_of_bytes);
  using S = Stepped;
  const auto view = [](auto array) {
    return [array](const py::object& self) { return view_of((self.cast<S&>().*array)(), self); };
  };
  py::class_<S>(module, "_Simulation")
      .def(py::init<const Settings&, const std::shared_ptr<FilledBody>&, bool>())
      .def("step", &S::step)
      .def("run_until", &S::run_until)
      .def("set_forces", &S::set_forces)
      .def("set_pose", &S::set_pose)
      .def("energies", &S::energies)
      .def("array", [](S& self, const std::string& name) { return rows_of(self.measured(name)); })
      .def("surface_array",
           [](S& self, const std::string& name) { return rows_of(self.measured_on_surface(name)); })
      .def("dataset", &S::dataset)
      .def("save", &S::save)
      .def("restore", &S::restore)
      .def("write", &S::write)
      .def("finish", &S::finish)
      .def_property_readonly("bone_frames",
                             [](const S& self) { return matrices(self.bone_frames()); })
      .def_property_readonly("reactions",
                             [](S& self) {
                               const auto rows = self.reactions();
                               py::array_t<double> all({rows.size(), std::size_t{6}});
                               for (std::size_t i = 0; i < rows.size(); ++i)
                                 std::copy(rows[i].begin(), rows[i].end(),
                                           all.mutable_data() + 6 * i);
                               return all;
                             })
      .def_property_readonly("time", &S::time_told)
      .def_property_readonly("steps", &S::steps_told)
      .def_property_readonly("bones", &S::bones)
      .def_property_readonly("positions", view(&S::positions))
      .def_property_readonly("velocities", view(&S::velocities))
      .def_property_readonly("forces", view(&S::forces))
      .def_property_readonly("surface", view(&S::surface))
      .def_property_readonly("faces", view(&S::faces));
}

}  // namespace sinew::python
