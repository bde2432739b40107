// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/groups/cubic/inner_forces.h>

#include <algorithm>
#include <bit>

#include <sinew/body/body.h>
#include <sinew/core/parallel.h>

namespace sinew {
namespace {

constexpr std::size_t blocks_at_a_time = 2048, bonds_per_task = 512;
constexpr std::size_t vector_of_doubles = 8;  // doubles in 64 bytes
constexpr std::uint32_t nearest_ones = (1U << nearest_sites) - 1;

using SquareSums = Eigen::Matrix<double, square_terms, 3>;

/// Calls visit(site) for each bit.
template <class Visit>
void for_each_site(std::uint32_t sites, const Visit& visit) {
  for (; sites != 0; sites &= sites - 1) visit(static_cast<std::uint32_t>(std::countr_zero(sites)));
}

/// Averages the growth of terms from a particle to the nearest of its neighbors at these sites.
Growth mean_growth(const std::array<Growth, near_sites>& growth, std::uint32_t sites) {
  Growth mean = Growth::Zero();
  for_each_site(sites & nearest_ones, [&](std::uint32_t site) { mean += growth[site]; });
  return mean / std::max(std::popcount(sites & nearest_ones), 1);
}

template <class Holds>
bool any_of(std::size_t count, const Holds& holds) {
  for (std::size_t n = 0; n < count; ++n)
    if (holds(n)) return true;
  return false;
}

Vec3 place(const InnerParticles& of, std::size_t k) {
  return {of.at[0][k], of.at[1][k], of.at[2][k]};
}

}  // namespace

/// Sites of neighbors of a block's particles, by lane: of those that are idle as well, and of those
/// that the kernel computes; and where neighbors are, by site.
template <class Real>
struct InnerForces<Real>::Reach {
  std::array<std::uint32_t, block> within{}, across{};
  std::array<std::array<std::int32_t, near_sites>, block> difference;

  /// The neighbor of the particle at k, which is that of the lane.
  std::size_t far(std::size_t k, std::size_t lane, std::uint32_t site) const {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + difference[lane][site]);
  }
};

/// Bonds of some blocks.
template <class Real>
struct InnerForces<Real>::Found {
  struct OfGroup {
    std::array<std::size_t, near_sites> count{};   ///< one per leading site
    std::array<QuarticTerms, near_sites> moments;  ///< moments of near ends, times factors
    Growth products = Growth::Zero();  ///< terms times square terms, where no neighbor is missing
    Eigen::Matrix<double, cubic_terms, cubic_terms> drag =
        Eigen::Matrix<double, cubic_terms, cubic_terms>::Zero();  ///< elsewhere

    OfGroup() { moments.fill(QuarticTerms::Zero()); }
    void operator+=(const OfGroup& other) {
      for (std::size_t site = 0; site < near_sites; ++site)
        count[site] += other.count[site], moments[site] += other.moments[site];
      products += other.products, drag += other.drag;
    }
  };
  std::vector<OfGroup> of;
};

/// Near ends of bonds, and factors on their stiffness.
template <class Real>
struct InnerForces<Real>::Ends {
  Points at;
  std::vector<double> factor;

  void add(const Vec3& one, double its_factor) { at.push_back(one), factor.push_back(its_factor); }
  void add(const Ends& more) {
    at.insert(at.end(), more.at.begin(), more.at.end());
    factor.insert(factor.end(), more.factor.begin(), more.factor.end());
  }
  Eigen::MatrixXd moments() const {
    Eigen::MatrixXd all(quartic_terms, static_cast<Eigen::Index>(at.size()));
    for (std::size_t n = 0; n < at.size(); ++n)
      all.col(static_cast<Eigen::Index>(n)) = factor[n] * quartic_terms_at(at[n]);
    return all;
  }
};

