// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/kernel/tables.h"

#include "physics/kernel/functions.h"

namespace sinew::kernel {

const Functions<double> doubles_avx512 = functions<lanes::Doubles>();
const Functions<float> floats_avx512 = functions<lanes::Floats>();

}  // namespace sinew::kernel
