// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/physics/kernel/functions.h>
#include <sinew/physics/kernel/tables.h>

namespace sinew::kernel {

const Functions<double> doubles_avx2 = functions<lanes::Doubles>();
const Functions<float> floats_avx2 = functions<lanes::Floats>();

}  // namespace sinew::kernel