template <class Real>
InnerForces<Real>::InnerForces(const Body& body, const AffineForces& lattice,
                               const BondLists<Real>& bonds, const InnerParticles& particles)
    : body_(&body), site_(lattice.sites()), groups_(particles.frames.size()) {
  for (const Vec3& rest : bonds.rest) site_of_kind_.push_back(lattice.site_of(rest));
  for (std::uint32_t site = 0; site < near_sites; ++site)
    if (static_cast<int>(site) < lattice.site_of(-site_[site])) leading_ |= 1U << site;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].cubic = particles.cubic[g] != 0;
    for (std::size_t site = 0; site < near_sites; ++site)
      groups_[g].growth[site] = growth_over(particles.frames[g] * site_[site]);
  }
  const std::size_t blocks = particles.idle.size();
  std::vector<Found> found((blocks + blocks_at_a_time - 1) / blocks_at_a_time);
  parallel_for(blocks, blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    found[begin / blocks_at_a_time] = found_in(bonds, particles, begin, end);
  });
  sample(bonds, particles, found);
  add_across(bonds, particles);
}

template <class Real>
auto InnerForces<Real>::reach_of(const BondLists<Real>& bonds, const InnerParticles& of,
                                 std::size_t b) const -> Reach {
  Reach reach;
  for (std::uint32_t e = bonds.first[b]; e < bonds.first[b + 1]; ++e) {
    const kernel::BondEntry& entry = bonds.entries[e];
    const int site = site_of_kind_[entry.kind];
    for_each_site(entry.lanes >> kernel::rest_lanes, [&](std::uint32_t lane) {
      const auto to = static_cast<std::ptrdiff_t>(b * block + lane) + entry.difference;
      const bool idle = of.idle[static_cast<std::size_t>(to) / block] != 0;
      (idle ? reach.within : reach.across)[lane] |= 1U << site;
      reach.difference[lane][static_cast<std::size_t>(site)] = entry.difference;
    });
  }
  return reach;
}

template <class Real>
double InnerForces<Real>::factor(const InnerParticles& of, std::size_t near,
                                 std::size_t far) const {
  const BondFactors::Row row = body_->factors.of(static_cast<std::uint32_t>(of.id[near]));
  return row.empty() ? 1 : row.at(static_cast<std::uint32_t>(of.id[far]));
}

template <class Real>
auto InnerForces<Real>::found_in(const BondLists<Real>& bonds, const InnerParticles& of,
                                 std::size_t begin, std::size_t end) const -> Found {
  Found found;
  found.of.resize(groups_.size());
  for (std::size_t b = begin; b < end; ++b) {
    if (!is_inner(of, b)) continue;
    const auto g = static_cast<std::size_t>(of.group[b * block]);
    const Reach reach = reach_of(bonds, of, b);
    typename Found::OfGroup& sums = found.of[g];
    for (std::size_t lane = 0; lane < block; ++lane) {
      const std::size_t k = b * block + lane;
      const QuarticTerms moments = quartic_terms_at(place(of, k));
      const SquareTerms square = moments.template head<square_terms>();
      const Terms terms = moments.template head<cubic_terms>();
      for_each_site(reach.within[lane] & leading_, [&](std::uint32_t site) {
        ++sums.count[site];
        sums.moments[site] += factor(of, k, reach.far(k, lane, site)) * moments;
      });
      const std::uint32_t near = (reach.within[lane] | reach.across[lane]) & nearest_ones;
      if (near == nearest_ones)
        sums.products += terms * square.transpose();
      else
        sums.drag += terms * (mean_growth(groups_[g].growth, near) * square).transpose();
    }
  }
  return found;
}

