#pragma once

#include "bullet_ambient/motion/links/link_state.h"

// For sources that are compiled once per instruction set, see axis_rows.h.

namespace ambient {
namespace {

// Inverts a symmetric matrix of `n` rows. Returns false if it is not positive definite.
inline bool invert(const double (&D)[3][3], int n, double (&inverse)[3][3]) {
  double lower[3][3] = {}, per_pivot[3] = {};
  bool is_positive = true;
  for (int i = 0; i < n; ++i) {
    double scaled[3] = {}, pivot = D[i][i];
    for (int j = 0; j < i; ++j) {
      scaled[j] = D[i][j];
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * lower[j][k];
      lower[i][j] = scaled[j] * per_pivot[j];
      pivot -= scaled[j] * lower[i][j];
    }
    per_pivot[i] = 1 / pivot;
    is_positive = is_positive && pivot > 0 && per_pivot[i] <= __DBL_MAX__;
  }
  for (int j = 0; j < n; ++j) {
    double x[3] = {0, 0, 0};
    x[j] = 1;
    for (int i = j + 1; i < n; ++i)
      for (int k = j; k < i; ++k) x[i] -= lower[i][k] * x[k];
    for (int i = n - 1; i >= 0; --i) {
      x[i] *= per_pivot[i];
      for (int k = i + 1; k < n; ++k) x[i] -= lower[k][i] * x[k];
      inverse[i][j] = x[i];
    }
  }
  return is_positive;
}

// Factors a 6x6 inertia.
inline void factorBase(const InertiaBlocks& I, BaseFactor& factor) {
  double K[6][6];  // its lower half
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      K[i][j] = I.rotation.column[j].at[i];
      K[3 + i][j] = I.coupling.column[i].at[j];
      K[3 + i][3 + j] = I.translation.column[j].at[i];
    }
  factor.is_positive = true;
  for (int i = 0; i < 6; ++i) {
    double scaled[6], pivot = K[i][i];
    for (int j = 0; j < i; ++j) {
      scaled[j] = K[i][j];
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * factor.lower[j][k];
      factor.lower[i][j] = scaled[j] * factor.per_pivot[j];
      pivot -= scaled[j] * factor.lower[i][j];
    }
    factor.is_positive = factor.is_positive && pivot > 0;
    factor.per_pivot[i] = 1 / pivot;
  }
}

// Replaces b by the solution x of L D L^T x = b.
inline void answer(const BaseFactor& factor, double* b) noexcept {
  for (int i = 1; i < 6; ++i)
    for (int j = 0; j < i; ++j) b[i] -= factor.lower[i][j] * b[j];
  for (int i = 5; i >= 0; --i) {
    b[i] *= factor.per_pivot[i];
    for (int j = i + 1; j < 6; ++j) b[i] -= factor.lower[j][i] * b[j];
  }
}

}  // namespace
}  // namespace ambient
