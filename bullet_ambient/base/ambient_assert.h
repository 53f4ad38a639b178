#pragma once

namespace ambient {

/// Prints the condition with file and line to standard error, then aborts.
[[noreturn]] void failAssert(const char* condition, const char* file, int line) noexcept;

}  // namespace ambient

/// Checks a precondition or an invariant: false only by a mistake in this library or a broken
/// @pre. Every build type but Release (NDEBUG) checks the condition; Release compiles the
/// condition, but never evaluates it.
#if defined(NDEBUG)
#define AMBIENT_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define AMBIENT_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::ambient::failAssert(#condition, __FILE__, __LINE__))
#endif
