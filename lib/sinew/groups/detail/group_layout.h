// SPDX-License-Identifier: GPL-3.0-or-later
// Where the particles of groups are in the kernel's order, and what a step does with their blocks.
//
// Blocks of particles within a group are idle: a step leaves them out. Those that its neighbors
// read are placed before each step, all others when somebody asks for them. Those that particles of
// others may touch are watched, and wake in steps in which they are touched.
//
//     layout.set_order(id, bonds, two_deep);
//     layout.watch(lists.arrays(), lists.take_changed(), bonds, meets);
//     layout.activate(state, units);  // before a step, after placing layout.read_in_steps()
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <sinew/groups/cubic/inner_forces.h>
#include <sinew/groups/detail/group_shapes.h>
#include <sinew/kernel/kernel.h>
#include <sinew/lists/block_state.h>
#include <sinew/lists/bond_lists.h>

namespace sinew {

/// Places [begin, end) in the kernel's order, all of one group; the first one's row among those on
/// which forces are gathered.
struct GroupRun {
  std::uint32_t begin, end;
  std::int32_t group;
  std::int64_t row = 0;
};

template <class Real>
class GroupLayout {
 public:
  static constexpr std::size_t block = BlockState<Real>::block;

  /// Particles by their place in the kernel's order.
  struct Places {
    std::vector<std::int32_t> id;
    std::vector<std::int32_t> group;                ///< -1: free
    std::array<std::vector<double>, 3> at;          ///< in the frame of the group
    std::array<std::vector<Real>, 3> at_of_kernel;  ///< the same, padded

    Vec3 place(std::size_t k) const { return {at[0][k], at[1][k], at[2][k]}; }
    std::array<const double*, 3> all() const { return {at[0].data(), at[1].data(), at[2].data()}; }
  };

  GroupLayout() = default;
  /// Both outlive it.
  GroupLayout(const Body& body, const std::vector<GroupShape>& shapes)
      : body_(&body), shapes_(&shapes) {}

  /// Takes the particles `id` in the kernel's order, and marks what a step reads of idle blocks
  /// through these bonds. `two_deep`: forces depend on the neighbors of neighbors.
  void set_order(std::span<const std::int32_t> id, const BondLists<Real>& bonds, bool two_deep);
  /// Takes the new lists of some pieces: what a step reads through them from now on, and which idle
  /// blocks they pair with particles of others. `meets`: of a piece, whether it may.
  void watch(const kernel::Lists* lists, std::span<const std::uint32_t> pieces,
             const BondLists<Real>& bonds, const std::function<bool(std::size_t)>& meets);
  /// Wakes the blocks that are touched at this moment, and no others.
  void activate(BlockState<Real>& state, const Units& units);

  const Places& places() const { return places_; }
  InnerParticles inner_particles() const;
  std::size_t blocks() const { return role_.size(); }
  std::size_t pieces() const { return of_piece_.size(); }
  std::int32_t group_of_block(std::size_t b) const { return places_.group[b * block]; }
  bool is_idle(std::size_t b) const { return role_[b] == kernel::idle; }
  /// Whether it is idle unless it wakes.
  bool may_idle(std::size_t b) const { return idle_[b] != 0; }
  const std::vector<std::uint32_t>& active() const { return active_; }  ///< blocks, ascending
  std::int64_t row(std::size_t b) const { return role_[b]; }
  /// Rows of rims and of what is awake.
  std::size_t rows() const { return static_cast<std::size_t>(rows_) + active_.size(); }
  const std::vector<GroupRun>& rim() const { return rim_; }
  /// The rim, and what a step reads of idle blocks.
  const std::vector<GroupRun>& read_in_steps();
  /// Returns by piece the group that all of its particles are of, or -1.
  const std::vector<std::int32_t>& group_of_pieces() const { return of_piece_; }
  /// Returns by piece whether a step computes some of it.
  const std::vector<std::uint8_t>& working_pieces() const { return working_; }
  /// Fills what the kernel knows of the blocks.
  void put_into(kernel::Grouped<Real>& grouped) const;
  /// Calls visit(GroupRun) for what groups have among the places [begin, end).
  template <class Visit>
  void for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const;

 private:
  /// Particles of other groups, or free ones, at a difference from those of an idle block.
  struct Watched {
    std::uint32_t block;
    std::int32_t difference;
  };

  void find_places(std::span<const std::int32_t> id);
  void find_roles();
  void find_role(std::size_t b);
  void find_pieces();
  void read_through(const BondLists<Real>& bonds);
  void mark_read(std::ptrdiff_t first, std::ptrdiff_t last);
  void mark_bonds(std::size_t b, const BondLists<Real>& bonds);
  void mark_lists(std::size_t b, const kernel::Lists& lists);
  void watch_piece(const kernel::Lists& lists, std::size_t piece);
  void prepare_to_activate(std::uint32_t b, const BondLists<Real>& bonds);
  bool touches(const Watched& watched, BlockState<Real>& state, double range2) const;

  const Body* body_ = nullptr;
  const std::vector<GroupShape>* shapes_ = nullptr;
  Places places_;
  std::vector<std::int32_t> role_;      ///< one per block: kernel::Role, or a row
  std::vector<std::uint8_t> inactive_;  ///< one per block
  std::vector<std::uint8_t> whole_;     ///< one per block
  std::vector<std::uint8_t> idle_;      ///< one per block: idle unless it is awake
  std::vector<std::uint8_t> always_;    ///< one per block: idle, but read in every step
  std::vector<std::int32_t> of_piece_;
  std::vector<std::uint8_t> working_;
  std::vector<GroupRun> rim_;     ///< runs of the blocks with rows
  std::vector<GroupRun> steady_;  ///< placed before each step
  std::int32_t rows_ = 0;         ///< number of rows of rims; those of what is awake follow
  std::vector<std::vector<Watched>> watched_;  ///< one list per piece
  std::vector<std::uint32_t> watching_;        ///< pieces that have any, ascending
  std::vector<std::uint32_t> active_;
  bool two_deep_ = false, more_are_read_ = true;
};

template <class Real>
template <class Visit>
void GroupLayout<Real>::for_each_run(std::size_t begin, std::size_t end, const Visit& visit) const {
  const std::vector<std::int32_t>& group = places_.group;
  end = std::min(end, group.size());
  for (std::size_t k = begin; k < end;) {
    std::size_t last = k + 1;
    while (last < end && group[last] == group[k]) ++last;
    if (group[k] >= 0)
      visit(GroupRun{static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(last), group[k]});
    k = last;
  }
}

}  // namespace sinew
