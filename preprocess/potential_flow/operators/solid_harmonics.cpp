#include "preprocess/potential_flow/operators/solid_harmonics.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <stdexcept>

#include "preprocess/base/parallel_for.h"

namespace ambient {

namespace {

using Complex = std::complex<double>;
using Eigen::Vector3d;

constexpr int kMostDegree = 16;  // of a table on the stack: twice the degree of the expansions

constexpr int triangular(int n, int m) { return n * (n + 1) / 2 + m; }

/// Places of the real and the imaginary part in the real vectors.
int realPlace(int n, int m) { return n * n + m; }
int imaginaryPlace(int n, int m) { return n * n + n + m; }

double signOf(int m) { return m % 2 == 0 ? 1 : -1; }

/// Harmonics of orders 0 <= m <= n; those of negative order follow from them.
class HarmonicTable {
 public:
  explicit HarmonicTable(int degree) : degree_(degree) {}

  Complex& at(int n, int m) { return values_[triangular(n, m)]; }
  Complex get(int n, int m) const {
    if (n < 0 || std::abs(m) > n) return 0;
    const Complex value = values_[triangular(n, std::abs(m))];
    return m >= 0 ? value : signOf(m) * std::conj(value);
  }
  int degree() const { return degree_; }
  const double* numbers() const { return reinterpret_cast<const double*>(values_); }

