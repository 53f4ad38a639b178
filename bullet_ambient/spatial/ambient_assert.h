#pragma once

namespace ambient {

/// Says on standard error what did not hold, and aborts.
[[noreturn]] void failAssert(const char* condition, const char* file, int line) noexcept;

}  // namespace ambient

/// A precondition or an invariant of ours: false only by a mistake in this library or a broken
/// @pre. Checked in every build type but Release (NDEBUG); there it is compiled, but never
/// evaluated.
#if defined(NDEBUG)
#define AMBIENT_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define AMBIENT_ASSERT(condition) \
  ((condition) ? static_cast<void>(0) : ::ambient::failAssert(#condition, __FILE__, __LINE__))
#endif
