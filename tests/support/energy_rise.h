#pragma once

#include <algorithm>

namespace ambient::test {

/// Follows an energy that must not rise, from its value at the start.
class EnergyRise {
 public:
  explicit EnergyRise(double start) : start_(start), lowest_(start) {}

  void see(double energy) {
    over_earlier_ = std::max(over_earlier_, energy - lowest_);
    over_start_ = std::max(over_start_, energy - start_);
    lowest_ = std::min(lowest_, energy);
  }
  /// Forgets what came before.
  void beginAt(double energy) { lowest_ = energy; }

  double lowest() const { return lowest_; }
  double overEarlier() const { return over_earlier_; }  ///< largest rise above an earlier value
  double overStart() const { return over_start_; }      ///< largest rise above the start

 private:
  double start_, lowest_, over_earlier_ = 0, over_start_ = 0;
};

}  // namespace ambient::test
