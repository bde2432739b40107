// SPDX-License-Identifier: GPL-3.0-or-later
// The threads behind parallel.h: oneTBB's, or with SINEW_THREADS=std plain std::thread, which
// ThreadSanitizer can follow.
//
//     run_pieces(count, Deal::as_free, [&](std::size_t piece) { work(piece); });
#pragma once

#include <cstddef>
#include <functional>

namespace sinew {

/// How many threads a parallel loop of the caller may use.
int threads_allowed();

/// Whether pieces are assigned as threads become free, or evenly beforehand.
enum class Deal { as_free, evenly };

/// Calls piece(0), ... piece(count - 1) once each, on any of the allowed threads, in any order.
/// Throws the exception of the first piece that fails.
void run_pieces(std::size_t count, Deal deal, const std::function<void(std::size_t)>& piece);

}  // namespace sinew
