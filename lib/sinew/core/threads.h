// SPDX-License-Identifier: GPL-3.0-or-later
// The threads behind parallel.h: oneTBB's, or with SINEW_THREADS=std plain std::thread, which
// ThreadSanitizer sees through.
#pragma once

#include <cstddef>
#include <functional>

namespace sinew {

/// How many threads a parallel loop of the caller may use.
int threads_allowed();

/// Whether pieces are handed out as threads become free, or dealt out evenly beforehand.
enum class Deal { as_free, evenly };

/// Calls piece(0), ... piece(count - 1) once each, on any of the allowed threads, in any order.
/// Throws what the first piece to fail has thrown.
void run_pieces(std::size_t count, Deal deal, const std::function<void(std::size_t)>& piece);

}  // namespace sinew
