#pragma once

#include <cstddef>

namespace ambient::test {

// Linking ambient_allocation_counter replaces the global operator new of the program by one that
// counts.

/// Number of calls of operator new so far, by all threads.
std::size_t allocationCount();

/// Number of calls of malloc() so far, by all threads: by operator new, Eigen and Bullet. Always 0
/// under sanitizers, which have a malloc() of their own.
std::size_t mallocCount();

/// Bytes asked of operator new so far, by all threads.
std::size_t allocatedBytes();

}  // namespace ambient::test
