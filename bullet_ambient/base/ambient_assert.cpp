#include "bullet_ambient/base/ambient_assert.h"

#include <cstdio>
#include <cstdlib>

namespace ambient {

void failAssert(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "bullet_ambient: %s:%d: this must hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace ambient
