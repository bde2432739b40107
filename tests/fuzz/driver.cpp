// SPDX-License-Identifier: GPL-3.0-or-later
// The entry that libFuzzer calls, for the target that the build names.
#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  sinew::fuzz::SINEW_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
