// SPDX-License-Identifier: GPL-3.0-or-later
// What a person did, as a scene: keys of bones in a table beside it, springs and factors of loads
// and muscles as keys of the scene's own settings. `sinew run` makes the same steps of it.
//
//     Recording recording(settings, skeleton, grid);
//     recording.add(2, keys);                       // the bones at key 2
//     recording.write("out/play", "session", 7);    // session.yaml, session.keys.csv: seven keys
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/play/hand.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// The moments at which input counts, each a whole number of steps after the last. Their times are
/// exact: the step has few binary digits.
struct KeyGrid {
  double step = 0;  ///< s
  int steps = 1;    ///< number between two keys

  double interval() const { return step * steps; }
  double time(std::int64_t key) const { return static_cast<double>(key * steps) * step; }
};

/// About so many per second of the scene, with steps no longer than `max_step` (s).
KeyGrid key_grid(double max_step, double keys_per_second = 60);

/// The keys so far, and those of settings. Key numbers are those of the grid.
class Recording {
 public:
  /// `scene`: settings of the session, without a motion of their own.
  /// `twists`: whether bones twist about themselves, which the table has a column for.
  Recording(Settings scene, Skeleton skeleton, KeyGrid grid, bool twists);

  const KeyGrid& grid() const { return grid_; }
  const Settings& scene() const { return scene_; }
  Settings& scene() { return scene_; }

  /// Adds a key of each bone that has moved so far, or does now. `keys`: all bones at key `number`,
  /// which follows the last.
  void add(std::int64_t number, const BoneKeys& keys);
  std::int64_t last() const { return last_; }  ///< number of the last key; -1 before the first
  /// Bones at one of the last keys.
  const BoneKeys& at(std::int64_t number) const;

  /// The motion about some keys, which have these numbers from `first` on: between them it is that
  /// of the table.
  Motion motion_of(std::int64_t first, const std::vector<BoneKeys>& keys) const;
  /// About the last three.
  Motion motion_now() const {
    return motion_of(last_ + 1 - static_cast<std::int64_t>(recent_.size()), recent_);
  }

  /// Forgets the keys after `number`, of bones and of settings; `keys`: the bones at the last ones
  /// that remain, ascending.
  void truncate(std::int64_t number, std::vector<BoneKeys> keys);

  /// The recording's scene, which ends with key `end`; its table is `table`.
  Settings settings_until(std::int64_t end, const std::filesystem::path& table) const;
  /// Writes NAME.yaml and NAME.keys.csv; both are whole at any moment. Throws not written.
  void write(const std::filesystem::path& folder, const std::string& name, std::int64_t end) const;
  /// Writes what has changed since it was called last, keys first. Throws not written.
  void keep(const std::filesystem::path& folder, const std::string& name, std::int64_t end);

 private:
  /// A key of a bone.
  struct Row {
    std::int64_t number = 0;
    int bone = 0;
    LocalMotion key;
  };

  std::string rows_text(std::size_t from) const;
  void write_scene(const std::filesystem::path& folder, const std::string& name,
                   std::int64_t end) const;

  Settings scene_;
  Skeleton skeleton_;
  KeyGrid grid_;
  bool twists_;
  std::int64_t last_ = -1;
  std::vector<BoneKeys> recent_;        ///< bones at the last three keys
  std::vector<char> moved_;             ///< one per bone: whether it has keys
  std::vector<Row> rows_;               ///< in order of time
  std::size_t kept_ = 0;                ///< rows on disk
  std::unique_ptr<GrowingFile> table_;  ///< where they are
};

}  // namespace sinew
