// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory a piece of work needs at most.
#pragma once

#include <functional>

namespace sinew::bench {

/// Bytes by which the resident memory of this process grows at most while `job` runs; of use where
/// these are many megabytes. Throws Error where the system does not tell.
double peak_memory_of(const std::function<void()>& job);

}  // namespace sinew::bench
