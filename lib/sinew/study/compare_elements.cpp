// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/study/compare_elements.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/local_origin.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/io/calculix/frd.h>
#include <sinew/metrics/element_places.h>
#include <sinew/metrics/files.h>
#include <sinew/metrics/frame_metrics.h>
#include <sinew/metrics/report/comparison_page.h>
#include <sinew/metrics/summary.h>
#include <sinew/run/machine_columns.h>
#include <sinew/run/run_files.h>
#include <sinew/run/world_shown.h>
#include <sinew/scene/element_parts.h>
#include <sinew/study/compare_runs.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr double max_outside = 0.5;  // elements: the corners of curved sides stay far below

/// The result with its nodes where the run is, relative to whose origin decks are written.
FrdResult at_run(FrdResult result, const RunFiles& run) {
  const Vec3 origin = local_origin(bounds(run.surface.points));
  // Result of another program.
  if (!local_origin(bounds(result.mesh.nodes)).isZero(0)) return result;
  for (Vec3& node : result.mesh.nodes) node += origin;
  return result;
}

/// Places of the run's body in the elements.
std::vector<ElementPlace> places_of(const FrdResult& result, const Points& points, const char* what,
                                    const fs::path& file) {
  std::vector<ElementPlace> places = places_in(result.mesh, points);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!(places[i].outside <= max_outside))
      throw bad_input(Place{file.string()},
                      std::string("is of another body: ") + what + ' ' + std::to_string(i) +
                          " of the run lies outside of its elements",
                      "give the result of this run's scene: sinew export DIR/scene.yaml --to "
                      "calculix, then ccx");
  return places;
}

struct FrameAndStep {
  std::size_t frame, step;
};

/// Frames and steps of the same time.
std::vector<FrameAndStep> pairs_of(const RunFiles& run, const FrdResult& result,
                                   const fs::path& file) {
  constexpr double slack = 1e-5;  // fraction of the time, beside a millionth of a second
  std::vector<FrameAndStep> pairs;
  for (std::size_t frame = 0; frame < run.frames(); ++frame)
    for (std::size_t step = 0; step < result.steps.size(); ++step) {
      const double time = run.particle_rows[frame].time;
      if (std::abs(result.steps[step].time - time) <= 1e-6 + slack * std::abs(time))
        pairs.push_back({frame, step});
    }
  if (pairs.empty())
    throw bad_input(Place{file.string()}, "has no step at the time of a frame of the run",
                    "let its steps end at the frames' times");
  return pairs;
}

Points field_at(const FrdResult& result, const std::vector<ElementPlace>& places,
                const Points& field) {
  Points values;
  for (const ElementPlace& place : places) values.push_back(value_at(result.mesh, place, field));
  return values;
}

double von_mises_of(const Eigen::Matrix<double, 6, 1>& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt((a * a + b * b + c * c) / 2 + 3 * s.tail<3>().squaredNorm());
}

std::vector<double> von_mises_at(const FrdResult& result, const std::vector<ElementPlace>& places,
                                 const FrdStep& step) {
  if (step.stress.empty()) return {};
  using Six = Eigen::Matrix<double, 6, 1>;
  std::vector<Six> field;
  field.reserve(step.stress.size());
  for (const StressComponents& stress : step.stress)
    field.push_back(Eigen::Map<const Six>(stress.data()));
  std::vector<double> values;
  for (const ElementPlace& place : places)
    values.push_back(von_mises_of(value_at(result.mesh, place, field)));
  return values;
}

Points moved(Points points, const Points& by) {
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += by[i];
  return points;
}

/// Nodes of the supports whose part elements have.
struct HeldNodes {
  std::string name;
  std::vector<std::uint32_t> nodes;
};

std::vector<HeldNodes> held_nodes(const Settings& settings, const VolumeMesh& mesh) {
  const ElementParts parts(settings, mesh);
  std::vector<HeldNodes> all;
  for (std::size_t k = 0; k < settings.supports.size(); ++k)
    if (const SupportSettings& one = settings.supports[k]; is_of_elements(one.part))
      all.push_back({one.name, parts.nodes(one.part, "supports[" + std::to_string(k) + ']')});
  return all;
}

/// A vector of supports.csv at each of these times; 0 where the table leaves it out.
Points vectors_of(const std::vector<MachineColumn>& columns, const std::string& name,
                  const std::vector<double>& times) {
  Points values(times.size(), Vec3::Zero());
  for (const MachineColumn& column : columns)
    for (int axis = 0; axis < 3; ++axis)
      if (column.name == name + "xyz"[axis])
        for (std::size_t k = 0; k < times.size(); ++k) {
          const std::vector<double>& all = columns.front().values;
          const auto later = std::lower_bound(all.begin(), all.end(), times[k] - 1e-9);
          if (later != all.end())
            values[k][axis] = column.values[static_cast<std::size_t>(later - all.begin())];
        }
  return values;
}

