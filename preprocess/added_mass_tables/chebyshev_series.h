#pragma once

namespace ambient {

/// Chebyshev series in two variables: sum over i, j of c_ij T_i(x) T_j(y), on [-1, 1]^2.
struct ChebyshevSeries {
  int rows = 0, columns = 0;             ///< i below rows, j below columns
  const double* coefficients = nullptr;  ///< row after row; lives as long as the program

  double operator()(double x, double y) const;
};

}  // namespace ambient
