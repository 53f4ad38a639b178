#pragma once

namespace ambient {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// Whether this processor has it.
bool isSupported(InstructionSet instruction_set) noexcept;

/// The largest one that this processor has and the environment variable BULLET_AMBIENT_KERNELS
/// allows: `baseline`, `avx2` or `avx512`; all if it is not set. It is read once in a program.
InstructionSet fastestInstructionSet() noexcept;

/// Where functions are that are compiled once per instruction set, with the same bits; processors
/// of other families have the baseline three times. Such functions share no inline function with
/// the rest of the program: the linker may take any of its copies.
template <class Pointer>
struct Kernels {
  Pointer baseline, avx2, avx512;

  /// Null if this processor does not have the instruction set.
  Pointer of(InstructionSet set) const noexcept {
    if (!isSupported(set)) return nullptr;
    if (set == InstructionSet::kAvx512) return avx512;
    return set == InstructionSet::kAvx2 ? avx2 : baseline;
  }
  Pointer fastest() const noexcept { return of(fastestInstructionSet()); }
};

}  // namespace ambient
