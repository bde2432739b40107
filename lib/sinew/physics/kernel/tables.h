// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for each instruction set, each compiled in a source file of its own.
#pragma once

#include <sinew/physics/kernel/kernel.h>

namespace sinew::kernel {

extern const Functions<double> doubles_plain;
extern const Functions<float> floats_plain;
#if defined(__x86_64__)
extern const Functions<double> doubles_sse2, doubles_avx2, doubles_avx512;
extern const Functions<float> floats_sse2, floats_avx2, floats_avx512;
#endif

}  // namespace sinew::kernel
