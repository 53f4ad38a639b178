#pragma once

namespace ambient {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };

/// Returns true if this processor has the instruction set, and this build the kernels for it.
bool isSupported(InstructionSet instruction_set) noexcept;

/// Largest instruction set that this processor has and that BULLET_AMBIENT_KERNELS allows. This
/// environment variable is `baseline`, `avx2`, `avx512` or unset: all allowed. Read once.
InstructionSet fastestInstructionSet() noexcept;

/// Pointers to one function, compiled once per instruction set; all give the same bits. Builds for
/// processors other than x86-64 hold the baseline three times. These functions must share no inline
/// function with the rest of the program: the linker keeps any one copy of an inline function.
template <class Pointer>
struct Kernels {
  Pointer baseline, avx2, avx512;

  /// Function for the instruction set; null if isSupported() returns false.
  Pointer of(InstructionSet set) const noexcept { return isSupported(set) ? choose(set) : nullptr; }
  /// Function for fastestInstructionSet().
  Pointer fastest() const noexcept { return choose(fastestInstructionSet()); }

 private:
  Pointer choose(InstructionSet set) const noexcept {
    if (set == InstructionSet::kAvx512) return avx512;
    return set == InstructionSet::kAvx2 ? avx2 : baseline;
  }
};

}  // namespace ambient

// Appends Baseline, Avx2 or Avx512 to the name of a kernel. Its source is compiled once per
// instruction set by ambient_add_kernels() of AmbientTargets.cmake.
#define AMBIENT_JOIN_NAMES(name, suffix) name##suffix
#define AMBIENT_KERNEL_OF_SET(name, suffix) AMBIENT_JOIN_NAMES(name, suffix)
#define AMBIENT_KERNEL(name) AMBIENT_KERNEL_OF_SET(name, AMBIENT_INSTRUCTION_SET)

// The three pointers of Kernels to a kernel `name` or to its table `&name`, in sources that CMake
// gives BULLET_AMBIENT_AVX512: 0 in builds without the kernels for AVX-512, else 1.
#if defined(BULLET_AMBIENT_AVX512) && BULLET_AMBIENT_AVX512
#define AMBIENT_KERNELS(name) name##Baseline, name##Avx2, name##Avx512
#else
#define AMBIENT_KERNELS(name) name##Baseline, name##Avx2, nullptr
#endif