 private:
  int degree_;
  Complex values_[triangular(kMostDegree + 1, 0)];
};

/// r^n P_n^m(cos) exp(i m phi) / (n + m)!
HarmonicTable regularHarmonics(const Vector3d& x, int degree) {
  HarmonicTable R(degree);
  const Complex around(x.x(), x.y());
  const double square = x.squaredNorm();
  R.at(0, 0) = 1;
  for (int n = 1; n <= degree; ++n) {
    R.at(n, n) = -around / (2.0 * n) * R.get(n - 1, n - 1);
    for (int m = 0; m < n; ++m)
      R.at(n, m) = ((2.0 * n - 1) * x.z() * R.get(n - 1, m) - square * R.get(n - 2, m)) /
                   static_cast<double>((n + m) * (n - m));
  }
  return R;
}

/// (n - m)! P_n^m(cos) exp(i m phi) / r^(n + 1)
HarmonicTable irregularHarmonics(const Vector3d& x, int degree) {
  HarmonicTable S(degree);
  const double inverse_square = 1 / x.squaredNorm();
  const Complex around = Complex(x.x(), x.y()) * inverse_square;
  const double along = x.z() * inverse_square;
  S.at(0, 0) = std::sqrt(inverse_square);
  for (int n = 1; n <= degree; ++n) {
    S.at(n, n) = -(2.0 * n - 1) * around * S.get(n - 1, n - 1);
    for (int m = 0; m < n; ++m)
      S.at(n, m) =
          (2.0 * n - 1) * along * S.get(n - 1, m) -
          static_cast<double>((n - 1) * (n - 1) - m * m) * inverse_square * S.get(n - 2, m);
  }
  return S;
}

void copyReal(const HarmonicTable& table, Eigen::VectorXd& harmonics) {
  for (int n = 0; n <= table.degree(); ++n)
    for (int m = 0; m <= n; ++m) {
      harmonics[realPlace(n, m)] = table.get(n, m).real();
      if (m > 0) harmonics[imaginaryPlace(n, m)] = table.get(n, m).imag();
    }
}

}  // namespace

SolidHarmonics::SolidHarmonics(int degree)
    : degree_(degree), transfer_(count() * count()), degree_of_(count()) {
  if (2 * degree > kMostDegree) throw std::invalid_argument("solid harmonics: degree above 8");
  for (int i = 0; i <= degree; ++i)
    for (int q = -i; q <= i; ++q) {
      degree_of_[q >= 0 ? realPlace(i, q) : imaginaryPlace(i, -q)] = i;
      for (int j = 0; j <= degree; ++j)
        for (int m = -j; m <= j; ++m)
          fillTransferEntry(i, std::abs(q), q < 0, j, std::abs(m), m < 0);
    }
}

/// With R_i^q = c + i d of the target and R_j^m = e + i f of the source, the orders (+-q, +-m) add
/// 2 Re(conj(R_i^q) conj(R_j^m) S^(q+m)) and 2 (-1)^m Re(conj(R_i^q) R_j^m S^(q-m)).
void SolidHarmonics::fillTransferEntry(int i, int q, bool target_imaginary, int j, int m,
                                       bool source_imaginary) {
  const int row = target_imaginary ? imaginaryPlace(i, q) : realPlace(i, q);
  const int column = source_imaginary ? imaginaryPlace(j, m) : realPlace(j, m);
  const bool imaginary = target_imaginary != source_imaginary;
  // Order 0 has one sign only.
  const double once = (q == 0 ? 0.5 : 1.0) * (m == 0 ? 0.5 : 1.0);
  double sum = 2 * signOf(i) * once;
  double difference = sum * signOf(m);
  if (target_imaginary && source_imaginary) sum = -sum;
  if (source_imaginary && !target_imaginary) difference = -difference;
  if (q < m) difference *= imaginary ? -signOf(m - q) : signOf(m - q);
  TransferEntry& entry = transfer_[row + column * count()];
  const int part = imaginary ? 1 : 0;
  entry.first = 2 * triangular(i + j, q + m) + part;
  entry.second = 2 * triangular(i + j, std::abs(q - m)) + part;
  entry.first_factor = static_cast<float>(sum);
  entry.second_factor = static_cast<float>(difference);
}

void SolidHarmonics::evaluateRegular(const Vector3d& a, Eigen::VectorXd& harmonics) const {
  copyReal(regularHarmonics(a, degree_), harmonics);
}

void SolidHarmonics::evaluateSlope(const Vector3d& a, const Vector3d& direction,
                                   Eigen::VectorXd& harmonics) const {
  const HarmonicTable R = regularHarmonics(a, degree_);
  const HarmonicTable step = regularHarmonics(direction, 1);
  HarmonicTable slope(degree_);
  for (int n = 0; n <= degree_; ++n)
    for (int m = 0; m <= n; ++m) {
      slope.at(n, m) = 0;
      for (int l = -1; l <= 1; ++l) slope.at(n, m) += step.get(1, l) * R.get(n - 1, m - l);
    }
  copyReal(slope, harmonics);
}

void SolidHarmonics::fillShift(const Vector3d& shift, double ratio, Eigen::MatrixXf& matrix) const {
  const HarmonicTable X = regularHarmonics(shift, degree_);
  matrix.setZero(count(), count());
  for (int n = 0; n <= degree_; ++n)
    for (int m = 0; m <= n; ++m) {
      double power = 1;
      for (int k = 0; k <= n; ++k, power *= ratio)
        for (int l = 0; l <= k; ++l) {
          // R_k^l X^(m-l) and, of order -l, (-1)^l conj(R_k^l) X^(m+l).
          const Complex minus = power * X.get(n - k, m - l);
          const Complex plus = l > 0 ? power * signOf(l) * X.get(n - k, m + l) : 0;
          const auto set = [&](int row, int column, double value) {
            matrix(row, column) = static_cast<float>(value);
          };
          set(realPlace(n, m), realPlace(k, l), (minus + plus).real());
          if (l > 0) set(realPlace(n, m), imaginaryPlace(k, l), (plus - minus).imag());
          if (m > 0) set(imaginaryPlace(n, m), realPlace(k, l), (minus + plus).imag());
          if (m > 0 && l > 0)
            set(imaginaryPlace(n, m), imaginaryPlace(k, l), (minus - plus).real());
        }
    }
}

void SolidHarmonics::fillTransfer(const Vector3d& offset, double target_scale, double source_scale,
                                  Eigen::MatrixXf& matrix) const {
  // In units of the larger scale, so that neither powers of small nor of large numbers overflow.
  const double unit = std::max(target_scale, source_scale);
  const HarmonicTable S = irregularHarmonics(offset / unit, 2 * degree_);
  float numbers[2 * triangular(kMostDegree + 1, 0)];
  for (int k = 0; k < 2 * triangular(2 * degree_ + 1, 0); ++k)
    numbers[k] = static_cast<float>(S.numbers()[k]);
  float target_power[kMostDegree + 1], source_power[kMostDegree + 1];
  target_power[0] = 1;
  source_power[0] = static_cast<float>(1 / unit);
  for (int n = 1; n <= degree_; ++n) {
    target_power[n] = target_power[n - 1] * static_cast<float>(target_scale / unit);
    source_power[n] = source_power[n - 1] * static_cast<float>(source_scale / unit);
  }
  matrix.resize(count(), count());
  const TransferEntry* entry = transfer_.data();
  float* value = matrix.data();
  for (int column = 0; column < count(); ++column) {
    const float source = source_power[degree_of_[column]];
    for (int row = 0; row < count(); ++row, ++entry, ++value)
      *value = source * target_power[degree_of_[row]] *
               (entry->first_factor * numbers[entry->first] +
                entry->second_factor * numbers[entry->second]);
  }
}

using Eigen::Index;
using Eigen::MatrixXf;

void ClusterExpansions::fillShiftToParent(int cluster, MatrixXf& matrix) const {
  const PanelCluster& child = tree_.clusters[cluster];
  const PanelCluster& parent = tree_.clusters[child.parent];
  harmonics_.fillShift((child.centre - parent.centre) / parent.radius, child.radius / parent.radius,
                       matrix);
}

void ClusterExpansions::computeLocals(MatrixXf& multipoles, Index fields, MatrixXf& locals) const {
  const auto block = [&](MatrixXf& m, int c) { return m.middleCols(c * fields, fields); };
  const auto clusters = static_cast<Index>(tree_.clusters.size());
  for (std::size_t level = tree_.levels.size(); level-- > 0;) {
    const std::vector<int>& here = tree_.levels[level];
    parallelFor(threads_, static_cast<Index>(here.size()), [&](Index k) {
      const int c = here[k];
      if (tree_.clusters[c].isLeaf()) return;
      MatrixXf shift;
      block(multipoles, c).setZero();
      for (const int child : tree_.clusters[c].children) {
        fillShiftToParent(child, shift);
        block(multipoles, c).noalias() += shift * block(multipoles, child);
      }
    });
  }
  locals.setZero(harmonics_.count(), fields * clusters);
  parallelFor(threads_, clusters, [&](Index c) {
    MatrixXf transfer;
    const PanelCluster& target = tree_.clusters[c];
    for (const int s : pairs_.far[c]) {
      const PanelCluster& source = tree_.clusters[s];
      harmonics_.fillTransfer(target.centre - source.centre, target.radius, source.radius,
                              transfer);
      block(locals, static_cast<int>(c)).noalias() += transfer * block(multipoles, s);
    }
  });
  for (const std::vector<int>& here : tree_.levels)
    parallelFor(threads_, static_cast<Index>(here.size()), [&](Index k) {
      const int c = here[k];
      if (tree_.clusters[c].parent < 0) return;
      MatrixXf shift;
      fillShiftToParent(c, shift);
      block(locals, c).noalias() += shift.transpose() * block(locals, tree_.clusters[c].parent);
    });
}

}  // namespace ambient
