// SPDX-License-Identifier: GPL-3.0-or-later
#define SINEW_PLAIN_LANES
#include <sinew/physics/kernel/functions.h>
#include <sinew/physics/kernel/tables.h>

namespace sinew::kernel {

const Functions<double> doubles_plain = functions<lanes::Doubles>();
const Functions<float> floats_plain = functions<lanes::Floats>();

}  // namespace sinew::kernel