/// What is compared, with all that is made once.
class RunInElements {
 public:
  RunInElements(const fs::path& folder, const fs::path& file)
      : run_(open_run({folder})),
        rest_(rest_of(run_)),
        result_(at_run(read_frd(file), run_)),
        pairs_(pairs_of(run_, result_, file)),
        particles_(places_of(result_, rest_.shape.points, "particle", file)),
        surface_(places_of(result_, run_.surface.points, "point of the surface", file)),
        probes_(probes_of_run(run_)),
        held_(held_nodes(run_.settings, result_.mesh)) {
    out_.name = file.filename().string();
    out_.elements = result_.mesh.elements.size();
    out_.nodes = result_.mesh.nodes.size();
    out_.particles = rest_.shape.points.size();
    for (const Probe& probe : probes_) out_.probes.push_back({probe.name, {}, {}});
    for (const HeldNodes& held : held_) out_.supports.push_back({held.name, {}, {}, {}, {}});
    for (Playback* one : {&elements_playback_, &run_playback_})
      *one = plan_playback(rest_, pairs_.size(), 0.5);
  }

  ElementComparison compare(const MeasureOptions& how) {
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      add(k);
      if (how.progress) how.progress(k + 1, pairs_.size());
    }
    show_world(run_playback_, run_, [&](std::size_t k) { return pairs_[k].frame; });
    finish(how);
    return std::move(out_);
  }

  std::string page(const ElementComparison& compared) const {
    const Playback both = side_by_side(elements_playback_, run_playback_, {"a: ", "b: "});
    return comparison_html({version(),
                            compared.metrics,
                            both,
                            {},
                            "",
                            run_.scene_text,
                            element_charts(compared),
                            element_curves(compared)});
  }

 private:
  void add(std::size_t k) {
    const FrdStep& step = result_.steps[pairs_[k].step];
    const FrameState state = read_frame(run_, pairs_[k].frame);
    const FrameState elements = moved_by_elements(state, step);
    MeasuredFrame one = measured(elements, k, elements_playback_);
    MeasuredFrame other = measured(state, k, run_playback_);
    forget_what_elements_have_not(one.metrics);
    ElementFrame frame = distances(state, elements);
    frame.von_mises_95_elements = one.metrics.von_mises_95;
    frame.von_mises_95 = other.metrics.von_mises_95;
    other.metrics.reference_particles_rms = frame.rms;
    other.metrics.reference_particles_max = frame.max;
    out_.frames.push_back(frame);
    elements_frames_.push_back(one.metrics);
    run_frames_.push_back(other.metrics);
    add_probes(state, elements);
    add_supports(step);
  }

  /// The run's body where the elements put it.
  FrameState moved_by_elements(FrameState state, const FrdStep& step) const {
    state.positions = moved(rest_.shape.points, field_at(result_, particles_, step.displacement));
    state.surface_points =
        moved(run_.surface.points, field_at(result_, surface_, step.displacement));
    state.velocities.assign(state.velocities.size(), Vec3::Zero());
    state.von_mises = von_mises_at(result_, particles_, step);
    return state;
  }

  MeasuredFrame measured(const FrameState& state, std::size_t k, Playback& playback) const {
    MeasuredFrame frame = measure_frame(rest_, state);
    if (playback.wants(k)) add_frame(playback, k, rest_, state, frame.particles);
    return frame;
  }

  static void forget_what_elements_have_not(FrameMetrics& metrics) {
    using M = FrameMetrics;
    for (const auto value : {&M::kinetic_energy, &M::pair_energy, &M::bone_energy,
                             &M::gravity_energy, &M::work_of_bones, &M::dissipation,
                             &M::contact_energy, &M::work_of_world, &M::energy_residual})
      metrics.*value = not_measured;
  }

  ElementFrame distances(const FrameState& state, const FrameState& elements) const {
    const Points& rest = rest_.shape.points;
    const auto of = [&](const Points& one, const Points& other) {
      return statistics(rest.size(), [&](std::size_t i) { return (one[i] - other[i]).norm(); });
    };
    const Statistics apart = of(state.positions, elements.positions);
    ElementFrame frame;
    frame.time = state.time;
    frame.largest_elements = of(elements.positions, rest).max();
    frame.largest = of(state.positions, rest).max();
    frame.rms = apart.rms();
    frame.max = apart.max();
    frame.rms_relative = frame.rms / frame.largest_elements;
    frame.max_relative = frame.max / frame.largest_elements;
    for (std::size_t i = 0; i < rest.size(); ++i)
      if ((state.positions[i] - elements.positions[i]).norm() == apart.max())
        frame.worst_particle = run_.ids.empty() ? static_cast<double>(i) : run_.ids[i];
    return frame;
  }

  void add_probes(const FrameState& state, const FrameState& elements) {
    for (std::size_t p = 0; p < probes_.size(); ++p) {
      Vec3 by_elements = Vec3::Zero(), in_run = Vec3::Zero();
      for (std::size_t n = 0; n < probes_[p].particles.size(); ++n) {
        const std::size_t i = probes_[p].particles[n];
        by_elements += probes_[p].weight[n] * (elements.positions[i] - rest_.shape.points[i]);
        in_run += probes_[p].weight[n] * (state.positions[i] - rest_.shape.points[i]);
      }
      out_.probes[p].elements.push_back(by_elements);
      out_.probes[p].run.push_back(in_run);
    }
  }

  void add_supports(const FrdStep& step) {
    for (std::size_t s = 0; s < held_.size(); ++s) {
      Vec3 force = Vec3::Zero(), moved = Vec3::Zero();
      for (const std::uint32_t node : held_[s].nodes) {
        if (!step.force.empty()) force += step.force[node];
        moved += step.displacement[node] / static_cast<double>(held_[s].nodes.size());
      }
      out_.supports[s].elements_force.push_back(force);
      out_.supports[s].elements_displacement.push_back(moved);
    }
  }

  void add_supports_of_run() {
    const std::vector<MachineColumn> columns = machine_columns(run_.folder.path);
    std::vector<double> times;
    for (const ElementFrame& frame : out_.frames) times.push_back(frame.time);
    for (ComparedSupport& support : out_.supports) {
      support.run_force = vectors_of(columns, support.name + ": force_", times);
      support.run_displacement = vectors_of(columns, support.name + ": displacement_", times);
    }
  }

  void finish(const MeasureOptions& how) {
    add_supports_of_run();
    const double radius = rest_.radius();
    RunComparison& metrics = out_.metrics;
    metrics = sinew::compare({out_.name, elements_frames_, summarize(elements_frames_, radius),
                              radius, rest_.particles()},
                             {name_of_run(run_.folder.path), run_frames_,
                              summarize(run_frames_, radius), radius, rest_.particles()});
    metrics.remarks.push_back("a is the body of " + metrics.second.name +
                              ", each particle and point of the surface moved as " + out_.name +
                              " says (" + std::to_string(out_.elements) + " elements, " +
                              std::to_string(out_.nodes) +
                              " nodes); its stress is that of the elements.");
    for (const Limit& limit : how.limits)
      metrics.checks.push_back(check_limit(limit, metrics.differences, metrics.summary));
  }

  RunFiles run_;
  RestBody rest_;
  FrdResult result_;
  std::vector<FrameAndStep> pairs_;
  std::vector<ElementPlace> particles_, surface_;
  std::vector<Probe> probes_;
  std::vector<HeldNodes> held_;
  std::vector<FrameMetrics> elements_frames_, run_frames_;
  Playback elements_playback_, run_playback_;
  ElementComparison out_;
};

}  // namespace

