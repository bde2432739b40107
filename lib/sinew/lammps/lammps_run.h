// SPDX-License-Identifier: GPL-3.0-or-later
// A run stepped by LAMMPS, on as many ranks as there are. Every rank calls this:
//
//     const Ranks ranks(argc, argv);
//     step_on_lammps(folder, {interruption, say});
//
// LAMMPS ends the process where it finds an error itself; its words are in the folder's log.
#pragma once

#include <functional>

#include <sinew/core/error.h>
#include <sinew/engine/engine_files.h>
#include <sinew/engine/engine_talk.h>

namespace sinew {

/// The processes of this run, of which this is one, while this object lives.
class Ranks {
 public:
  Ranks(int argc, char** argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  static bool first();  ///< whether this is the one that speaks
  /// Ends all of them at once.
  [[noreturn]] void abort(int code) const;
};

struct LammpsTalk {
  std::function<Interruption()> interruption;          ///< asked by every rank in every step
  std::function<void(const EngineStatus&)> news = {};  ///< called on rank 0
};

/// Steps the run in the folder to its end and writes a state at every frame, and where a step is
/// interrupted; the state before a step that failed. Without frames it writes that of the start.
/// Returns done, interrupted or unstable. Throws bad input and not written.
Exit step_on_lammps(const EngineFolder& folder, const LammpsTalk& talk);

}  // namespace sinew
