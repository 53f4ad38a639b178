#include "preprocess/added_mass_tables/chebyshev_series.h"

#include <gtest/gtest.h>

namespace ambient {
namespace {

TEST(ChebyshevSeries, IsTheSumOfItsTerms) {
  constexpr double kCoefficients[] = {1, 2, 3, 4, 5, 6};
  const ChebyshevSeries series{3, 2, kCoefficients};
  for (const double x : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
    for (const double y : {-1.0, 0.2, 1.0}) {
      const double expected = 1 + 2 * y + (3 + 4 * y) * x + (5 + 6 * y) * (2 * x * x - 1);
      EXPECT_NEAR(series(x, y), expected, 1e-14);
    }
  }
}

TEST(ChebyshevSeries, OneColumnDoesNotDependOnTheSecondVariable) {
  constexpr double kCoefficients[] = {1, 2, 3};
  const ChebyshevSeries series{3, 1, kCoefficients};
  EXPECT_NEAR(series(0.5, 0.9), 1 + 2 * 0.5 + 3 * (2 * 0.25 - 1), 1e-15);
}

}  // namespace
}  // namespace ambient
