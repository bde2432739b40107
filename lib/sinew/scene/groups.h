// SPDX-License-Identifier: GPL-3.0-or-later
// The groups of a scene's particles, as section hierarchy asks for them.
//
//     if (const auto sizes = group_sizes(settings, body))
//       body.grouping = groups_that_stay(settings, body, motion, *sizes);
#pragma once

#include <memory>
#include <optional>

#include <sinew/body/body.h>
#include <sinew/body/grouping.h>
#include <sinew/groups/make_grouping.h>
#include <sinew/rig/motion.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// How large groups are, and what stays free; none where the scene asks for no groups. Throws bad
/// input, with the scene's line, where it cannot have any.
std::optional<GroupSizes> group_sizes(const Settings& settings, const Body& body,
                                      const Motion& motion);

/// What is far from all joints that move within the run.
std::shared_ptr<const Grouping> groups_that_stay(const Settings& settings, const Body& body,
                                                 const Motion& motion, const GroupSizes& sizes);

/// About how many particles the scene needs so that steps with these groups take less time than
/// without: their rims are a fraction of the body that falls with the third root of their number.
/// `time_ratio`: measured, of the time of steps without groups; the grouping may have smaller
/// groups than `sizes` asks for, but some.
double groups_pay_from(const Grouping& grouping, const GroupSizes& sizes, double time_ratio);

}  // namespace sinew
