// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/metrics/particle_values.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/decompositions.h>
#include <sinew/core/error.h>
#include <sinew/core/parallel.h>
#include <sinew/metrics/pair_forces.h>

namespace sinew {

namespace {

constexpr std::size_t piece = 1024;

template <class Job>
void for_each_particle(std::size_t count, const Job& job) {
  parallel_for(count, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) job(i);
  });
}

/// sqrt(factor dev T : dev T) of a symmetric tensor with these principal values.
double equivalent(const Vec3& principal, double factor) {
  const double mean = principal.mean();
  return std::sqrt(factor * (principal.array() - mean).square().sum());
}

void add_motion(ParticleValues& out, const RestBody& rest, const FrameState& state) {
  for_each_particle(rest.particles(), [&](std::size_t i) {
    out.displacement[i] = (state.positions[i] - rest.shape.points[i]).norm();
    out.speed[i] = state.velocities.empty() ? not_measured : state.velocities[i].norm();
  });
}

void add_deformation(ParticleValues& out, const RestShape& shape, const Points& now) {
  for_each_particle(now.size(), [&](std::size_t i) {
    out.J[i] = out.strain[i] = out.stretch[i] = out.D2min[i] = not_measured;
    if (!shape.defined(i)) return;
    const Mat3 F = deformation_gradient(shape, now, i);
    const Vec3 squares = eigenvalues_in_closed_form(F.transpose() * F).cwiseMax(flattest);
    out.J[i] = F.determinant();
    out.strain[i] = equivalent(squares.array().log() / 2, 2.0 / 3);
    out.stretch[i] = std::sqrt(squares.maxCoeff());
    out.D2min[i] = non_affine(shape, now, F, i);
  });
}

void add_pose(ParticleValues& out, const RestBody& rest, const FrameState& state) {
  for_each_particle(rest.particles(), [&](std::size_t i) {
    const int bone = rest.bone_of[i];
    out.pose_error[i] = not_measured;
    if (bone < 0) return;
    const Vec3 target = carried(rest.shape.points[i], rest.bones[bone].rest, state.bones[bone]);
    out.pose_error[i] = (state.positions[i] - target).norm();
  });
}

/// Counts of particles within two ranges (m) of one.
struct Within {
  double near = 0, far = 0;
};

/// Numbers of value(k), squared distances for k < count, within each range.
template <class Squared>
Within count_within(std::size_t count, double near, double far, const Squared& squared) {
  Within found;
  for (std::size_t k = 0; k < count; ++k) {
    const double d = squared(k);
    found.near += d < near * near;
    found.far += d < far * far;
  }
  return found;
}

void count_neighbors(ParticleValues& out, const RestBody& rest, const Points& now,
                     std::span<const Neighbor> neighbors, std::size_t i) {
  const double near = rest_neighbor_range(rest.radius()), far = rest.interaction_range();
  const auto before = rest.shape.neighbors.of(i);
  const Within all = count_within(neighbors.size(), near, far,
                                  [&](std::size_t k) { return neighbors[k].squared; });
  const Within kept = count_within(before.size(), near, far, [&](std::size_t k) {
    return (now[i] - now[before[k]]).squaredNorm();
  });
  const auto all_before = static_cast<double>(before.size());
  out.neighbors[i] = all.far;
  out.lost[i] = all_before - kept.far;
  out.gained[i] = all.near - kept.near;
  out.turnover[i] = all_before > 0 ? (out.lost[i] + out.gained[i]) / all_before : not_measured;
}

void add_surroundings(ParticleValues& out, const RestBody& rest, const FrameState& state) {
  const Points& now = state.positions;
  const double range = std::max(rest_neighbor_range(rest.radius()), rest.interaction_range());
  const bool finds_stress = !out.von_mises.empty() && state.von_mises.empty();
  const CellGrid grid(now, range);
  parallel_for(now.size(), piece, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> neighbors;
    for (std::size_t i = begin; i < end; ++i) {
      const auto near = find_neighbors(now, grid, range, i, neighbors);
      count_neighbors(out, rest, now, near, i);
      if (finds_stress)
        out.von_mises[i] =
            von_mises(cauchy_stress(kirchhoff_stress(rest, state, near, i), out.J[i]));
    }
  });
}

/// Whether an array is of the particles around each one, which take most of the time to find.
bool is_of_surroundings(std::string_view name) { return name == "von_mises" || name == "turnover"; }