std::span<const ElementColumn> element_columns() {
  using F = ElementFrame;
  static constexpr ElementColumn columns[] = {
      {"time", "s", "Time", &F::time},
      {"largest_elements", "m", "Largest displacement by the elements at the particles",
       &F::largest_elements},
      {"largest", "m", "Largest displacement of a particle", &F::largest},
      {"rms", "m", "Distance of particles from where the elements put them, rms", &F::rms},
      {"max", "m", "The same, largest", &F::max},
      {"rms_relative", "", "rms over largest_elements", &F::rms_relative},
      {"max_relative", "", "max over largest_elements", &F::max_relative},
      {"worst_particle", "", "The particle that is farthest off", &F::worst_particle},
      {"von_mises_95_elements", "Pa",
       "Von Mises stress of the elements that 95 % of the particles do not exceed",
       &F::von_mises_95_elements},
      {"von_mises_95", "Pa", "The same of the run", &F::von_mises_95},
  };
  return columns;
}

ElementComparison compare_elements(const fs::path& run, const fs::path& result,
                                   const MeasureOptions& how, const fs::path& out) {
  refuse_folders_of_runs(out, {run});
  RunInElements comparison(run, result);
  ElementComparison compared = comparison.compare(how);
  create_folder(out);
  write_file(out / "reference.csv", reference_csv(compared));
  write_file(out / "reference.json", reference_json(compared));
  write_file(out / "compare.csv", comparison_csv(compared.metrics));
  write_file(out / "metrics.json", comparison_json(compared.metrics));
  write_file(out / "report.html", comparison.page(compared));
  return compared;
}

}  // namespace sinew
