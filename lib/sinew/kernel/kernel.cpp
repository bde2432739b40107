// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's functions for one set of instructions: this source is compiled once for each, with
// its flags, and SINEW_INSTRUCTIONS naming it.
#include <sinew/kernel/functions.h>
#include <sinew/kernel/kernel.h>

#define SINEW_JOIN(name, set) name##_##set
#define SINEW_NAME(name, set) SINEW_JOIN(name, set)

namespace sinew::kernel {

const Functions<double> SINEW_NAME(doubles, SINEW_INSTRUCTIONS) = functions<lanes::Doubles>();
const Functions<float> SINEW_NAME(floats, SINEW_INSTRUCTIONS) = functions<lanes::Floats>();

}  // namespace sinew::kernel
