// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation that Python steps, poses and pushes.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>

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
  std::optional<Posing> posing;  ///< where set_pose() was called
  Points own_forces;
};

/// A scene's simulation, with what Python sees of it: arrays at places that stay.
class Stepped {
 public:
  Stepped(const Settings& scene, const std::shared_ptr<FilledBody>& body, bool own_forces) {
    const WithoutGil free;
    begin(body ? prepare({scene, body->file(), false}) : prepare({scene}), own_forces);
  }

  /// Asks between steps whether Ctrl-C was pressed.
  void step(std::int64_t count) {
    if (count < 0) throw bad_input("a number of steps is below 0", "give 0 or more");
    run([&] { return count-- > 0; });
  }
  void run_until(double time) {
    if (!std::isfinite(time)) throw bad_input("the time is not finite", "give seconds");
    constexpr double rounding = 1e-12;  // fraction of times, which are numbers of steps
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
    is_posed_ = true;
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

  SavedMoment save() const {
    refuse_while_stepping();
    SavedMoment saved{simulation_->save(), std::nullopt, {}};
    if (is_posed_) saved.posing = posing_;
    if (own_forces_) saved.own_forces = own_forces_->now();
    return saved;
  }
  void restore(const SavedMoment& saved) {
    refuse_while_stepping();
    simulation_->restore(saved.state);
    if (is_posed_ || saved.posing) {
      posing_ = saved.posing ? *saved.posing : *first_posing_;
      simulation_->play(posing_->motion());
      is_posed_ = saved.posing.has_value();
    }
    if (own_forces_)
      own_forces_->set(saved.own_forces.empty() ? Points(positions_.size(), Vec3::Zero())
                                                : saved.own_forces);
    time_ = simulation_->time(), steps_ = simulation_->steps();
    read_at_ = taken_at_ = -1;
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
    using Clock = std::chrono::steady_clock;
    const bool hears_signals = is_main_thread();
    const Busy busy(stepping_);
    const WithoutGil free;
    for (auto asked = Clock::now(); !leaving && goes();) {
      simulation_->step();
      time_ = simulation_->time(), steps_ = simulation_->steps();
      if (!hears_signals || Clock::now() - asked < std::chrono::milliseconds(50)) continue;
      asked = Clock::now();
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
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

  std::optional<Simulation> simulation_;
  std::optional<Posing> first_posing_, posing_;
  bool is_posed_ = false;  ///< whether set_pose() has posed it
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
  std::atomic<std::int64_t> steps_ = 0;
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
  py::class_<SavedMoment>(module, "State");
  using S = Stepped;
  const auto view = [](auto array) {
    return [array](const py::object& self) { return view_of((self.cast<S&>().*array)(), self); };
  };
  py::class_<S>(module, "Simulation")
      .def(py::init<const Settings&, const std::shared_ptr<FilledBody>&, bool>(), py::arg("scene"),
           py::arg("body") = nullptr, py::kw_only(), py::arg("own_forces") = false)
      .def("step", &S::step, py::arg("count") = 1)
      .def("run_until", &S::run_until, py::arg("time"))
      .def("set_forces", &S::set_forces, py::arg("forces"))
      .def("set_pose", &S::set_pose, py::arg("rotations"), py::arg("over") = 1.0 / 30)
      .def("energies", &S::energies)
      .def(
          "array", [](S& self, const std::string& name) { return rows_of(self.measured(name)); },
          py::arg("name"))
      .def(
          "surface_array",
          [](S& self, const std::string& name) { return rows_of(self.measured_on_surface(name)); },
          py::arg("name"))
      .def("_dataset", &S::dataset, py::arg("series"))
      .def("save", &S::save)
      .def("restore", &S::restore, py::arg("state"))
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
