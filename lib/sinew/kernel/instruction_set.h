// SPDX-License-Identifier: GPL-3.0-or-later
// The sets of instructions for which the kernel is compiled; all give the same bits.
#pragma once

namespace sinew::kernel {

enum class InstructionSet { plain, avx2, avx512 };

/// The best one this processor supports.
InstructionSet best_instruction_set();
/// Whether this processor and this build support it.
bool has(InstructionSet set);
const char* name_of(InstructionSet set);

}  // namespace sinew::kernel
