#pragma once

#include <cstddef>

namespace ambient::test {

// Linking ambient_allocation_counter replaces the global operator new of the program by one that
// counts.

/// Number of calls of operator new so far, by all threads.
std::size_t allocationCount();

/// Number of calls of malloc() so far, by all threads: by operator new, Eigen and Bullet. 0
/// where countsMallocs() is false: under sanitizers, which have a malloc() of their own.
std::size_t mallocCount();
bool countsMallocs();

/// Bytes asked of operator new so far, by all threads.
std::size_t allocatedBytes();

}  // namespace ambient::test
