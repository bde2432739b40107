// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cleaning_counts.h"

namespace sinew {

std::span<const NamedCount> cleaning_counts() {
  using C = CleaningCounts;
  using Of = NamedCount::Of;
  static constexpr NamedCount table[] = {
      {"points_read", &C::points_read, Of::file},
      {"faces_read", &C::polygons_read, Of::file},
      {"polygons_cut", &C::polygons_cut, Of::cleaning},
      {"points_merged", &C::points_merged, Of::cleaning},
      {"points_unused", &C::points_unused, Of::cleaning},
      {"faces_collapsed", &C::faces_collapsed, Of::cleaning},
      {"faces_doubled", &C::faces_doubled, Of::cleaning},
      {"faces_flat", &C::faces_flat, Of::cleaning},
      {"faces_turned", &C::faces_turned, Of::cleaning},
      {"edges_twisted", &C::edges_twisted, Of::cleaning},
      {"holes_closed", &C::holes_closed, Of::repair},
      {"faces_added", &C::faces_added, Of::repair},
      {"faces_wrapped", &C::faces_wrapped, Of::repair},
  };
  return table;
}

}  // namespace sinew