/// The near ends of those bonds within groups that are taken, by group and site.
template <class Real>
auto InnerForces<Real>::ends_within(const BondLists<Real>& bonds, const InnerParticles& of,
                                    const std::vector<Counts>& before, const Take& take) const
    -> std::vector<Ends> {
  std::vector<std::vector<Ends>> some(before.size());
  parallel_for(of.idle.size(), blocks_at_a_time, [&](std::size_t begin, std::size_t end) {
    std::vector<Ends>& ends = some[begin / blocks_at_a_time];
    Counts next = before[begin / blocks_at_a_time];
    ends.resize(next.size());
    for (std::size_t b = begin; b < end; ++b) {
      if (!is_inner(of, b)) continue;
      const auto of_group = static_cast<std::size_t>(of.group[b * block]) * near_sites;
      const Reach reach = reach_of(bonds, of, b);
      for (std::size_t lane = 0; lane < block; ++lane)
        for_each_site(reach.within[lane] & leading_, [&](std::uint32_t site) {
          if (!take(of_group + site, next[of_group + site]++)) return;
          const std::size_t k = b * block + lane;
          ends[of_group + site].add(place(of, k), factor(of, k, reach.far(k, lane, site)));
        });
    }
  });
  std::vector<Ends> all(before.empty() ? 0 : before.front().size());
  for (const std::vector<Ends>& ends : some)
    for (std::size_t n = 0; n < all.size(); ++n) all[n].add(ends[n]);
  return all;
}

/// One bond of each stretch of them, which get shorter where a sample does not do.
template <class Real>
void InnerForces<Real>::sample(const BondLists<Real>& bonds, const InnerParticles& of,
                               const std::vector<Found>& found) {
  std::vector<typename Found::OfGroup> all(groups_.size());
  std::vector<Counts> before;
  for (const Found& one : found) {
    Counts& counts = before.emplace_back();
    for (std::size_t g = 0; g < all.size(); ++g) {
      counts.insert(counts.end(), all[g].count.begin(), all[g].count.end());
      all[g] += one.of[g];
    }
  }
  const auto count = [&](std::size_t n) { return all[n / near_sites].count[n % near_sites]; };
  std::vector<std::vector<double>> weights(groups_.size() * near_sites);
  std::vector<Ends> ends(weights.size());
  const auto missing = [&](std::size_t n) { return count(n) > 0 && weights[n].empty(); };
  for (std::size_t shorter = 1; any_of(weights.size(), missing); shorter *= 4) {
    std::vector<Ends> some = ends_within(bonds, of, before, [&](std::size_t n, std::size_t nth) {
      return missing(n) && is_sample(nth, std::max<std::size_t>(stretch_of(count(n)) / shorter, 1));
    });
    for (std::size_t n = 0; n < weights.size(); ++n) {
      if (!missing(n)) continue;
      ends[n] = std::move(some[n]);
      weights[n] =
          weights_of(ends[n].moments(), all[n / near_sites].moments[n % near_sites], count(n));
    }
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].drag =
        all[g].drag + all[g].products * mean_growth(groups_[g].growth, nearest_ones).transpose();
    for (std::uint32_t site = 0; site < near_sites; ++site)
      append({static_cast<std::int32_t>(g), site, false, 0, 0}, ends[g * near_sites + site],
             weights[g * near_sites + site]);
  }
}

template <class Real>
void InnerForces<Real>::add_across(const BondLists<Real>& bonds, const InnerParticles& of) {
  std::vector<Ends> across(groups_.size() * near_sites);
  for (std::size_t b = 0; b < of.idle.size(); ++b) {
    if (!is_inner(of, b)) continue;
    const auto of_group = static_cast<std::size_t>(of.group[b * block]) * near_sites;
    const Reach reach = reach_of(bonds, of, b);
    for (std::size_t lane = 0; lane < block; ++lane)
      for_each_site(reach.across[lane], [&](std::uint32_t site) {
        const std::size_t k = b * block + lane;
        across[of_group + site].add(place(of, k), factor(of, k, reach.far(k, lane, site)));
      });
  }
  for (std::size_t n = 0; n < across.size(); ++n)
    append({static_cast<std::int32_t>(n / near_sites), static_cast<std::uint32_t>(n % near_sites),
            true, 0, 0},
           across[n], std::vector<double>(across[n].at.size(), 1));
}

