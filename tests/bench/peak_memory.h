// SPDX-License-Identifier: GPL-3.0-or-later
// Peak memory of a piece of work.
#pragma once

#include <functional>

namespace sinew::bench {

/// Bytes by which the resident memory of this process grows at most while `job` runs; meaningful
/// for many megabytes. Throws Error where the system does not report it.
double peak_memory_of(const std::function<void()>& job);

}  // namespace sinew::bench
