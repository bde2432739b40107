// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a scene an error has its cause: the algorithms know values, a scene knows their lines.
//
//     const Skeleton skeleton = at_keys(settings, "skeleton.", [&] { return make_skeleton(bones);
//     });
#pragma once

#include <string>

#include <sinew/core/error.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Runs `job`; what it throws is reported as reached through a line of the scene.
template <class Job>
auto with_context(const Settings& settings, const char* key, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    const Place place = settings.place(key);
    if (place.file == settings.body.mesh) throw;  // a mesh without a scene: it names itself
    throw error.with_context(place);
  }
}

/// Runs `job`; a bad_value is reported at the line of the scene that gave it: its key behind
/// `prefix`.
template <class Job>
auto at_keys(const Settings& settings, const std::string& prefix, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    if (error.key().empty()) throw;
    throw error.with_context(settings.place(prefix + error.key()));
  }
}

}  // namespace sinew
