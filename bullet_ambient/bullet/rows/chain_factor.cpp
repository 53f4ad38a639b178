#include "bullet_ambient/bullet/rows/chain_factor.h"

#include <LinearMath/btScalar.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/bullet/core/four_numbers.h"

AMBIENT_BEGIN
namespace {

// Pivot relative to the diagonal entry of its row, below which it is rounding: the row depends on
// those before it.
constexpr double kNoPivot = 64 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

// Most multiplications per row for the factor. Chains with dozens of joints on one body exceed it,
// and are left to the iterations.
constexpr double kMostWork = 1e4;

using Group = ChainFactor::Group;

// Entries of four rows in one column. By reference, as without AVX a compiler has no agreed way to
// return them.
using Lanes = double __attribute__((vector_size(32)));
AMBIENT_INLINE void loadLanes(Lanes& lanes, const double* at) {
  __builtin_memcpy(&lanes, at, sizeof lanes);
}
AMBIENT_INLINE void storeLanes(double* at, const Lanes& lanes) {
  __builtin_memcpy(at, &lanes, sizeof lanes);
}

// Subtracts `count` columns of four rows, each times its factor, from a sum, one after the other.
// `stride`: from factor to factor.
AMBIENT_INLINE void subtract(Lanes& sum, const double* columns, const double* factors, int stride,
                             int count) {
  for (int k = 0; k < count; ++k) {
    Lanes column;
    loadLanes(column, columns + 4 * k);
    sum -= column * factors[stride * k];
  }
}

// Computes L of four rows in the columns of all rows before them.
AMBIENT_INLINE void reduceLeft(const Group* groups, double* elements, int number) {
  const Group& group = groups[number];
  double* columns = elements + group.at - 4 * group.first;
  for (int earlier = group.first / 4; earlier < number; ++earlier) {
    const Group& other = groups[earlier];
    const double* of_others = elements + other.at - 4 * other.first;
    const int first = std::max(group.first, other.first);
    for (int j = std::max(group.first, 4 * earlier); j < 4 * earlier + 4; ++j) {
      const double* L_j = of_others + j % 4;
      Lanes sum;
      loadLanes(sum, columns + 4 * j);
      subtract(sum, columns + 4 * first, L_j + 4 * first, 4, j - first);
      storeLanes(columns + 4 * j, sum * L_j[4 * j]);
    }
  }
}

// Computes L of `count` of four rows in their own columns. Returns false if a row depends on those
// before it. Entries above the diagonal are not used.
AMBIENT_INLINE bool reduceOwn(const Group& group, double* elements, int number, int count) {
  double* columns = elements + group.at;
  const int before = 4 * number - group.first;
  for (int row = 0; row < count; ++row) {
    double* own = columns + 4 * (before + row);
    Lanes sum;
    loadLanes(sum, own);
    subtract(sum, columns, columns + row, 4, before + row);
    const double rest = sum[row];
    if (!(rest > kNoPivot * own[row])) return false;
    const double inverse = 1 / std::sqrt(rest);
    storeLanes(own, sum * inverse);
    own[row] = inverse;
  }
  return true;
}

AMBIENT_INLINE bool factorizeAll(const Group* groups, double* elements, int size) {
  for (int number = 0; 4 * number < size; ++number) {
    reduceLeft(groups, elements, number);
    if (!reduceOwn(groups[number], elements, number, std::min(4, size - 4 * number))) return false;
  }
  return true;
}

// Solves L y = x for four rows, y in place of x.
AMBIENT_INLINE void forward(const Group& group, const double* elements, int number, double* x) {
  const double* columns = elements + group.at;
  double* own = x + 4 * number;
  const int before = 4 * number - group.first;
  Lanes sum;
  loadLanes(sum, own);
  subtract(sum, columns, x + group.first, 1, before);
  storeLanes(own, sum);
  columns += 4 * before;
  for (int row = 0; row < 4; ++row) {
    for (int j = 0; j < row; ++j) own[row] -= columns[4 * j + row] * own[j];
    own[row] *= columns[4 * row + row];
  }
}

// Solves L^T s = y for four rows, s in place of y, and takes their share from the rows before.
AMBIENT_INLINE void backward(const Group& group, const double* elements, int number, double* x) {
  const double* columns = elements + group.at;
  double* own = x + 4 * number;
  const int before = 4 * number - group.first;
  const double* own_columns = columns + 4 * before;
  for (int row = 3; row >= 0; --row) {
    own[row] *= own_columns[4 * row + row];
    for (int j = 0; j < row; ++j) own[j] -= own_columns[4 * j + row] * own[row];
  }
  Lanes found;
  loadLanes(found, own);
  for (int j = 0; j < before; ++j) {
    Lanes change;
    loadLanes(change, columns + 4 * j);
    change *= found;
    double& sum = x[group.first + j];
    sum = (((sum - change[3]) - change[2]) - change[1]) - change[0];
  }
}

AMBIENT_INLINE void solveAll(const Group* groups, const double* elements, int size, double* x) {
  const int count = (size + 3) / 4;
  for (int number = 0; number < count; ++number) forward(groups[number], elements, number, x);
  for (int number = count - 1; number >= 0; --number) backward(groups[number], elements, number, x);
}

// Functions for one instruction set.
struct FactorKernel {
  bool (*factorize)(const Group* groups, double* elements, int size);
  void (*solve)(const Group* groups, const double* elements, int size, double* x);
};

// NOLINTBEGIN(bugprone-macro-parentheses): an attribute takes none
#define AMBIENT_FACTOR_KERNEL(name, target)                                                      \
  struct name {                                                                                  \
    target static bool factorize(const Group* groups, double* elements, int size) {              \
      return factorizeAll(groups, elements, size);                                               \
    }                                                                                            \
    target static void solve(const Group* groups, const double* elements, int size, double* x) { \
      solveAll(groups, elements, size, x);                                                       \
    }                                                                                            \
    static constexpr FactorKernel kAll{factorize, solve};                                        \
  };
// NOLINTEND(bugprone-macro-parentheses)

AMBIENT_FACTOR_KERNEL(BaselineFactor, )
AMBIENT_FACTOR_KERNEL(AvxFactor, AMBIENT_AVX)

const FactorKernel& factorKernel() noexcept {
  constexpr Kernels<const FactorKernel*> kKernels{&BaselineFactor::kAll, &AvxFactor::kAll,
                                                  &AvxFactor::kAll};
  static const FactorKernel& fastest = *kKernels.fastest();
  return fastest;
}

}  // namespace

void ChainFactor::clear() {
  size_ = 0;
  work_ = 0;
  groups_.clear();
}

void ChainFactor::addRow(int first) {
  if (size_ % 4 == 0) groups_.push_back({first, 0});
  groups_.back().first = std::min(groups_.back().first, first);
  ++size_;
  const double width = size_ - first;
  work_ += width * width;
}

bool ChainFactor::begin() {
  if (work_ > kMostWork * size_) return false;
  std::size_t count = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    groups_[i].at = count;
    count += 4 * (4 * (i + 1) - static_cast<std::size_t>(groups_[i].first));
  }
  elements_.assign(count, 0);
  return true;
}

bool ChainFactor::factorize() noexcept {
  return factorKernel().factorize(groups_.data(), elements_.data(), size_);
}

void ChainFactor::solve(double* x) const noexcept {
  factorKernel().solve(groups_.data(), elements_.data(), size_, x);
}

AMBIENT_END
