// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/world/references.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <map>
#include <utility>

#include <sinew/core/decompositions.h>
#include <sinew/core/union_find.h>

namespace sinew {
namespace {

constexpr double free_motion = 1e-9;  // fraction of the largest constraint of a rigid motion
constexpr double min_weight = 1e-3;   // less of a reference is none of it
constexpr double solved = 1e-3;       // relative error of harmonic weights

using Shares = std::vector<Share>;
using RigidMotions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// What holds a particle, with its weights; nothing where all depends on its neighbors.
class HeldParticles {
 public:
  explicit HeldParticles(const Body& body) : held_(body.rest.size()) {
    for (std::size_t i = 0; i < held_.size(); ++i) pulled(body, i);
    if (!body.world) return;
    const std::vector<Pinned>& pins = body.world->pins;
    for (std::uint32_t k = 0; k < pins.size(); ++k) {
      held_[pins[k].particle] = {{of(pins[k]), 1}};
      pin_[pins[k].particle] = k;
    }
  }

  const Shares& of(std::size_t i) const { return held_[i]; }
  const std::uint32_t* pin_of(std::size_t i) const {
    const auto found = pin_.find(static_cast<std::uint32_t>(i));
    return found == pin_.end() ? nullptr : &found->second;
  }
  std::vector<Reference> references() const { return references_; }

 private:
  std::uint32_t number_of(Reference::Kind kind, std::int32_t which) {
    const auto [at, fresh] =
        number_.try_emplace({kind, which}, static_cast<std::uint32_t>(references_.size()));
    if (fresh) references_.push_back({kind, which});
    return at->second;
  }

  std::uint32_t of(const Pinned& pin) {
    if (pin.is_pin())
      return pin.bone == no_bone ? number_of(Reference::scene, 0)
                                 : number_of(Reference::bone, pin.bone);
    const auto by = std::find_if(pin.support.begin(), pin.support.end(),
                                 [](std::int32_t support) { return support != no_support; });
    return number_of(Reference::support, *by);
  }

  void pulled(const Body& body, std::size_t i) {
    double sum = 0;
    for (const Influence& by : body.binding.of(i)) {
      if (body.springs[static_cast<std::size_t>(by.bone)].stiffest() == 0) continue;
      held_[i].push_back({number_of(Reference::bone, by.bone), by.weight});
      sum += by.weight;
    }
    for (Share& share : held_[i]) share.weight /= sum;
  }

