#pragma once

namespace ambient::test {

/// Returns how many of `all` arbitrary runs are done: all, or, where long tests are left out
/// (BULLET_AMBIENT_LONG_TESTS), a sixth, at least 3.
constexpr unsigned runsOf(unsigned all) {
  constexpr unsigned kLeast = 3, kShare = 6;
  return AMBIENT_LONG_TESTS || all < kLeast ? all : kLeast + (all - kLeast) / kShare;
}

}  // namespace ambient::test
