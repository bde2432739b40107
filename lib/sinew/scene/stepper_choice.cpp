// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/scene/stepper_choice.h>

namespace sinew {
namespace {

using kernel::InstructionSet;

// Measured with a bent body of 1e5 particles, whole steps, on a server core of about 2.5 GHz.
// Vectors of half the width do not take twice as long: loads and list construction stay the same.
// Without fused multiply-add instructions each one is a function call.
struct Speed {
  InstructionSet set;
  double in_double, in_single;  // particle-steps per second
};
constexpr Speed speeds_with_lists[] = {{InstructionSet::avx512, 35e6, 75e6},
                                       {InstructionSet::avx2, 23e6, 50e6},
                                       {InstructionSet::plain, 0.8e6, 1.3e6}};
// Whatever the instruction set: cells are sorted again, and pairs processed one by one.
constexpr double speed_with_cells = 2e6;

}  // namespace

StepperChoice stepper_choice(const SolverSettings& solver) {
  StepperChoice choice{solver.neighbor_search, solver.precision};
  if (choice.search == NeighborSearch::cells) {
    choice.precision = Precision::binary64;
    choice.instructions = InstructionSet::plain;
  }
  return choice;
}

const char* name_of(NeighborSearch search) {
  return search == NeighborSearch::lists ? "lists" : "cells";
}

const char* name_of(Precision precision) {
  return precision == Precision::binary64 ? "double" : "single";
}

double usual_speed(const StepperChoice& choice) {
  if (choice.search == NeighborSearch::cells) return speed_with_cells;
  for (const Speed& speed : speeds_with_lists)
    if (speed.set == choice.instructions)
      return choice.precision == Precision::binary64 ? speed.in_double : speed.in_single;
  return speed_with_cells;
}

}  // namespace sinew