/// All values; those of the surroundings only where they are asked for.
ParticleValues values_of(const RestBody& rest, const FrameState& state, bool of_surroundings) {
  ParticleValues out;
  const std::size_t n = rest.particles();
  for (auto* values : {&out.displacement, &out.speed, &out.J, &out.strain, &out.stretch, &out.D2min,
                       &out.neighbors, &out.lost, &out.gained, &out.turnover, &out.pose_error})
    values->resize(n);
  out.von_mises = state.von_mises;
  if (knows_forces(rest, state)) out.von_mises.resize(n);
  add_motion(out, rest, state);
  add_deformation(out, rest.shape, state.positions);
  add_pose(out, rest, state);
  if (of_surroundings) add_surroundings(out, rest, state);
  out.weight = rest.weight;
  return out;
}

}  // namespace

ParticleValues particle_values(const RestBody& rest, const FrameState& state) {
  return values_of(rest, state, true);
}

namespace {

template <std::size_t n>
using Values = std::array<double, n>;

Values<6> symmetric(const Mat3& T) {
  return {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)};
}

Values<9> row_by_row(const Mat3& T) {
  Values<9> out;
  for (std::size_t k = 0; k < 9; ++k)
    out[k] = T(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3));
  return out;
}

/// of(i), n numbers, for every particle.
template <std::size_t n, class Of>
Column filled(std::string_view name, std::size_t particles, const Of& of) {
  std::vector<double> values(n * particles);
  parallel_for(particles, piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Values<n> one = of(i);
      std::copy(one.begin(), one.end(), values.begin() + static_cast<std::ptrdiff_t>(n * i));
    }
  });
  return {std::string(name), static_cast<int>(n), std::move(values)};
}

/// The same of the deformation gradient, where there is one.
template <std::size_t n, class Of>
Column of_gradient(std::string_view name, const RestBody& rest, const Points& now, const Of& of) {
  Values<n> none;
  none.fill(not_measured);
  return filled<n>(name, now.size(), [&](std::size_t i) {
    return rest.shape.defined(i) ? of(deformation_gradient(rest.shape, now, i)) : none;
  });
}

/// Principal values of F^T F, ascending, with their directions.
Values<3> principal_stretches(const Mat3& F) {
  const Vec3 squares = eigenvalues(F.transpose() * F).cwiseMax(flattest);
  return {std::sqrt(squares[2]), std::sqrt(squares[1]), std::sqrt(squares[0])};
}

Values<6> green_lagrange(const Mat3& F) {
  return symmetric((F.transpose() * F - Mat3::Identity()) / 2);
}

Values<6> hencky(const Mat3& F) {
  const auto [squares, directions] = principal_axes(F.transpose() * F);
  const Vec3 logs = squares.cwiseMax(flattest).array().log() / 2;
  return symmetric(directions * logs.asDiagonal() * directions.transpose());
}

Column stress_column(std::string_view name, const RestBody& rest, const FrameState& state) {
  const std::vector<Mat3> found = kirchhoff_stresses(rest, state);
  const bool is_cauchy = name == "stress";
  return filled<6>(name, found.size(), [&](std::size_t i) {
    if (!is_cauchy) return symmetric(found[i]);
    const double J = rest.shape.defined(i)
                         ? deformation_gradient(rest.shape, state.positions, i).determinant()
                         : not_measured;
    return symmetric(cauchy_stress(found[i], J));
  });
}

Column inverted(std::string_view name, const std::vector<double>& J) {
  std::vector<std::int32_t> flags;
  flags.reserve(J.size());
  for (const double one : J) flags.push_back(one <= 0);
  return column(std::string(name), std::move(flags));
}

/// One of the values that frames are measured with.
Column scalar(std::string_view name, const ParticleValues& values) {
  using V = ParticleValues;
  constexpr std::array<std::pair<std::string_view, std::vector<double> V::*>, 6> members{
      {{"J", &V::J},
       {"strain_eq", &V::strain},
       {"von_mises", &V::von_mises},
       {"D2min", &V::D2min},
       {"turnover", &V::turnover},
       {"pose_error", &V::pose_error}}};
  if (name == "inverted") return inverted(name, values.J);
  const auto* member = std::find_if(members.begin(), members.end(),
                                    [&](const auto& one) { return one.first == name; });
  std::vector<double> copy = values.*member->second;
  copy.resize(values.J.size(), not_measured);  // stresses that are not defined
  return column(std::string(name), std::move(copy));
}

}  // namespace

