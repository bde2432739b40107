// SPDX-License-Identifier: GPL-3.0-or-later
// Checkpoints: all state of a run that steps change, for --resume.
//
//     Checkpoints checkpoints("out/bend/checkpoint");
//     checkpoints.write({run, simulation_state});
//     const std::optional<Checkpoint> last = checkpoints.newest(particles, complaint);
//
// DIR/a.bin and DIR/b.bin are written in turn, each to a temporary file that is synced and renamed,
// so that a complete checkpoint exists at any time. Format, in the machine's byte order
// (which a mark identifies):
//   "SINEWCKP", mark u32, version u32, length of the file u64,
//   "program" (8 bytes), 1 u64, its length u64, the version of the program that wrote it,
//   run and state as core/archive.h has them,
//   FNV-1a of all bytes before, u64.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <sinew/core/simulation_state.h>

namespace sinew {

/// The run that a checkpoint belongs to. Only the same program, scene and body continue from it
/// with the same bits.
struct RunIdentity {
  std::string program;       ///< its version
  std::uint64_t scene = 0;   ///< hash of all settings that affect the result
  std::uint64_t body = 0;    ///< hash of the particles at rest and their attachment
  std::uint64_t motion = 0;  ///< hash of all motions
  std::uint64_t particles = 0;
  double time_step = 0;  ///< s

  bool operator==(const RunIdentity&) const = default;
};

struct Checkpoint {
  RunIdentity run;
  SimulationState state;
  std::uint64_t number = 0;  ///< number among those that the run has written
};

/// Throws not written.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws bad input, naming the file, where it is not a complete checkpoint of `particles`
/// particles that this machine and version can read. Allocates no more than the file's size.
Checkpoint read_checkpoint(const std::filesystem::path& file, std::uint64_t particles);

/// The two alternating checkpoints of a run.
class Checkpoints {
 public:
  explicit Checkpoints(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Replaces the older one. Creates the folder. Throws not written.
  void write(Checkpoint checkpoint);

  /// The newest complete one, nothing where there is no file. `complaint` names one that is
  /// damaged. Throws bad input where all are damaged. Removes incomplete temporary files.
  std::optional<Checkpoint> newest(std::uint64_t particles, std::string& complaint);

 private:
  std::filesystem::path folder_;
  int next_ = 0;  ///< to be replaced: 0 a.bin, 1 b.bin
  std::uint64_t written_ = 0;
};

}  // namespace sinew
