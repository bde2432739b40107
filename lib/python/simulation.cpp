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
#include "without_gil.h"

namespace sinew::python {
namespace {

/// A scene's simulation, with what Python sees of it: arrays at places that stay.
class Stepped {
 public:
  Stepped(const Settings& scene, const std::shared_ptr<FilledBody>& body, bool own_forces) {
    const WithoutGil free;
    if (!body)
      begin(scene, prepare(scene), own_forces);
    else
      begin(scene, *body, own_forces);
  }

  /// Asks between steps whether Ctrl-C was pressed.
  void step(std::int64_t count) {
    if (count < 0) throw bad_input("a number of steps is below 0", "give 0 or more");
    run([&] { return count-- > 0; });
  }
  void run_until(double time) {
    constexpr double rounding = 1e-12;  // of times, which are numbers of steps
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
    if (!skin_) throw bad_input("this body has no surface", "make it from a scene with a mesh");
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

  void set_forces(const GivenPoints& given) {
    refuse_while_stepping();
    if (!pushes_)
      throw bad_input("this simulation takes no forces",
                      "make it with sinew.Simulation(scene, own_forces=True)");
    Points forces = points_of(given, "forces");
    if (forces.size() != pushes_->size())
      throw bad_input("there are " + std::to_string(forces.size()) + " forces for " +
                          std::to_string(pushes_->size()) + " particles",
                      "give one for each");
    if (!all_finite(forces)) throw bad_input("a force is not finite", "give numbers, in newtons");
    *pushes_ = std::move(forces);
  }

  /// Bones that are not named, now or before, stay as they are.
  void set_pose(const std::map<std::string, std::array<double, 4>>& rotations, double over) {
    refuse_while_stepping();
    if (!(over > 0)) throw bad_input("a pose takes no time", "give over=SECONDS, above 0");
    const Skeleton& skeleton = simulation_->body().skeleton;
    for (const auto& [name, quaternion] : rotations) check_bone(skeleton, name);
    auto target = target_;
    for (const auto& [name, quaternion] : rotations) target[name] = quaternion;
    const std::vector<LocalMotion> now = local_motions(skeleton, motion_, time());
    std::vector<TrackDefinition> tracks;
    for (std::size_t bone = 0; bone < now.size(); ++bone) {
      const std::string& name = skeleton.bones[bone].name;
      TrackDefinition track{name,
                            Interpolation::smooth,
                            "xyz",
                            {key_of(now[bone], time()), key_of(now[bone], time() + over)}};
      if (target.contains(name)) track.keys[1].quaternion = target[name];
      tracks.push_back(std::move(track));
    }
    Motion motion = played(make_motion(tracks, skeleton), {});
    simulation_->play(motion);  // which may refuse: what is remembered stays true
    motion_ = std::move(motion);
    target_ = std::move(target);
  }

 private:
  static void check_bone(const Skeleton& skeleton, const std::string& name) {
    if (std::none_of(skeleton.bones.begin(), skeleton.bones.end(),
                     [&](const Bone& bone) { return bone.name == name; }))
      throw bad_input("there is no bone '" + name + "'", "see simulation.bones");
  }

  static KeyDefinition key_of(const LocalMotion& local, double time) {
    KeyDefinition key;
    key.time = time;
    const Quat& q = local.rotation;
    key.quaternion = {q.w(), q.x(), q.y(), q.z()};
    key.twist = degrees(local.twist);
    key.translation = local.translation;
    key.stretch = local.stretch;
    return key;
  }

  [[noreturn]] static void refuse() {
    throw bad_input("another thread steps this simulation", "wait until its step() has returned");
  }
  void refuse_while_stepping() const {
    if (stepping_) refuse();
  }

  void begin(const Settings& scene, ReadyScene ready, bool own_forces) {
    faces_ = ready.surface.triangles.faces;
    skin_ =
        make_skin(ready.surface.triangles.points, ready.setup.body.rest,
                  ready.body.particles.radius, ready.setup.body.skeleton, ready.setup.body.binding);
    begin(scene, std::move(ready.setup), std::move(ready.body.particles), own_forces);
  }

  void begin(const Settings& given, const FilledBody& body, bool own_forces) {
    const Settings scene = with_fit(given);
    Particles particles = body.particles();
    Setup setup = set_up(scene, read_files(scene), particles, body.local);
    begin(scene, std::move(setup), std::move(particles), own_forces);
  }

  void begin(const Settings& scene, Setup setup, Particles particles, bool own_forces) {
    if (own_forces) {
      World world = setup.body.world ? *setup.body.world : World();
      pushes_ = std::make_shared<Points>(particles.size(), Vec3::Zero());
      const auto push = [pushes = pushes_](const Vec3&, const Grain& grain) {
        return (*pushes)[grain.id];
      };
      world.fields.push_back({"own", CustomForce{push}, {}, {}});
      setup.body.world = std::make_shared<const World>(std::move(world));
    }
    motion_ = setup.motion;
    simulation_.emplace(start(scene, std::move(setup), std::move(particles)));
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
    positions_.resize(now.size()), velocities_.resize(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      const auto id = static_cast<std::size_t>(now.id[i]);
      positions_[id] = now.position(i), velocities_[id] = now.velocity(i);
    }
    read_at_ = simulation_->steps();
    return *this;
  }

  std::optional<Simulation> simulation_;
  Motion motion_;
  std::map<std::string, std::array<double, 4>> target_;
  std::optional<Skin> skin_;
  std::vector<std::array<int, 3>> faces_;
  std::shared_ptr<Points> pushes_;
  Points positions_, velocities_, forces_, surface_;
  std::int64_t read_at_ = -1;
  std::atomic<bool> stepping_ = false;
  std::atomic<double> time_ = 0;
  std::atomic<std::int64_t> steps_ = 0;
};

}  // namespace
}  // namespace sinew::python

template <>
class pybind11::detail::type_caster<sinew::python::Stepped>
    : public pybind11::detail::made_caster<sinew::python::Stepped> {};

namespace sinew::python {

void bind_simulation(py::module_& module) {
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
