// SPDX-License-Identifier: GPL-3.0-or-later
// Which particle a point belongs to: the nearest one, at sites of a lattice or elsewhere. Lengths
// in units of the FCC lattice, sqrt(2) r, from its origin.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <sinew/core/cell_grid.h>
#include <sinew/fill/detail/site_index.h>

namespace sinew {

class Owners {
 public:
  virtual ~Owners() = default;

  virtual std::size_t size() const = 0;
  virtual Vec3 place(std::size_t particle) const = 0;
  /// The particle nearest to a point, within 3 units; else -1.
  virtual std::int64_t nearest(const Vec3& at) const = 0;
  /// Whether other particles are all around it, so that its volume share is known to be 1.
  virtual bool surrounded(std::size_t particle) const = 0;
  /// Calls visit(j) for the particles that touch it.
  virtual void for_each_touching(std::size_t particle,
                                 const std::function<void(std::size_t)>& visit) const = 0;
};

/// Particles at filled sites, which must outlive this.
class SiteOwners : public Owners {
 public:
  SiteOwners(const FilledSites& filled, const Touching& touching);

  std::size_t size() const override { return places_.size(); }
  Vec3 place(std::size_t particle) const override;
  std::int64_t nearest(const Vec3& at) const override;
  bool surrounded(std::size_t particle) const override;
  void for_each_touching(std::size_t particle,
                         const std::function<void(std::size_t)>& visit) const override;

 private:
  const FilledSites& filled_;
  const Touching& touching_;
  SiteIndex index_;
  std::vector<LatticePlace> places_;
};

/// Particles at any places.
class PointOwners : public Owners {
 public:
  /// `touching`: the neighbors of each; must outlive this.
  PointOwners(Points places, const NeighborLists& touching);

  std::size_t size() const override { return places_.size(); }
  Vec3 place(std::size_t particle) const override { return places_[particle]; }
  std::int64_t nearest(const Vec3& at) const override;
  bool surrounded(std::size_t) const override { return false; }
  void for_each_touching(std::size_t particle,
                         const std::function<void(std::size_t)>& visit) const override;

 private:
  Points places_;
  const NeighborLists& touching_;
  CellGrid near_, far_;
};

}  // namespace sinew
