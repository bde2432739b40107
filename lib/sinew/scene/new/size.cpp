// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/new/detail/size.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <sinew/core/cell_grid.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/core/text.h>
#include <sinew/core/union_find.h>
#include <sinew/fill/fill_limits.h>
#include <sinew/mesh/clean.h>
#include <sinew/mesh/winding.h>
#include <sinew/scene/check/needs.h>
#include <sinew/scene/filling.h>
#include <sinew/scene/rigid_parts.h>

namespace sinew {
namespace {

// At first: seconds of filling, and at least as fine as looks like a body.
constexpr double fewest = 3000, max_at_first = 10000, max_if_split = 60000;
constexpr double max_overlap = 0.8;     // fraction of the volume by the faces that lies there once
constexpr double usually_across = 4.5;  // particles across a limb
constexpr double thin_fraction = 0.1;   // fraction of the limbs' length below what is thin
constexpr double max_loose = 0.01;      // fraction of the particles, such as single ones at a tip
constexpr double min_within = 0.1;      // fraction of the particles, with neighbors on all sides
// What a run may take: particles times steps, and particles. About as long as drawing it; and more
// where limbs are thin, but for those that hold a twentieth of the body.
constexpr double usual_work = 5e8, usual_particles = 1e5, largest_work = 1e9, max_particles = 3e5;
constexpr double quick_work = 1.2e7, quick_particles = 5000;
constexpr double min_across = 4, thin_volume = 0.05;
constexpr double foreseen = 0.95;  // fraction of the work: a trial tells it nearly

/// Distance from the surface along the limbs: a tenth of their length is thinner.
double thin_inner(const std::vector<Limb>& limbs) {
  std::vector<std::pair<double, double>> pieces;  // inner, length
  double all = 0;
  for (const Limb& limb : limbs) {
    const std::size_t end = limb.line.size() - (limb.end == Limb::End::tip ? 1 : 0);
    for (std::size_t i = 1; i < end; ++i) {
      pieces.emplace_back(limb.inner[i], (limb.line[i] - limb.line[i - 1]).norm());
      all += pieces.back().second;
    }
  }
  std::sort(pieces.begin(), pieces.end());
  double so_far = 0;
  for (const auto& [inner, length] : pieces)
    if ((so_far += length) >= thin_fraction * all) return inner;
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double three_figures(double value) {
  const double step = std::pow(10, std::floor(std::log10(value)) - 2);
  const double steps = std::round(value / step), parts = std::round(1 / step);
  return parts > 1 ? steps / parts : steps * step;
}

namespace {

/// The fraction of the particles that do not belong to the `parts` largest groups that touch.
double loose_fraction(const Particles& particles, const NeighborLists& touching,
                      std::size_t parts) {
  const int count = static_cast<int>(particles.size());
  UnionFind groups(particles.size());
  for (int i = 0; i < count; ++i)
    for (const std::uint32_t j : touching.of(i)) groups.join(i, static_cast<int>(j));
  std::vector<std::size_t> sizes(particles.size());
  for (int i = 0; i < count; ++i) ++sizes[groups.first_of(i)];
  std::sort(sizes.rbegin(), sizes.rend());
  const std::size_t connected = std::accumulate(
      sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(std::min(parts, sizes.size())),
      std::size_t{0});
  return 1 - static_cast<double>(connected) / static_cast<double>(particles.size());
}

/// Whether the particles are too large: parts of the body do not hold together, or it is one or two
/// layers thick.
bool too_coarse(const Particles& particles, std::size_t parts) {
  constexpr std::size_t complete = 12;  // neighbors, of a particle within
  const NeighborLists touching =
      neighbors_within(positions_of(particles), rest_neighbor_range(particles.radius));
  std::size_t within = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) within += touching.of(i).size() == complete;
  return loose_fraction(particles, touching, parts) > max_loose ||
         static_cast<double>(within) < min_within * static_cast<double>(particles.size());
}

/// Chooses by the thickness of limbs, within what a first picture needs and takes.
double usual_radius(double inner, double volume, bool quick) {
  const double most = quick ? quick_particles : max_at_first;
  return three_figures(std::clamp(inner / usually_across, radius_for_count(volume, most),
                                  radius_for_count(volume, fewest)));
}

}  // namespace

void choose_radius(const Surface& surface, const std::vector<Limb>& limbs, NewChoices& choices) {
  BodyOptions& body = choices.settings.body;
  const double area_of = area(surface.triangles);
  const double volume = volume_inside(surface).volume;
  const double mean = 2 * volume / area_of;  // radius of a rod, thickness of a sheet
  const double inner = choices.hollow ? mean / 2 : std::min(thin_inner(limbs), mean);
  const std::size_t parts =
      static_cast<std::size_t>(std::max(limbs.back().body + 1, surface.components));
  choices.thickness = 2 * inner;
  body.radius = usual_radius(inner, volume, choices.quick);
  Particles particles = fill_body(choices.settings, surface).particles;
  const double filled = static_cast<double>(particles.size()) * volume_per_particle(*body.radius);
  if (filled > 0 && filled < max_overlap * volume) {  // pieces lie within each other
    body.radius = usual_radius(inner, filled, choices.quick);
    particles = fill_body(choices.settings, surface).particles;
  }
  while (too_coarse(particles, parts) && static_cast<double>(particles.size()) < max_if_split / 2) {
    body.radius = three_figures(0.8 * *body.radius);
    particles = fill_body(choices.settings, surface).particles;
  }
  if (choices.count) {
    body.radius = three_figures(*body.radius * std::cbrt(static_cast<double>(particles.size()) /
                                                         static_cast<double>(*choices.count)));
    particles = fill_body(choices.settings, surface).particles;
  }
  choices.particles = particles.size();
  choices.size = "About " + std::to_string(choices.particles) + " particles, " +
                 three_digits(inner / *body.radius) + " across " +
                 (choices.hollow ? "walls" : "limbs") + " that are " + three_digits(2 * inner) +
                 " m thick";
}

Prepared tried(const Surface& surface, const NewChoices& choices, std::optional<BodyFile> filled) {
  Settings settings = choices.settings;
  settings.body.mesh = "body";
  settings.body.unit = LengthUnit::m, settings.body.up = Axis::z, settings.body.forward.reset();
  settings.meshes["body"] = soup_of(surface.triangles);
  settings.motion.begin = choices.begins_posed ? Begin::pose : Begin::rest;
  if (!filled) {
    Settings quick = choices.settings;  // without shares of volume, 24 finer fillings
    quick.material.model = MaterialModel::paper;
    filled = body_file(fill_body(quick, surface));
  }
  return prepare({std::move(settings), std::move(filled)});
}

namespace {

/// What a radius costs, and how fine it is.
struct Trial {
  double radius = 0, particles = 0, work = 0;
  double across = 0;  ///< the thinnest parts but for a twentieth of the body, in layers
  std::string thin;   ///< the bone that holds most of what is too thin

