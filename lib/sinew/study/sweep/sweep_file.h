// SPDX-License-Identifier: GPL-3.0-or-later
// A study of one scene as a file: which of its settings vary, how, and what is asked of each run.
//
//     const SweepFile study = read_sweep("stiffness.yaml");
//     for (const std::vector<std::string>& values : values_of(study)) run(values);
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/settings/override.h>

namespace sinew {

/// An interval of numbers; of a logarithmic one, the ratios are even.
struct Interval {
  double from = 0, to = 0;
  bool logarithmic = false;
  /// The number at `part` of it, 0 to 1, rounded to six digits: the same on every machine.
  std::string at(double part) const;
};

/// A setting that varies.
struct VariedKey {
  std::string path;                 ///< path that --set takes
  std::vector<std::string> values;  ///< texts in the file; none of an interval of a random design
  std::optional<Interval> interval;
  Place place;
};

enum class DesignKind { grid, list, latin_hypercube, sobol };
inline constexpr std::array<std::string_view, 4> design_names = {"grid", "list", "latin_hypercube",
                                                                 "sobol"};

struct Design {
  DesignKind kind = DesignKind::grid;
  std::size_t samples = 0;  ///< number of runs of a random design
  std::int64_t seed = 1;
  Place place;

  bool is_random() const {
    return kind == DesignKind::latin_hypercube || kind == DesignKind::sobol;
  }
};

/// What of a quantity's values over a run is its result.
enum class ResultOf { worst, final, largest, at };
inline constexpr std::array<std::string_view, 4> result_words = {"worst", "final", "largest", "at"};

struct AskedResult {
  std::string name;  ///< a metric, or "grip: force_z"
  ResultOf of = ResultOf::worst;
  double time = 0;  ///< s
  Place place;

  std::string title() const;  ///< "volume_error", "grip: force_z, final", "speed_max, at 0.5 s"
};

/// What stays of the frames of a run.
enum class KeptFrames { last, metrics, all };
inline constexpr std::array<std::string_view, 3> kept_words = {"last", "metrics", "all"};

/// Paths in it are from its own folder.
struct SweepFile {
  std::filesystem::path path, scene;
  Place scene_place;
  std::vector<VariedKey> vary;
  Design design;
  std::vector<AskedResult> results;
  KeptFrames keep = KeptFrames::last;
  bool pictures = false, movie = false;  ///< asked for beside the small picture of the page
  std::vector<Override> fixed;           ///< settings of all runs
};

/// Throws bad input, with file, line and column: unknown keys, wrong types, a design without runs,
/// a metric that does not exist, a setting that is varied twice.
SweepFile read_sweep(const std::filesystem::path& path);

/// The varied values of each run, as `vary` has its keys.
std::vector<std::vector<std::string>> values_of(const SweepFile& study);

}  // namespace sinew
