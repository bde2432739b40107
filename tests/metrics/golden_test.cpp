// SPDX-License-Identifier: GPL-3.0-or-later
// A small body goes through everything that is measured of bodies; what comes of it, numbers and
// pages, is compared with the files in golden/.
#include <gtest/gtest.h>

#include <regex>

#include <sinew/core/arrays.h>
#include <sinew/metrics/bone_metrics.h>
#include <sinew/metrics/files.h>
#include <sinew/metrics/particle_values.h>
#include <sinew/metrics/report/comparison_page.h>
#include <sinew/metrics/report/page.h>
#include <sinew/metrics/report/report.h>
#include <sinew/metrics/summary.h>
#include "metrics/world.h"
#include "support/golden.h"

namespace sinew::test::golden_test {

/// Between -1 and 1, without pattern, the same every time.
double chance(std::size_t i) {
  return static_cast<double>((i + 1) * 2654435761u % 10007) / 5003 - 1;
}

Vec3 jitter(std::size_t i) { return {chance(3 * i), chance(3 * i + 1), chance(3 * i + 2)}; }

/// About x by the angle whose half has this tangent: no function of the C library rounds here.
Mat3 tilted(double tangent) {
  const double c = (1 - tangent * tangent) / (1 + tangent * tangent);
  const double s = 2 * tangent / (1 + tangent * tangent);
  return (Mat3() << 1, 0, 0, 0, c, -s, 0, s, c).finished();
}

RestInput lively_input() {
  RestInput input = box_input();
  for (std::size_t i = 0; i < input.positions.size(); ++i) {
    input.positions[i] += 0.02 * r * jitter(i);
    input.weight.push_back(0.75 + 0.25 * chance(i));
  }
  input.bone[7] = -1;
  input.material.mass = 0.004;
  input.start.kinetic = 0.25;
  input.start.pair = 1.5;
  static const ForceLaw law = [] {
    ForceLaw made = law_of_springs(
        [](const Material&, double d) { return 40 * (2 * r - d) / r; },
        [](const Material&, double d) { return 20 * (2 * r - d) * (2 * r - d) / r; });
    made.bond_force = [](const Material&, const BondSpring& bond, double d) {
      return 70 * (bond.length - d) / r;
    };
    made.bond_energy = [](const Material&, const BondSpring& bond, double d) {
      return 35 * (bond.length - d) * (bond.length - d) / r;
    };
    return made;
  }();
  obey(input, law);
  keep_volumes(input, 2e4);
  return input;
}

/// The upper half tilts and bulges with `tangent`, the lower is pinched; everything shakes by
/// `shake`.
FrameState lively_state(const RestBody& body, double time, double tangent, double shake) {
  const Vec3 joint(0, 0, half_length);
  const auto way = [&](const Vec3& point) -> Vec3 {
    const double up = (point.z() - half_length) / half_length, more = std::max(0.0, up);
    const double wide = 1 + tangent * (up > 0 ? 0.5 * up : 0.7 * up * (1 + up));
    const Vec3 place(wide * point.x(), wide * point.y() + 0.1 * tangent * point.x(), point.z());
    return joint + tilted(tangent * more) * (place - joint);
  };
  FrameState state = moved(body, way);
  state.time = time;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    state.positions[i] += shake * r * jitter(i + 31);
    state.velocities[i] = tangent * jitter(i + 7) + Vec3(0.1, -0.2, 0.3 * shake);
    state.broken_bonds.push_back(i % 5 == 0 ? static_cast<std::int32_t>(7.5 * tangent) : 0);
  }
  const Mat3 turn = tilted(tangent);
  state.bones[1].rotation = turn * state.bones[1].rotation;
  state.bone_lengths = {half_length, half_length * (1 + 0.1 * tangent)};
  state.energies.kinetic = 0.25 + tangent;
  state.energies.pair = 1.5 + shake;
  state.energies.bone = 3 * tangent * tangent;
  state.energies.dissipation = 0.01 * time;
  return state;
}

/// There and back, and still at the end; particle 11 is inside out at the third frame.
std::vector<FrameState> lively_run(const RestBody& body, double strength) {
  std::vector<FrameState> run;
  const double tangents[] = {0.02, 0.15, 0.4, 0.25, 0, 0, 0, 0},
               shakes[] = {0.01, 0.1, 0.3, 0.2, 0.15, 0.06, 0.03, 0.02};
  for (std::size_t i = 0; i < std::size(tangents); ++i)
    run.push_back(
        lively_state(body, 0.05 * static_cast<double>(i), strength * tangents[i], shakes[i]));
  std::swap(run[2].positions[120], run[2].positions[127]);
  return run;
}

struct Measured {
  RestBody body;
  std::vector<FrameState> states;
  std::vector<FrameMetrics> frames;
  std::vector<BoneMetrics> bones;
  std::vector<SectionMetrics> sections;
  Summary summary;
  Playback playback;
};

