// SPDX-License-Identifier: GPL-3.0-or-later
// Results of a run that are recorded, to be compared with those of later runs: a gate against
// changes.
//
//     write_file("baseline.csv", baseline_csv("out/bend"));
//     const std::vector<Difference> found = compare_with_baseline("out/bend", "baseline.csv");
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sinew {

/// A row of each result of a measured run: name, of (final, worst, largest), value, absolute,
/// relative. The last two are tolerances to be edited: a result may differ by absolute + relative
/// |value|; "ignored" as relative takes any. Throws bad input for a folder without metrics.
std::string baseline_csv(const std::filesystem::path& run);

/// A result that is not as it was.
struct Difference {
  std::string name, of;
  double before = 0, now = 0;  ///< not-a-number where it is not there
  double allowed = 0;
};

/// What differs by more than its tolerance, and results that only one of the two has. Throws bad
/// input, with the line, for a table that is none.
std::vector<Difference> compare_with_baseline(const std::filesystem::path& run,
                                              const std::filesystem::path& baseline);

}  // namespace sinew
