// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include <sinew/study/compare_elements.h>

namespace sinew {
namespace {

constexpr double digits_of_results = 1e-5;  // they have six: less is nothing

double largest(const ComparedProbe& probe, int axis) {
  double most = 0;
  for (const Points* values : {&probe.elements, &probe.run})
    for (const Vec3& value : *values) most = std::max(most, std::abs(value[axis]));
  return most;
}

double largest(const ComparedProbe& probe) {
  return std::max({largest(probe, 0), largest(probe, 1), largest(probe, 2)});
}

int widest_axis(const Points& values) {
  Vec3 most = Vec3::Zero();
  for (const Vec3& value : values) most = most.cwiseMax(value.cwiseAbs());
  int axis = 0;
  most.maxCoeff(&axis);
  return axis;
}

std::vector<double> components(const Points& values, int axis) {
  std::vector<double> all;
  for (const Vec3& value : values) all.push_back(value[axis]);
  return all;
}

}  // namespace

std::vector<Chart> element_charts(const ElementComparison& compared) {
  Chart apart{"Distance from the elements",
              "Of each particle, over the largest displacement",
              "%",
              {0},
              0,
              Drawn::always,
              {{"rms", {}}, {"largest", {}}}};
  for (const ElementFrame& frame : compared.frames) {
    apart.lines[0].values.push_back(100 * frame.rms_relative);
    apart.lines[1].values.push_back(100 * frame.max_relative);
  }
  std::vector<Chart> charts{std::move(apart)};
  for (const ComparedProbe& probe : compared.probes)
    for (int axis = 0; axis < 3; ++axis) {
      if (!(largest(probe, axis) > digits_of_results * largest(probe))) continue;
      Chart chart{probe.name + ": displacement " + "xyz"[axis],
                  "Of the probe",
                  "m",
                  {0},
                  0,
                  Drawn::unless_zero,
                  {{"a: elements", {}}, {"b: run", {}}}};
      for (const Vec3& value : probe.elements) chart.lines[0].values.push_back(value[axis]);
      for (const Vec3& value : probe.run) chart.lines[1].values.push_back(value[axis]);
      charts.push_back(std::move(chart));
    }
  return charts;
}

std::vector<LawCurve> element_curves(const ElementComparison& compared) {
  std::vector<LawCurve> curves;
  for (const ComparedSupport& one : compared.supports) {
    const int across = widest_axis(one.run_displacement), up = widest_axis(one.run_force);
    const std::vector<double> x = components(one.run_displacement, across);
    if (x.size() < 2 || std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end())
      continue;
    curves.push_back({one.name,
                      "Its force on the body over its displacement",
                      std::string("displacement ") + "xyz"[across] + " (m)",
                      std::string("force ") + "xyz"[up] + " (N)",
                      {{"a: elements", components(one.elements_displacement, across),
                        components(one.elements_force, up)},
                       {"b: run", x, components(one.run_force, up)}}});
  }
  return curves;
}

}  // namespace sinew