Measured measured(double strength, double fraction) {
  Measured all{rest_body(lively_input()), {}, {}, {}, {}, {}, {}};
  all.states = lively_run(all.body, strength);
  all.playback = plan_playback(all.body, all.states.size(), fraction);
  std::vector<std::vector<RigidFrame>> poses;
  std::vector<std::vector<std::int64_t>> worst;
  std::vector<double> times;
  for (std::size_t i = 0; i < all.states.size(); ++i) {
    const FrameState& state = all.states[i];
    const MeasuredFrame frame = measure_frame(all.body, state);
    all.frames.push_back(frame.metrics);
    worst.push_back(frame.worst_particles);
    const auto bones = measure_bones(all.body, state, frame.particles);
    all.bones.insert(all.bones.end(), bones.begin(), bones.end());
    const auto sections = measure_sections(all.body.sections, state.surface_points, state.time);
    all.sections.insert(all.sections.end(), sections.begin(), sections.end());
    if (all.playback.wants(i)) add_frame(all.playback, i, all.body, state, frame.particles);
    poses.push_back(state.bones);
    times.push_back(state.time);
  }
  std::vector<Hold> at_rest = holds(poses, r);
  for (Hold& hold : at_rest)
    hold.settled =
        settling_time(hold, times, r, [&](std::size_t i) { return all.states[i].positions; });
  all.summary = summarize(all.frames, r, at_rest);
  add_worst_particles(all.summary, worst);
  return all;
}

/// rounded() of all numbers of a text that stand in columns.
std::string rounded_columns(const std::string& csv) {
  std::string out, cell;
  for (const char c : csv) {
    if (c != ',' && c != '\n') {
      cell += c;
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    out += (*end == '\0' ? rounded(value) : cell) + c;
    cell.clear();
  }
  return out;
}

/// Lists the values of every array that can be asked for, at some particles of a frame.
std::string arrays_text(const Measured& run) {
  std::string out;
  for (const Column& column : particle_arrays(run.body, run.states[2], measured_arrays())) {
    out += column.name;
    const auto some = [&](const auto& values) {
      for (std::size_t i = 0; i < values.size(); i += 61)
        out += ',' + rounded(static_cast<double>(values[i]));
    };
    std::visit(some, column.values);
    out += '\n';
  }
  return out;
}

/// Without what all pages have: style, libraries, scripts, licenses, the metrics' help. A line to
/// each line of a chart.
std::string own_part(std::string page) {
  for (const std::string_view part :
       {page_style(), chart_library(), scene_library(), view_script(), page_script()})
    page.erase(page.find(part), part.size());
  const std::size_t licenses = page.find("<summary>Licenses");
  page.erase(licenses, page.find("</details>", licenses) - licenses);
  page = std::regex_replace(page, std::regex("<small>.*\n?</small>\n"), "");
  return std::regex_replace(page, std::regex(R"~(\{"(title|name|metric)")~"), "\n$&");
}

ReportInput report_of(const Measured& run) {
  ReportInput input;
  input.title = "lively";
  input.version = "1.2.3";
  input.radius = r;
  input.facts = {{"Run", {{"particles", "250"}}}};
  input.frames = run.frames;
  input.summary = run.summary;
  for (const char* limit : {"J_min < 0.1", "final(volume_error) > 0.01", "mean(tip_angle) >= 90",
                            "residual_rms > 0.01"})
    input.checks.push_back(check_limit(parse_limit(limit), run.frames, run.summary));
  input.curves = {{"Law", "f", "d (r)", "f (N)", {{"pair", {0, 1, 2.5}, {3, 0.125, -1}}}}};
  input.playback = run.playback;
  return input;
}

ComparedRun compared(const char* name, const Measured& run) {
  return {name, run.frames, run.summary, r, 1000};
}

TEST(Golden, MetricsAreWhatTheyWere) {
  const Measured run = measured(1, 1);
  expect_golden("metrics/golden/metrics.csv", rounded_columns(metrics_csv(run.frames)));
  expect_golden("metrics/golden/metrics_bones.csv", rounded_columns(bone_metrics_csv(run.bones)));
  expect_golden("metrics/golden/sections.csv", rounded_columns(sections_csv(run.sections)));
  expect_golden("metrics/golden/particle_arrays.csv", arrays_text(run));
}

TEST(Golden, TheReportIsWhatItWas) {
  ReportInput input = report_of(measured(1, 1));
  input.playback.frames.resize(2);
  expect_golden("metrics/golden/report.html", own_part(report_html(input)));
}

TEST(Golden, TheComparisonIsWhatItWas) {
  const Measured one = measured(1, 2e-3), other = measured(0.8, 2e-3);
  const RunComparison both = compare(compared("one", one), compared("other", other));
  const ComparisonInput input{
      "1.2.3", both, side_by_side(one.playback, other.playback, {"one: ", "other: "}),
      {},      "a",  "b"};
  expect_golden("metrics/golden/comparison.csv", rounded_columns(comparison_csv(both)));
  expect_golden("metrics/golden/comparison.html", own_part(comparison_html(input)));
}

}  // namespace sinew::test::golden_test
