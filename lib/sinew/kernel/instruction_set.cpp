// SPDX-License-Identifier: GPL-3.0-or-later
#include <initializer_list>

#include <sinew/kernel/kernel.h>

namespace sinew::kernel {

bool has(InstructionSet set) {
#ifdef SINEW_AVX512
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
#endif
#ifdef SINEW_AVX2
  if (set == InstructionSet::avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return set == InstructionSet::plain;
}

InstructionSet best_instruction_set() {
  for (const auto set : {InstructionSet::avx512, InstructionSet::avx2})
    if (has(set)) return set;
  return InstructionSet::plain;
}

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return "avx512";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::plain:
      break;
  }
  return "plain";
}

template <>
Functions<double> functions_of(InstructionSet set) {
#ifdef SINEW_AVX512
  if (set == InstructionSet::avx512) return doubles_avx512;
#endif
#ifdef SINEW_AVX2
  if (set == InstructionSet::avx2) return doubles_avx2;
#endif
  static_cast<void>(set);
  return doubles_plain;
}

template <>
Functions<float> functions_of(InstructionSet set) {
#ifdef SINEW_AVX512
  if (set == InstructionSet::avx512) return floats_avx512;
#endif
#ifdef SINEW_AVX2
  if (set == InstructionSet::avx2) return floats_avx2;
#endif
  static_cast<void>(set);
  return floats_plain;
}

}  // namespace sinew::kernel
