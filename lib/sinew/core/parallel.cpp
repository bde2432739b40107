// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/core/parallel.h>

#include <algorithm>
#include <vector>

#include <sinew/core/threads.h>

namespace sinew {

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t pieces = (count + grain - 1) / grain;
  if (pieces <= 1) {
    if (count > 0) body(0, count);
    return;
  }
  run_pieces(pieces, Deal::as_free,
             [&](std::size_t piece) { body(piece * grain, std::min(count, (piece + 1) * grain)); });
}

void parallel_split(std::size_t count, std::size_t least,
                    const std::function<void(std::size_t, std::size_t)>& body) {
  const auto threads = static_cast<std::size_t>(threads_allowed());
  const std::size_t parts = std::min(threads, count / std::max<std::size_t>(least, 1));
  if (parts <= 1) {
    if (count > 0) body(0, count);
    return;
  }
  run_pieces(parts, Deal::evenly,
             [&](std::size_t part) { body(part * count / parts, (part + 1) * count / parts); });
}

double parallel_sum(std::size_t count, std::size_t grain,
                    const std::function<double(std::size_t, std::size_t)>& piece) {
  std::vector<double> sums((count + grain - 1) / grain);
  parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    sums[begin / grain] = piece(begin, end);
  });
  double sum = 0;  // in the order of the pieces, whichever thread computed them
  for (const double part : sums) sum += part;
  return sum;
}

}  // namespace sinew
