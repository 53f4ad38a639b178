#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/potential_flow/operators/panel_tree.h"

namespace ambient {

/// Expansions of 1/|x - y| in solid harmonics up to a degree p, as real vectors with (p + 1)^2
/// entries: with a = (x - c_t) / s_t and b = (y - c_s) / s_s, and centres further apart than |x -
/// c_t| + |y - c_s|, 1/|x - y| = regular(a)^T transfer(c_t - c_s, s_t, s_s) regular(b), up to
/// truncation; docs/theory.md eq. (32).
class SolidHarmonics {
 public:
  /// @throws std::invalid_argument for a degree above 8.
  explicit SolidHarmonics(int degree);

  int count() const { return (degree_ + 1) * (degree_ + 1); }

  /// Computes the regular harmonics R(a): real and imaginary parts for orders m >= 0, by degree.
  void evaluateRegular(const Eigen::Vector3d& a, Eigen::VectorXd& harmonics) const;

  /// Computes the derivative of R at a along a direction.
  void evaluateSlope(const Eigen::Vector3d& a, const Eigen::Vector3d& direction,
                     Eigen::VectorXd& harmonics) const;

  /// Computes the matrix Q with R(a) = Q R(a') for a change of centre and scale: a = (x - c) / s,
  /// a' = (x - c') / s', shift = (c' - c) / s, ratio = s' / s.
  void fillShift(const Eigen::Vector3d& shift, double ratio, Eigen::MatrixXf& matrix) const;

  /// Computes transfer(); `offset`: from the source's centre to the target's.
  void fillTransfer(const Eigen::Vector3d& offset, double target_scale, double source_scale,
                    Eigen::MatrixXf& matrix) const;

 private:
  /// An entry of the transfer matrix: a sum of two irregular harmonics, real or imaginary parts.
  struct TransferEntry {
    int first, second;
    float first_factor, second_factor;
  };

  void fillTransferEntry(int i, int q, bool target_imaginary, int j, int m, bool source_imaginary);

  int degree_;
  std::vector<TransferEntry> transfer_;  ///< by columns
  std::vector<int> degree_of_;           ///< of an entry of the real vectors
};

/// Expansions of several fields in the clusters of a tree: multipoles (fields of the panels of a
/// cluster, seen from far) and locals (fields of far clusters, seen in the cluster), each about the
/// centre of the cluster in units of its radius. One matrix has all: (p + 1)^2 rows, and `fields`
/// columns per cluster.
class ClusterExpansions {
 public:
  ClusterExpansions(const PanelTree& tree, const ClusterPairs& pairs, int degree, int threads)
      : tree_(tree), pairs_(pairs), harmonics_(degree), threads_(threads) {}

  const SolidHarmonics& harmonics() const { return harmonics_; }

  /// Computes the locals of the leaves from the multipoles of the leaves; docs/theory.md eq. (33).
  /// Overwrites the other multipoles. The same bits for every number of threads.
  void computeLocals(Eigen::MatrixXf& multipoles, Eigen::Index fields,
                     Eigen::MatrixXf& locals) const;

 private:
  void fillShiftToParent(int cluster, Eigen::MatrixXf& matrix) const;

  const PanelTree& tree_;
  const ClusterPairs& pairs_;
  SolidHarmonics harmonics_;
  int threads_;
};

}  // namespace ambient
