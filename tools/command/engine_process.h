// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS at work for a run: mpirun and the ranks that it starts, which end with this program.
//
//     EngineOptions options;
//     declare(list, options);
//     if (options.chosen()) how.engine = lammps_engine(options);
#pragma once

#include <string>

#include <sinew/run/engine_steps.h>
#include "command/option_list.h"

namespace sinew {

/// The options of `run` and `simulate` about who makes the steps.
struct EngineOptions {
  std::string engine = "built-in", hosts;
  int ranks = 0;  ///< 0: one per core
  bool gather = false;

  bool chosen() const { return engine != "built-in"; }
};

void declare(OptionList& list, EngineOptions& options);

/// Spells options as words of a command line.
std::vector<std::string> words_of(const EngineOptions& options);

/// Throws bad input for an unknown engine, options that need one, and what is not installed.
std::optional<Engine> engine_of(const EngineOptions& options);

}  // namespace sinew
