#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/panel_pair.h"
#include "preprocess/potential_flow/surface/panel_views.h"

namespace ambient {

/// Lists for every panel the near panels, itself included, ascending: those that the far-field
/// formula does not cover.
struct NearPanels {
  struct Entry {
    int panel;
    PairKind kind;
    double integral;  ///< computePairIntegral(), the same number for (t, s) and (s, t)
  };
  std::vector<std::vector<Entry>> of_panel;
};

/// Finds the near panels and integrates each near pair once. Cost: O(panels^2) tests.
NearPanels findNearPanels(const PanelSurface& surface, int threads);

/// Moments of a function on the surface with the three hat functions of every panel: one 3 x 6
/// matrix per panel, int h_a phi_c over the panel.
using PanelMoments = std::vector<Eigen::Matrix<double, 3, 6>>;

/// Linear jumps on a panel, for the six motions: values at the corners, mean, surface gradient.
struct PanelJump {
  Eigen::Matrix<double, 3, 6> corner;
  Eigen::Matrix<double, 1, 6> mean;
  Eigen::Matrix<double, 3, 6> gradient;
  CornerJumps of_kernel;  ///< the values at the corners
};

/// Returns the jumps on all panels, from the values at the vertices.
std::vector<PanelJump> makePanelJumps(const PanelSurface& surface,
                                      const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump);

/// Collects the potential that other panels cause at the nodes of a rule on one panel.
template <std::size_t N>
class NodePotentials {
 public:
  NodePotentials(const Panel& panel, const std::array<TriangleNode, N>& rule) : rule_(rule) {
    for (int k = 0; k < kPadded; ++k) {
      const Eigen::Vector3d node = panel.at(rule[std::min<std::size_t>(k, N - 1)].barycentric);
      for (int axis = 0; axis < 3; ++axis) nodes_.at[axis][k] = node[axis];
    }
  }

  /// Adds a source by closed forms.
  void add(const PanelNumbers& source, const CornerJumps& jumps) {
    static const auto kernel = kAddDoubleLayer.fastest();
    kernel(source, jumps, nodes_, kPadded, potentials_);
  }

  /// Adds a source a little apart by points.
  void addByPoints(const PanelNumbers& source, const PanelNodes& nodes, const CornerJumps& jumps) {
    static const auto kernel = kAddPointDipoles.fastest();
    kernel(source, nodes, jumps, nodes_, kPadded, potentials_);
  }

  /// Adds at node k the potential of a jump, and that of a jump of 1 everywhere, the solid angle.
  void add(std::size_t k, const Eigen::Matrix<double, 1, 6>& potential, double solid_angle) {
    for (int field = 0; field < 6; ++field) potentials_.at[field][k] += potential[field];
    potentials_.at[6][k] += solid_angle;
  }

  Eigen::Vector3d node(std::size_t k) const {
    return {nodes_.at[0][k], nodes_.at[1][k], nodes_.at[2][k]};
  }

  /// Moments of int (mu(y) - mu(x)) with the panel's hat functions; `jump` is its own mu.
  Eigen::Matrix<double, 3, 6> moments(const Panel& panel,
                                      const Eigen::Matrix<double, 3, 6>& jump) const {
    Eigen::Matrix<double, 3, 6> sum = Eigen::Matrix<double, 3, 6>::Zero();
    for (std::size_t k = 0; k < N; ++k) {
      const Eigen::Map<const Eigen::Vector3d> hat(rule_[k].barycentric.data());
      Eigen::Matrix<double, 1, 6> potential = -potentials_.at[6][k] * (hat.transpose() * jump);
      for (int field = 0; field < 6; ++field) potential[field] += potentials_.at[field][k];
      sum += (rule_[k].weight * panel.area) * hat * potential;
    }
    return sum;
  }

 private:
  static constexpr int kPadded = N <= 8 ? 8 : kMostPanelPoints;  // the last node again

  const std::array<TriangleNode, N>& rule_;
  PanelPoints nodes_;
  PanelPotentials potentials_{};
};

/// Computes the moments on panel t that the panels near it cause, times 4 pi.
Eigen::Matrix<double, 3, 6> computeNearMoments(const PanelSurface& surface,
                                               const std::vector<NearPanels::Entry>& near,
                                               const std::vector<PanelJump>& jumps, Eigen::Index t);

/// Numbers of the unknowns at the vertices. All vertices of triangles have one, except those on the
/// boundary of a sheet.
struct Unknowns {
  std::vector<int> of_vertex;  ///< number of the unknown, or -1
  int count = 0;
};

Unknowns numberUnknowns(const PanelSurface& surface);

/// Assembles W (U x U, positive semi-definite; its kernel: constants on each closed component);
/// fills only the lower triangle: W_ij = 1/(4 pi) sum over panels t at i, s at j of (curl h_i .
/// curl h_j) int_t int_s 1/r; docs/theory.md eq. (8), (9). Cost: O(panels^2) time, U^2 numbers of
/// memory.
Eigen::MatrixXd assembleHypersingular(const PanelSurface& surface, const Unknowns& unknowns,
                                      const NearPanels& near, int threads);

/// Makes W regular: adds s m m^T for the constant m on each closed component, whose vertices all
/// carry an unknown. s is of the size of W's diagonal.
void fillKernel(const PanelSurface& surface, const Unknowns& unknowns, Eigen::MatrixXd& W);

/// Assembles B (U x 6): int h_i n.(v + w x z) for the six unit motions, rotation first, exact;
/// docs/theory.md eq. (8).
Eigen::Matrix<double, Eigen::Dynamic, 6> assembleNormalVelocity(const PanelSurface& surface,
                                                                const Unknowns& unknowns);

}  // namespace ambient
