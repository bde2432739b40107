// SPDX-License-Identifier: GPL-3.0-or-later
// The limits of this machine: fused multiply-adds in registers, and streaming through memory.
// Compiled with contraction and for every instruction set, unlike anything in lib.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sinew::bench {

enum class InstructionSet { baseline, avx2, avx512 };

/// The widest of this processor.
InstructionSet widest();
const char* name_of(InstructionSet set);

/// Multiply-adds of independent vectors, `rounds` times; returns the number of operations, 2 for a
/// multiply-add.
double multiply_add_single(InstructionSet set, std::int64_t rounds);
double multiply_add_double(InstructionSet set, std::int64_t rounds);

/// a[i] = b[i] + 3 c[i], the triad of McCalpin's STREAM, for i in [begin, end).
void triad(InstructionSet set, double* a, const double* b, const double* c, std::size_t begin,
           std::size_t end);

}  // namespace sinew::bench