  /// The radius for so much work and so many particles: steps become as short as particles small.
  double for_at_most(double other_work, double count) const {
    return radius *
           std::max(std::pow(work / (foreseen * other_work), 0.25), std::cbrt(particles / count));
  }

  /// Layers are whole: what is n of them thick has room for n - 0.5 at least.
  double sure_across() const { return across < min_across ? across - 0.5 : across; }

  /// The same with another radius.
  Trial with(double other) const {
    const double finer = radius / other;
    return {other, particles * std::pow(finer, 3), work * std::pow(finer, 4),
            other < radius ? sure_across() * finer : across, thin};
  }
};

Trial measured(const Prepared& prepared) {
  const Body& body = prepared.body;
  Trial trial;
  trial.radius = body.material.pair.r;
  trial.particles = static_cast<double>(body.rest.size());
  trial.work =
      trial.particles * static_cast<double>(prepared.plan.steps_until(prepared.frames.count));
  std::vector<double> thickness = particles_across(body);
  std::vector<std::size_t> thin(body.skeleton.size());
  for (std::size_t i = 0; i < thickness.size(); ++i)
    if (const int bone = body.binding.bone(i); bone != no_bone && thickness[i] < min_across)
      ++thin[bone];
  if (const auto thinnest = std::max_element(thin.begin(), thin.end());
      thinnest != thin.end() && *thinnest > 0)
    trial.thin = body.skeleton.bones[static_cast<std::size_t>(thinnest - thin.begin())].name;
  const auto place = thickness.begin() + static_cast<std::ptrdiff_t>(
                                             thin_volume * static_cast<double>(thickness.size()));
  std::nth_element(thickness.begin(), place, thickness.end());
  trial.across = *place;
  return trial;
}

/// The radius that the budget allows, by a trial with another one.
double radius_by(const Trial& trial, double largest, bool quick) {
  if (quick)
    return three_figures(std::min(largest, trial.for_at_most(quick_work, quick_particles)));
  const double usual = trial.for_at_most(usual_work, usual_particles);
  const double fine = trial.radius * trial.sure_across() / min_across;
  const double least = trial.for_at_most(largest_work, max_particles);
  return three_figures(std::min(largest, std::max(least, std::min(usual, fine))));
}

std::string size_text(const Trial& trial) {
  std::string text = "About " + number_text(three_figures(trial.particles)) + " particles, " +
                     three_digits(trial.work) + " particle-steps; ";
  if (trial.across >= 0.995 * min_across)
    return text + "at least 4 across the limbs that hold 95 % of the volume";
  return text + "only " + three_digits(trial.across) + " across thin limbs, most of them along " +
         shown(trial.thin);
}

}  // namespace

void use_budget(const Prepared& first, NewChoices& choices) {
  double& radius = *choices.settings.body.radius;
  const Trial tried = measured(first);
  const Trial trial = tried.with(choices.count ? radius : radius_by(tried, radius, choices.quick));
  radius = trial.radius;
  choices.particles = static_cast<std::size_t>(trial.particles);
  choices.size = size_text(trial);
  std::vector<std::string> warnings;  // which check tells
  const double stepping = trial.work / speed_in_motion(first, speed_at_rest(first, warnings));
  const double all =
      stepping + seconds_of_showing(choices.particles + first.surface.triangles.faces.size(),
                                    first.frames.count + 1);
  choices.time = "about " + three_digits(std::ceil(all)) + " s for a run on this machine, " +
                 three_digits(stepping) + " s of them steps";
}

}  // namespace sinew
