// SPDX-License-Identifier: GPL-3.0-or-later
// Checkpoints: all of a run that steps change, for --resume.
//
// DIR/a.bin and DIR/b.bin are written in turn, each beside its place, synced and renamed, so that
// one whole checkpoint is there at any moment. Format, of version 1, in the machine's own byte
// order (which a mark tells):
//   "SINEWCKP", mark u32, version u32, length of the file u64,
//   sections: name (8 bytes), bytes of an element u64, elements u64, the elements,
//   FNV-1a of all bytes before, u64.
// Sections come in one order; a section with another name or element than expected is refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <sinew/core/simulation_state.h>

namespace sinew {

/// Whose checkpoint it is. Only the same program, scene and body go on from it with the same bits.
struct RunIdentity {
  std::string program;       ///< version of it
  std::uint64_t scene = 0;   ///< hash of all settings that decide about bits
  std::uint64_t body = 0;    ///< hash of the particles at rest and what holds them
  std::uint64_t motion = 0;  ///< hash of what moves
  std::uint64_t particles = 0;
  double time_step = 0;  ///< s

  bool operator==(const RunIdentity&) const = default;
};

struct Checkpoint {
  RunIdentity run;
  SimulationState state;
};

/// Throws not written.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws bad input, naming the file, when it is no whole checkpoint of `particles` particles that
/// this machine and this version can read. Allocates no more than the file's size.
Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t particles);

/// The checkpoints of one run, in turn.
class Checkpoints {
 public:
  explicit Checkpoints(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Writes over the older one of the two. Creates the folder. Throws not written.
  void write(const Checkpoint& checkpoint);

  /// The newest that is whole, nothing when no file is there. `complaint` tells of one that is
  /// not. Throws bad input when there are only broken ones. Removes what was left half written.
  std::optional<Checkpoint> newest(std::uint64_t particles, std::string& complaint);

 private:
  std::filesystem::path folder_;
  int next_ = 0;  ///< to be written over: 0 a.bin, 1 b.bin
};

}  // namespace sinew
