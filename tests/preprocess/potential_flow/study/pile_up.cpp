#include "tests/preprocess/potential_flow/study/pile_up.h"

#include <cmath>

namespace ambient::study {

Immersion beforePileUp(const Immersion& at) {
  const double wet = at.draught() / at.size();
  if (wet >= 1) return at;
  double low = 0, high = wet;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * (1 + kPileUp * std::pow(1 - middle, 8)) < wet ? low : high) = middle;
  }
  Immersion before = at;
  before.plane.height = at.low + low * at.size();
  return before;
}

}  // namespace ambient::study
