// SPDX-License-Identifier: GPL-3.0-or-later
// Finds filled sites by their place in an FCC lattice.
//
//     const SiteIndex index(filled.lattice, filled.runs);
//     const std::int64_t site = index.at(place);
#pragma once

#include <cstdint>
#include <vector>

#include <sinew/fill/filled_sites.h>

namespace sinew {

class SiteIndex {
 public:
  /// `runs` sorted by row and site. Both must outlive this.
  SiteIndex(const Lattice& lattice, const std::vector<Run>& runs);

  /// The run with that site, or none.
  const Run* run_at(const LatticePlace& place) const;
  /// The number of the site in the order of the runs, or -1.
  std::int64_t at(const LatticePlace& place) const;

 private:
  int number_in_row(std::int64_t row, const LatticePlace& place) const {
    return (place[0] - lattice_.rows[static_cast<std::size_t>(row)].first[0]) / lattice_.along[0];
  }

  const Lattice& lattice_;
  const std::vector<Run>& runs_;
  std::vector<std::size_t> first_run_, site_;  ///< first run of each row; sites before each run
};

/// The places of the runs' sites, in their order.
std::vector<LatticePlace> places_of(const FilledSites& filled);

}  // namespace sinew
