#pragma once

#include <cstddef>

namespace ambient::test {

// Linking ambient_allocation_counter makes a program count calls of the C library's allocator.
// Counts malloc, calloc, realloc and their aligned forms, and so operator new, Eigen, Bullet and
// libraries in C.

/// Calls so far, by all threads.
std::size_t allocationCount();

/// Bytes asked for so far, by all threads.
std::size_t allocatedBytes();

}  // namespace ambient::test
