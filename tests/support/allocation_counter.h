#pragma once

#include <cstddef>

namespace ambient::test {

// Linking ambient_allocation_counter replaces the global operator new of the program by one that
// counts.

/// Number of calls of operator new so far, by all threads.
std::size_t allocationCount();

/// Bytes asked of operator new so far, by all threads.
std::size_t allocatedBytes();

}  // namespace ambient::test
