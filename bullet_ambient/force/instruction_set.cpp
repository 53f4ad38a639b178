#include "bullet_ambient/force/instruction_set.h"

namespace ambient {

bool isSupported(InstructionSet instruction_set) noexcept {
#if defined(__x86_64__)
  if (instruction_set == InstructionSet::kAvx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  if (instruction_set == InstructionSet::kAvx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return instruction_set == InstructionSet::kBaseline;
}

}  // namespace ambient
