#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <new>

#include "tests/support/allocation_counter.h"

namespace ambient::test {
namespace {

void* volatile g_memory = nullptr;  // volatile: no allocation counts as unused

void* takeAligned() {
  void* memory = nullptr;
  return posix_memalign(&memory, 64, 128) == 0 ? memory : nullptr;
}

TEST(AllocationCounter, SeesOperatorNew) {
  const std::size_t count = allocationCount();
  g_memory = ::operator new(100);
  EXPECT_EQ(allocationCount(), count + 1);
  ::operator delete(g_memory);
}

TEST(AllocationCounter, SeesEveryFunctionOfTheCLibrary) {
  struct Way {
    const char* name;
    std::function<void*()> take;
  };
  const Way ways[] = {
      {"malloc", [] { return std::malloc(100); }},
      {"calloc", [] { return std::calloc(4, 25); }},
      {"realloc", [] { return std::realloc(nullptr, 100); }},
      {"aligned_alloc", [] { return std::aligned_alloc(64, 128); }},
      {"posix_memalign", takeAligned},
  };
  for (const Way& way : ways) {
    const std::size_t count = allocationCount(), bytes = allocatedBytes();
    g_memory = way.take();
    EXPECT_EQ(allocationCount(), count + 1) << way.name;
    EXPECT_GE(allocatedBytes(), bytes + 100) << way.name;
    std::free(g_memory);
  }
}

}  // namespace
}  // namespace ambient::test