/// In tasks of whole vectors.
template <class Real>
void InnerForces<Real>::append(Task task, const Ends& ends, std::span<const double> weights) {
  for (std::size_t first = 0; first < ends.at.size(); first += bonds_per_task) {
    const std::size_t last = std::min(first + bonds_per_task, ends.at.size());
    task.begin = weight_.size();
    for (std::size_t n = first; n < last; ++n) {
      for (int axis = 0; axis < 3; ++axis)
        at_[static_cast<std::size_t>(axis)].push_back(ends.at[n][axis]);
      weight_.push_back(weights[n] * ends.factor[n]);
      contact_.push_back(weights[n]);
    }
    while (weight_.size() % vector_of_doubles != 0) {
      for (auto& axis : at_) axis.push_back(axis.back());
      weight_.push_back(0), contact_.push_back(0);
    }
    task.end = weight_.size();
    tasks_.push_back(task);
  }
}

template <class Real>
double InnerForces<Real>::stiffness_of(std::uint32_t site) const {
  const auto& bond = body_->material.bond;
  return site < nearest_sites ? bond.stiffness : bond.second;
}

/// Nearest neighbors are bonded, and never touch.
template <class Real>
double InnerForces<Real>::push_of(std::uint32_t site) const {
  return site < nearest_sites ? 0 : body_->material.pair.k1 / stiffness_of(site);
}

template <class Real>
void InnerForces<Real>::add(const kernel::Functions<Real>& kernel,
                            std::span<const GroupMotion> motions,
                            std::span<GroupForces> sums) const {
  std::vector<std::array<double, 3 * cubic_terms>> found(tasks_.size());
  parallel_for(tasks_.size(), 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Task& task = tasks_[n];
      const auto g = static_cast<std::size_t>(task.group);
      const SquareSums apart = groups_[g].growth[task.site].transpose() * motions[g].x;
      (task.across ? kernel.pull_ends : kernel.pull_bonds)(
          {{at_[0].data() + task.begin, at_[1].data() + task.begin, at_[2].data() + task.begin},
           weight_.data() + task.begin,
           contact_.data() + task.begin,
           task.end - task.begin,
           apart.data(),
           site_[task.site].norm(),
           push_of(task.site),
           2 * body_->material.pair.r},
          found[n].data());
    }
  });
  for (std::size_t n = 0; n < tasks_.size(); ++n) {  // in this order, whichever thread made them
    const Task& task = tasks_[n];
    const auto g = static_cast<std::size_t>(task.group);
    const double k = stiffness_of(task.site);
    if (task.across)
      sums[g].force -= k * Eigen::Map<const Coefficients>(found[n].data());
    else
      sums[g].force +=
          k * (groups_[g].growth[task.site] * Eigen::Map<const SquareSums>(found[n].data()));
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!groups_[g].cubic) continue;
    const Coefficients drag = body_->material.damping * (groups_[g].drag * motions[g].v);
    sums[g].drag += drag, sums[g].force += drag;
  }
}

template <class Real>
GroupForces InnerForces<Real>::on(const BondLists<Real>& bonds, const InnerParticles& of,
                                  std::size_t b, const GroupMotion& motion) const {
  const auto& growth = groups_[static_cast<std::size_t>(of.group[b * block])].growth;
  const Reach reach = reach_of(bonds, of, b);
  GroupForces sums;
  for (std::size_t lane = 0; lane < block; ++lane) {
    const std::size_t k = b * block + lane;
    const Vec3 at = place(of, k);
    const SquareTerms square = square_terms_at(at);
    const Terms terms = terms_at(at);
    const std::uint32_t sites = reach.within[lane] | reach.across[lane];
    Vec3 force = Vec3::Zero();
    for_each_site(sites, [&](std::uint32_t site) {
      const Vec3 to = motion.x.transpose() * (growth[site] * square);
      const double touching = 2 * body_->material.pair.r, d = to.norm();
      const double spring = factor(of, k, reach.far(k, lane, site)) * (1 - site_[site].norm() / d);
      const double push = push_of(site) * std::max(touching * touching - d * d, 0.0) / d;
      force += stiffness_of(site) * (spring - push) * to;
    });
    const Vec3 drag =
        body_->material.damping * motion.v.transpose() * (mean_growth(growth, sites) * square);
    sums.drag += terms * drag.transpose();
    sums.force += terms * (force + drag).transpose();
  }
  return sums;
}

template class InnerForces<double>;
template class InnerForces<float>;

}  // namespace sinew
