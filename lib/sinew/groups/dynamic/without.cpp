// SPDX-License-Identifier: GPL-3.0-or-later
// Groups that change, where sinew is built without groups: nobody gets any.
#include <sinew/groups/dynamic/dynamic_groups.h>

namespace sinew {

DynamicGroups::DynamicGroups(std::shared_ptr<const Body> body, Motion, double,
                             const DynamicOptions&) {
  check_groupable(*body);  // throws
}

bool DynamicGroups::must_split(const GroupingMoment&, std::span<const ConstrainedCell>) const {
  return false;
}

bool DynamicGroups::may_join(const GroupingMoment&, std::size_t) const { return false; }

NewGroups DynamicGroups::regroup(const GroupingMoment&, std::span<const ConstrainedCell>,
                                 const Particles&) const {
  return {};
}

}  // namespace sinew
