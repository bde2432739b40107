// SPDX-License-Identifier: GPL-3.0-or-later
// The widest vectors that the flags of this source file allow, behind one interface: the kernel is
// written once over it, and every lane gets the same bits whatever the width.
//
// Doubles stores coordinates as they are. Floats stores them in fixed-point units, so that
// differences are exact and as fine at the far end of a body as in its middle.
//
// V, M, C                 numbers, masks, coordinates; one per lane
//     all, load, store, _coord  one value in all lanes; from and to memory, unaligned
//     root, size              square root, absolute value
//     larger, smaller         of two; the second where either is not a number
//     fused, less_fused       c + a b and c - a b, rounded once
//     less, at_most           comparisons, false where a lane is not a number
//     any, every              over the lanes
//     mask, bits              set where the bit of the lane is; the reverse
//     keep, pick, add_where   where the mask is set, else zero, `no`, or `sum` itself
//     difference, moved       a - b as a number; c displaced by one
#pragma once

#if defined(__AVX512F__)
#include <sinew/kernel/lanes_avx512.h>
namespace sinew::kernel {
namespace lanes = avx512;
}
#elif defined(__AVX2__)
#include <sinew/kernel/lanes_avx2.h>
namespace sinew::kernel {
namespace lanes = avx2;
}
#else
#include <sinew/kernel/lanes_plain.h>
namespace sinew::kernel {
namespace lanes = plain;
}
#endif