std::vector<Column> particle_arrays(const RestBody& rest, const FrameState& state,
                                    std::span<const std::string_view> names) {
  const Points& now = state.positions;
  std::vector<Column> columns;
  ParticleValues values;
  for (const std::string_view name : names) {
    if (name == "F")
      columns.push_back(of_gradient<9>(name, rest, now, row_by_row));
    else if (name == "stretch")
      columns.push_back(of_gradient<3>(name, rest, now, principal_stretches));
    else if (name == "strain")
      columns.push_back(of_gradient<6>(name, rest, now, green_lagrange));
    else if (name == "hencky_strain")
      columns.push_back(of_gradient<6>(name, rest, now, hencky));
    else if (name == "stress" || name == "stress_kirchhoff")
      columns.push_back(stress_column(name, rest, state));
    else if (name == "energy_density")
      columns.push_back(column(std::string(name), energy_densities(rest, state)));
    else if (name == "surface_layer")
      columns.push_back(column(std::string(name), rest.layer));
    else {
      if (values.J.empty())
        values =
            values_of(rest, state, std::any_of(names.begin(), names.end(), is_of_surroundings));
      columns.push_back(scalar(name, values));
    }
  }
  return columns;
}

std::vector<Column> deformation_arrays(const RestShape& rest, const Points& now) {
  std::vector<AffineFit> fits(now.size());
  for_each_particle(now.size(), [&](std::size_t i) { fits[i] = affine_fit(rest, now, i); });
  const auto of_fit = [&]<std::size_t n>(std::string_view name, Values<n> (*of)(const Mat3&)) {
    Values<n> none;
    none.fill(not_measured);
    return filled<n>(name, fits.size(), [&](std::size_t i) {
      return fits[i].F.array().isFinite().all() ? of(fits[i].F) : none;
    });
  };
  return {of_fit("F", row_by_row),
          of_fit(
              "J", +[](const Mat3& F) { return Values<1>{F.determinant()}; }),
          of_fit("strain", green_lagrange),
          of_fit("stretch", principal_stretches),
          of_fit(
              "strain_eq",
              +[](const Mat3& F) {
                const Vec3 squares = eigenvalues(F.transpose() * F).cwiseMax(flattest);
                return Values<1>{equivalent(squares.array().log() / 2, 2.0 / 3)};
              }),
          filled<1>("D2min", fits.size(), [&](std::size_t i) { return Values<1>{fits[i].D2min}; }),
          of_fit(
              "R", +[](const Mat3& F) { return row_by_row(rotation_part(F)); }),
          of_fit(
              "rotation", +[](const Mat3& F) {
                return Values<1>{degrees(Eigen::AngleAxisd(rotation_part(F)).angle())};
              })};
}

namespace {

const char* why_undefined(std::string_view name) {
  if (name == "stress" || name == "stress_kirchhoff" || name == "von_mises")
    return "forces of muscles and of bonds that break or creep do not follow from positions alone; "
           "the run itself writes it, by output.arrays";
  if (name == "energy_density")
    return "energies of bonds that break, creep or relax do not follow from positions alone; of "
           "those that break or creep, the run itself writes it, by output.arrays";
  if (name == "pose_error") return "no particle has a bone";
  return "all neighbors of each particle lie in a plane";
}

}  // namespace

bool has_strain(const RestBody& rest) {
  std::size_t i = 0;
  while (i < rest.particles() && !rest.shape.defined(i)) ++i;
  return i < rest.particles();
}

FrameState state_at_rest(const RestBody& rest) {
  FrameState state;
  state.positions = rest.shape.points;
  for (const Bone& bone : rest.bones) state.bones.push_back(bone.rest);
  return state;
}

std::vector<std::string_view> defined_arrays(const RestBody& rest, const FrameState& at_rest,
                                             const RequestedArrays& asked) {
  const std::vector<std::string_view>& names = asked.measured;
  std::vector<std::string_view> defined;
  const std::vector<Column> columns = particle_arrays(rest, at_rest, names);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& array = columns[k];
    const auto* values = std::get_if<std::vector<double>>(&array.values);
    if (values == nullptr || std::any_of(values->begin(), values->end(),
                                         [](double value) { return !std::isnan(value); }))
      defined.push_back(names[k]);
    else if (!asked.all)
      throw bad_input("no particle has a value of " + array.name + ": " + why_undefined(array.name),
                      "leave it out of the arrays");
  }
  return defined;
}

}  // namespace sinew
