// SPDX-License-Identifier: GPL-3.0-or-later
// Adds the scene's line to errors: algorithms report values, a scene has their lines.
//
//     const auto skeleton = at_keys(settings, "skeleton.", [&] { return make_skeleton(bones); });
#pragma once

#include <string>

#include <sinew/core/error.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// Runs `job`; adds the place of the scene's `key` to its errors.
template <class Job>
auto with_context(const Settings& settings, const char* key, Job&& job) {
  try {
    return job();
  } catch (const Error& error) {
    const Place place = settings.place(key);
    if (place.file == settings.body.mesh)
      throw;  // a mesh without a scene: the error names it already
    throw error.with_context(place);
  }
}

/// Runs `job`; adds to a bad_value the place of its key in the scene, after `prefix`.
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
