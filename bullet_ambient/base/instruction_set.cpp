#include "bullet_ambient/base/instruction_set.h"

#include <cstdlib>
#include <cstring>
#include <initializer_list>

namespace ambient {
namespace {

bool isAllowed(InstructionSet set) noexcept {
  const char* largest = std::getenv("BULLET_AMBIENT_KERNELS");
  if (largest == nullptr) return true;
  if (std::strcmp(largest, "baseline") == 0) return set == InstructionSet::kBaseline;
  if (std::strcmp(largest, "avx2") == 0) return set != InstructionSet::kAvx512;
  return true;
}

InstructionSet findFastest() noexcept {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (isSupported(set) && isAllowed(set)) return set;
  return InstructionSet::kBaseline;
}

}  // namespace

bool isSupported(InstructionSet instruction_set) noexcept {
#if defined(__x86_64__)
#if BULLET_AMBIENT_AVX512
  if (instruction_set == InstructionSet::kAvx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
#endif
  if (instruction_set == InstructionSet::kAvx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return instruction_set == InstructionSet::kBaseline;
}

InstructionSet fastestInstructionSet() noexcept {
  static const InstructionSet fastest = findFastest();
  return fastest;
}

}  // namespace ambient
