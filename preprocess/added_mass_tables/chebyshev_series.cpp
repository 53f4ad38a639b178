#include "preprocess/added_mass_tables/chebyshev_series.h"

namespace ambient {
namespace {

/// Clenshaw's sum of c_i T_i(x), where coefficient(i) is c_i.
template <class Coefficient>
double chebyshevSum(int count, double x, const Coefficient& coefficient) {
  double last = 0, before = 0;
  for (int i = count - 1; i > 0; --i) {
    const double next = coefficient(i) + 2 * x * last - before;
    before = last;
    last = next;
  }
  return coefficient(0) + x * last - before;
}

}  // namespace

double ChebyshevSeries::operator()(double x, double y) const {
  return chebyshevSum(rows, x, [&](int i) {
    return chebyshevSum(columns, y, [&](int j) { return coefficients[i * columns + j]; });
  });
}

}  // namespace ambient