  std::vector<Shares> held_;
  std::map<std::uint32_t, std::uint32_t> pin_;
  std::map<std::pair<Reference::Kind, std::int32_t>, std::uint32_t> number_;
  std::vector<Reference> references_;
};

/// The references that hold particles of a part, ascending.
std::vector<std::uint32_t> holders_of(const std::vector<std::uint32_t>& part,
                                      const HeldParticles& held) {
  std::vector<std::uint32_t> holders;
  for (const std::uint32_t i : part)
    for (const Share& share : held.of(i)) holders.push_back(share.reference);
  std::sort(holders.begin(), holders.end());
  holders.erase(std::unique(holders.begin(), holders.end()), holders.end());
  return holders;
}

/// Adds harmonic weights to the particles of a part that nothing holds itself.
void spread(const std::vector<std::uint32_t>& part, const NeighborLists& near,
            const HeldParticles& held, std::vector<Shares>& shares) {
  const std::vector<std::uint32_t> used = holders_of(part, held);
  std::vector<std::uint32_t> open;
  for (const std::uint32_t i : part)
    if (held.of(i).empty()) open.push_back(i);
  if (open.empty() || used.empty()) return;
  if (used.size() == 1) {
    for (const std::uint32_t i : open) shares[i] = {{used[0], 1}};
    return;
  }
  std::vector<Eigen::Index> column(used.back() + 1, -1), row(shares.size(), -1);
  for (std::size_t k = 0; k < used.size(); ++k) column[used[k]] = static_cast<Eigen::Index>(k);
  for (std::size_t k = 0; k < open.size(); ++k) row[open[k]] = static_cast<Eigen::Index>(k);
  const auto n = static_cast<Eigen::Index>(open.size());
  std::vector<Eigen::Triplet<double>> entries;
  // All but the last, which is what they lack of 1.
  const auto solved_for = static_cast<Eigen::Index>(used.size()) - 1;
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(n, solved_for);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::uint32_t i = open[static_cast<std::size_t>(k)];
    entries.emplace_back(k, k, static_cast<double>(near.of(i).size()));
    for (const std::uint32_t j : near.of(i)) {
      if (row[j] >= 0) entries.emplace_back(k, row[j], -1);
      for (const Share& share : held.of(j))
        if (column[share.reference] < solved_for) given(k, column[share.reference]) += share.weight;
    }
  }
  Eigen::SparseMatrix<double> laplacian(n, n);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(solved);
  solver.compute(laplacian);
  const Eigen::MatrixXd weights = solver.solve(given);
  for (Eigen::Index k = 0; k < n; ++k) {
    Shares& own = shares[open[static_cast<std::size_t>(k)]];
    double sum = 0;
    for (std::size_t r = 0; r < used.size(); ++r) {
      const auto c = static_cast<Eigen::Index>(r);
      const double weight = c < solved_for ? weights(k, c) : 1 - weights.row(k).sum();
      if (weight < min_weight) continue;
      own.push_back({used[r], weight});
      sum += weight;
    }
    for (Share& share : own) share.weight /= sum;
    if (own.empty()) own = {{used[0], 1}};
  }
}

/// The particles of each part, by its label.
using Parts = std::map<std::uint32_t, std::vector<std::uint32_t>>;

template <class LabelOf>
Parts parts_of(std::size_t particles, const LabelOf& label_of) {
  Parts parts;
  for (std::uint32_t i = 0; i < particles; ++i) parts[label_of(i)].push_back(i);
  return parts;
}

/// Adds up what pins and supports take from rigid motions.
Eigen::Matrix<double, 6, 6> constraint(const Reference& part, const World* world,
                                       std::span<const Vec3> places, const Vec3& center,
                                       double arm) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t n = 0; n < part.pins.size(); ++n) {
    const Pinned& pin = world->pins[part.pins[n]];
    const Vec3 from = (places[n] - center) / arm;
    const auto hold = [&](const Vec3& direction) {
      Eigen::Matrix<double, 6, 1> row;
      row << direction, from.cross(direction);
      sum += row * row.transpose();
    };
    if (pin.is_oblique()) hold(pin.along);
    for (int axis = 0; axis < 3; ++axis)
      if (pin.holds(axis)) hold(Vec3::Unit(axis));
  }
  return sum;
}

double half_extent(std::span<const Vec3> places) {
  Box box;
  for (const Vec3& place : places) box.extend(place);
  return std::max(box.diagonal().norm() / 2, 1e-300);
}

/// Number of rigid motions that a part with these pins has.
int freedom_of(const Reference& part, const World* world, const Points& rest,
               const std::vector<std::uint32_t>& particles) {
  if (part.pins.empty()) return 6;
  Points all, held;
  for (const std::uint32_t i : particles) all.push_back(rest[i]);
  for (const std::uint32_t pin : part.pins) held.push_back(rest[world->pins[pin].particle]);
  Vec3 center = Vec3::Zero();
  for (const Vec3& place : all) center += place / static_cast<double>(all.size());
  const auto values =
      eigendecomposition(constraint(part, world, held, center, half_extent(all))).values;
  int free = 0;
  while (free < 6 && values[free] < free_motion * values[5]) ++free;
  return free;
}

/// Keeps of a particle's shares those of what holds its part.
void keep(const std::vector<std::uint32_t>& holders, Shares& shares) {
  std::erase_if(shares, [&](const Share& share) {
    return !std::binary_search(holders.begin(), holders.end(), share.reference);
  });
  double sum = 0;
  for (const Share& share : shares) sum += share.weight;
  for (Share& share : shares) share.weight /= sum;
  if (shares.empty() && !holders.empty()) shares = {{holders[0], 1}};
}

