// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/new_study.h>

#include <cstdlib>
#include <initializer_list>

#include <sinew/core/text.h>

namespace sinew {
namespace {

/// "[0.5, 1, 2]", of factors 0.5, 1 and 2.
std::string multiples(double value, std::initializer_list<double> factors) {
  std::string text = "[";
  for (const double factor : factors) {
    if (text.size() > 1) text += ", ";
    text += number_text(std::strtod(three_digits(factor * value).c_str(), nullptr));
  }
  return text + ']';
}

/// A size per axis grows by 1.26 where the number of particles halves.
std::string sizes(const Settings& settings) {
  if (settings.body.radius)
    return "  body.radius: " + multiples(*settings.body.radius, {1, 1.26}) + "  # m\n";
  const double count = settings.body.count.value_or(1000);
  return "  body.count: " + multiples(count, {1, 0.5}) + '\n';
}

std::string moduli(const Settings& settings) {
  return "  material.young_modulus: " + multiples(settings.material.young_modulus, {0.5, 1, 2}) +
         "  # Pa\n";
}

}  // namespace

std::string new_study(const std::string& scene, const Settings& settings) {
  return "# A study: sinew sweep runs the scene with each combination of these values.\n"
         "# sinew sweep THIS_FILE --dry-run tells what that takes.\n"
         "scene: " +
         scene +
         "\n\n"
         "# Any settings that --set takes; entries of lists as in \"loads[tip].force\".\n"
         "# An interval: {from: 1e3, to: 1e5, scale: log, count: 5}.\n"
         "vary:\n" +
         moduli(settings) + sizes(settings) +
         "  material.model: [paper, bonded]\n\n"
         "# grid: every combination; list: the k-th value of each;\n"
         "# {kind: latin_hypercube, samples: 200, seed: 1}: random ones, of intervals.\n"
         "design: grid\n\n"
         "# Metrics (their worst over the run), and columns of supports and probes.\n"
         "results: [volume_error, pose_error_rms, {name: displacement_max, of: final}]\n\n"
         "# Frames that stay: last, metrics (none) or all.\n"
         "keep: last\n";
}

}  // namespace sinew