/// Puts together the shares of what holds each particle and the parts' own motions.
RigidDamping assembled(const Body& body, const HeldParticles& held, double rate, const Parts& parts,
                       std::vector<Shares> shares) {
  RigidDamping damping{rate, held.references(), {0}, {}};
  for (const auto& [label, part] : parts) {
    bool pulled = false;
    Reference itself{Reference::itself, 0};
    for (const std::uint32_t i : part) {
      if (const std::uint32_t* pin = held.pin_of(i); pin != nullptr)
        itself.pins.push_back(*pin);
      else
        pulled = pulled || !held.of(i).empty();
    }
    const std::vector<std::uint32_t> holders = holders_of(part, held);
    for (const std::uint32_t i : part) keep(holders, shares[i]);
    if (pulled) continue;
    itself.freedom = freedom_of(itself, body.world.get(), body.rest, part);
    if (itself.freedom == 0) continue;
    const auto number = static_cast<std::uint32_t>(damping.references.size());
    damping.references.push_back(itself);
    for (const std::uint32_t i : part) shares[i].push_back({number, 1});
  }
  for (const Shares& of_one : shares) {
    damping.shares.insert(damping.shares.end(), of_one.begin(), of_one.end());
    damping.first.push_back(static_cast<std::uint32_t>(damping.shares.size()));
  }
  return damping;
}

}  // namespace

RigidMotions free_motions(const Reference& part, const World* world, std::span<const Vec3> places,
                          const Vec3& center, double arm) {
  RigidMotions free = RigidMotions::Identity(6, 6);
  if (part.freedom < 6)
    free = eigendecomposition(constraint(part, world, places, center, arm))
               .vectors.leftCols(part.freedom);
  free.bottomRows<3>() /= arm;
  return free;
}

RigidDamping rigid_damping_of(const Body& body, double rate) {
  const std::size_t n = body.rest.size();
  const SharedNeighbors shared = neighbors_of(body);
  const NeighborLists& near = shared->nearest;
  UnionFind sets(n);
  for (std::uint32_t i = 0; i < n; ++i)
    for (const std::uint32_t j : near.of(i))
      sets.join(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
  const Parts parts = parts_of(n, [&](std::uint32_t i) {
    return static_cast<std::uint32_t>(sets.first_of(static_cast<std::int32_t>(i)));
  });
  const HeldParticles held(body);
  std::vector<Shares> shares(n);
  for (std::uint32_t i = 0; i < n; ++i) shares[i] = held.of(i);
  for (const auto& [label, part] : parts) spread(part, near, held, shares);
  return assembled(body, held, rate, parts, std::move(shares));
}

RigidDamping cut(const RigidDamping& whole, const Body& body,
                 std::span<const std::uint32_t> piece) {
  const HeldParticles held(body);
  std::vector<Shares> shares(piece.size());
  for (std::size_t i = 0; i < shares.size(); ++i)
    for (const Share& share : whole.of(i))
      if (whole.references[share.reference].kind != Reference::itself) shares[i].push_back(share);
  return assembled(body, held, whole.rate,
                   parts_of(piece.size(), [&](std::uint32_t i) { return piece[i]; }),
                   std::move(shares));
}

std::vector<AffineMotion> motions_of_holders(const RigidDamping& damping, const Body& body,
                                             double time, const Pose& pose) {
  std::vector<AffineMotion> motions(damping.references.size());
  std::vector<ObstaclePose> supports;
  if (body.world) supports = poses_of(body.world->supports, time, pose);
  for (std::size_t r = 0; r < motions.size(); ++r) {
    const auto which = static_cast<std::size_t>(damping.references[r].which);
    if (damping.references[r].kind == Reference::support) {
      const ObstaclePose& at = supports[which];
      motions[r] = {at.frame.origin, at.velocity, cross_matrix(at.angular_velocity)};
    } else if (damping.references[r].kind == Reference::bone) {
      const BonePose& bone = pose[which];
      motions[r] = {bone.frame.origin, bone.velocity,
                    cross_matrix(bone.angular_velocity) +
                        bone.stretch_rate / bone.stretch * bone.axis() * bone.axis().transpose()};
    }
  }
  return motions;
}

void add_reactions(const RigidDamping& damping, std::size_t particle, const Vec3& p,
                   const Vec3& force, std::span<const AffineMotion> motions,
                   std::span<Reaction> on_bones, std::span<Reaction> of_supports) {
  for (const Share& share : damping.of(particle)) {
    const Reference& by = damping.references[share.reference];
    const AffineMotion& motion = motions[share.reference];
    const Vec3 part = share.weight * force;
    const Reaction on_body{part, (p - motion.at).cross(part), part.dot(motion.velocity_at(p))};
    const auto which = static_cast<std::size_t>(by.which);
    if (by.kind == Reference::support)
      of_supports[which] += on_body;
    else if (by.kind == Reference::bone)
      on_bones[which] += {-on_body.force, -on_body.moment, on_body.power};
  }
}

}  // namespace sinew
