#include "preprocess/potential_flow/operators/far_moments.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/parallel_for.h"

namespace ambient {

namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using RowVector6 = Eigen::Matrix<double, 1, 6>;

constexpr Index kFarBlock = 256;  // panels per sweep, small enough for the first cache
using FarArray = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kFarBlock, 1>;

Eigen::Matrix3d momentOf(const PanelArrays& a, Index t) {
  Eigen::Matrix3d m;
  m << a.xx[t], a.xy[t], a.xz[t], a.xy[t], a.yy[t], a.yz[t], a.xz[t], a.yz[t], a.zz[t];
  return m;
}

/// Taylor coefficients of the kernel n_S.r/r^3 between centroids, times the source's area: a column
/// per target panel, a row per source; zero where the near field takes over.
struct FarKernel {
  MatrixXd value;  ///< with both second moments
  MatrixXd gradient_x, gradient_y, gradient_z;

  FarKernel(Index sources, Index targets)
      : value(sources, targets),
        gradient_x(sources, targets),
        gradient_y(sources, targets),
        gradient_z(sources, targets) {}
};

void fillFarKernel(const PanelArrays& a, Index t, const PanelRange& sources,
                   const std::vector<NearPanels::Entry>& near, Index column, FarKernel& kernel) {
  for (Index first = 0; first < sources.count; first += kFarBlock) {
    const Index count = std::min(kFarBlock, sources.count - first);
    const auto part = [&](const ArrayXd& array) {
      return array.segment(sources.first + first, count);
    };
    const auto nx = part(a.normal_x), ny = part(a.normal_y), nz = part(a.normal_z);
    const FarArray x = a.x[t] - part(a.x), y = a.y[t] - part(a.y), z = a.z[t] - part(a.z);
    const FarArray xx = a.xx[t] + part(a.xx), yy = a.yy[t] + part(a.yy), zz = a.zz[t] + part(a.zz);
    const FarArray xy = a.xy[t] + part(a.xy), xz = a.xz[t] + part(a.xz), yz = a.yz[t] + part(a.yz);
    const FarArray inverse_square = 1 / (x * x + y * y + z * z);
    const FarArray inverse_cube = part(a.area) * inverse_square * inverse_square.sqrt();
    const FarArray flux = nx * x + ny * y + nz * z;
    const FarArray mx = x * xx + y * xy + z * xz, my = x * xy + y * yy + z * yz,
                   mz = x * xz + y * yz + z * zz;
    const FarArray along = x * mx + y * my + z * mz;
    const FarArray second = 7.5 * flux * along * inverse_square - 1.5 * flux * (xx + yy + zz) -
                            3 * (nx * mx + ny * my + nz * mz);
    const FarArray steep = 3 * flux * inverse_square;
    kernel.value.col(column).segment(first, count) =
        inverse_cube * (flux + second * inverse_square);
    kernel.gradient_x.col(column).segment(first, count) = inverse_cube * (nx - steep * x);
    kernel.gradient_y.col(column).segment(first, count) = inverse_cube * (ny - steep * y);
    kernel.gradient_z.col(column).segment(first, count) = inverse_cube * (nz - steep * z);
  }
  const auto end = near.end();
  auto entry =
      std::lower_bound(near.begin(), end, sources.first,
                       [](const NearPanels::Entry& e, Index panel) { return e.panel < panel; });
  for (; entry != end && entry->panel < sources.first + sources.count; ++entry)
    for (MatrixXd* m : {&kernel.value, &kernel.gradient_x, &kernel.gradient_y, &kernel.gradient_z})
      (*m)(entry->panel - sources.first, column) = 0;
}

}  // namespace

FarMoments::FarMoments(const PanelSurface& surface, const std::vector<PanelJump>& jumps)
    : surface_(surface), jumps_(jumps) {
  for (MatrixXd& m : sources_) m.resize(13, surface.panelCount());
  for (Index s = 0; s < surface.panelCount(); ++s) {
    const Matrix36 slope = momentOf(surface.arrays, s) * jumps[s].gradient;
    for (int k = 0; k < 3; ++k) {
      sources_[k].col(s) << jumps[s].mean.transpose(), 1, slope.row(k).transpose();
    }
  }
}

void FarMoments::add(const std::vector<PanelRange>& sources, const PanelRange& targets,
                     const std::vector<NearPanels::Entry>* near, PanelMoments& moments) const {
  const Index count = targets.count;
  Eigen::Matrix<double, 7, Eigen::Dynamic> by_value(7, count);
  std::array<MatrixXd, 3> by_gradient;
  by_value.setZero();
  for (MatrixXd& m : by_gradient) m.setZero(13, count);
  for (const PanelRange& range : sources) {
    FarKernel kernel(range.count, count);
    for (Index k = 0; k < count; ++k)
      fillFarKernel(surface_.arrays, targets.first + k, range, near[k], k, kernel);
    const auto part = [&](int axis) { return sources_[axis].middleCols(range.first, range.count); };
    by_value.noalias() += part(0).topRows<7>() * kernel.value;
    by_gradient[0].noalias() += part(0) * kernel.gradient_x;
    by_gradient[1].noalias() += part(1) * kernel.gradient_y;
    by_gradient[2].noalias() += part(2) * kernel.gradient_z;
  }
  for (Index k = 0; k < count; ++k) {
    const Index t = targets.first + k;
    const Panel& panel = surface_.panels[t];
    const PanelJump& jump = jumps_[t];
    const Eigen::Matrix3d moment = momentOf(surface_.arrays, t);
    // phi at the centroid and its slope, both without the part of the jump that varies on this
    // panel.
    RowVector6 value = by_value.col(k).head<6>().transpose() - by_value(6, k) * jump.mean;
    Matrix36 slope;
    Vector3d kernel_slope;
    for (int d = 0; d < 3; ++d) {
      value -= by_gradient[d].col(k).tail<6>().transpose();
      kernel_slope[d] = by_gradient[d](6, k);
      slope.row(d) = by_gradient[d].col(k).head<6>().transpose() - kernel_slope[d] * jump.mean;
    }
    value -= (moment * kernel_slope).transpose() * jump.gradient;
    slope -= by_value(6, k) * jump.gradient;
    for (int a = 0; a < 3; ++a)
      moments[t].row(a) +=
          panel.area * (value / 3 + (moment * panel.hatGradient(a)).transpose() * slope);
  }
}

PanelMoments computeExteriorMoments(const PanelSurface& surface, const NearPanels& near,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads) {
  constexpr Index kAtOnce = FarMoments::kTargetsAtOnce;
  const Index panels = surface.panelCount();
  AMBIENT_ASSERT(jump.rows() == surface.vertexCount());
  AMBIENT_ASSERT(near.of_panel.size() == static_cast<std::size_t>(panels));
  const std::vector<PanelJump> jumps = makePanelJumps(surface, jump);
  const FarMoments far(surface, jumps);
  PanelMoments moments(panels, Eigen::Matrix<double, 3, 6>::Zero());
  parallelFor(threads, (panels + kAtOnce - 1) / kAtOnce, [&](Index block) {
    const Index first = block * kAtOnce, count = std::min(kAtOnce, panels - first);
    far.add({{0, panels}}, {first, count}, near.of_panel.data() + first, moments);
    for (Index t = first; t < first + count; ++t) {
      moments[t] += computeNearMoments(surface, near.of_panel[t], jumps, t);
      moments[t] /= 4 * kPi;
    }
  });
  return moments;
}

namespace {

using Eigen::MatrixXf;
using Eigen::VectorXd;

constexpr Index kFields = 7;  // the six jumps and a jump of 1, which makes the solid angle

/// Dipoles mu n of a leaf's panels.
Eigen::MatrixXd leafMultipoles(const PanelTree& tree, const PanelCluster& leaf,
                               const std::vector<PanelJump>& jumps,
                               const SolidHarmonics& harmonics) {
  Eigen::MatrixXd multipoles = Eigen::MatrixXd::Zero(harmonics.count(), kFields);
  VectorXd slope(harmonics.count());
  for (Index s = leaf.first; s < leaf.first + leaf.count; ++s) {
    const Panel& panel = tree.surface.panels[s];
    for (const TriangleNode& node : kTriangleRule6) {
      const Eigen::Map<const Eigen::Vector3d> hat(node.barycentric.data());
      harmonics.evaluateSlope((panel.at(node.barycentric) - leaf.centre) / leaf.radius,
                              panel.normal / leaf.radius, slope);
      slope *= node.weight * panel.area;
      multipoles.leftCols<6>() += slope * (hat.transpose() * jumps[s].corner);
      multipoles.col(6) += slope;
    }
  }
  return multipoles;
}

/// Returns the moments of the potential that far clusters cause on panel t of a leaf.
Matrix36 farClusterMoments(const Panel& panel, const PanelCluster& leaf, const PanelJump& jump,
                           const Eigen::MatrixXd& local, const SolidHarmonics& harmonics) {
  NodePotentials<6> potentials(panel, kTriangleRule6);
  VectorXd regular(harmonics.count());
  for (std::size_t k = 0; k < kTriangleRule6.size(); ++k) {
    harmonics.evaluateRegular((potentials.node(k) - leaf.centre) / leaf.radius, regular);
    const Eigen::Matrix<double, 1, kFields> value = regular.transpose() * local;
    potentials.add(k, value.head<6>(), value[6]);
  }
  return potentials.moments(panel, jump.corner);
}

/// The panels of near leaves that are not far from panel t.
std::vector<NearPanels::Entry> listNear(const PanelSurface& surface, Index t,
                                        const std::vector<PanelRange>& sources) {
  std::vector<NearPanels::Entry> near;
  for (const PanelRange& range : sources)
    for (Index s = range.first; s < range.first + range.count; ++s) {
      const PairKind kind = classifyPair(surface, t, s);
      if (kind != PairKind::Far) near.push_back({static_cast<int>(s), kind, 0});
    }
  return near;
}

void addNearLeaves(const PanelSurface& surface, const PanelCluster& leaf,
                   const std::vector<PanelRange>& sources, const std::vector<PanelJump>& jumps,
                   const FarMoments& far, PanelMoments& moments) {
  constexpr Index kAtOnce = FarMoments::kTargetsAtOnce;
  const Index end = leaf.first + leaf.count;
  for (Index first = leaf.first; first < end; first += kAtOnce) {
    const Index count = std::min(kAtOnce, end - first);
    std::vector<std::vector<NearPanels::Entry>> near;
    for (Index t = first; t < first + count; ++t) near.push_back(listNear(surface, t, sources));
    far.add(sources, {first, count}, near.data(), moments);
    for (Index k = 0; k < count; ++k)
      moments[first + k] += computeNearMoments(surface, near[k], jumps, first + k);
  }
}

}  // namespace

PanelMoments computeExteriorMoments(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads) {
  const PanelSurface& surface = tree.surface;
  const ClusterExpansions expansions(tree, pairs, degree, threads);
  const std::vector<PanelJump> jumps = makePanelJumps(surface, jump);
  const FarMoments far(surface, jumps);
  const auto leaves = static_cast<Index>(tree.leaves.size());
  const auto leaf = [&](Index k) -> const PanelCluster& { return tree.clusters[tree.leaves[k]]; };
  MatrixXf multipoles(expansions.harmonics().count(),
                      kFields * static_cast<Index>(tree.clusters.size()));
  parallelFor(threads, leaves, [&](Index k) {
    multipoles.middleCols(tree.leaves[k] * kFields, kFields) =
        leafMultipoles(tree, leaf(k), jumps, expansions.harmonics()).cast<float>();
  });
  MatrixXf locals;
  expansions.computeLocals(multipoles, kFields, locals);
  PanelMoments moments(surface.panelCount(), Matrix36::Zero());
  parallelFor(threads, leaves, [&](Index k) {
    std::vector<PanelRange> sources;
    for (const int s : pairs.near[k]) sources.push_back({leaf(s).first, leaf(s).count});
    addNearLeaves(surface, leaf(k), sources, jumps, far, moments);
    const Eigen::MatrixXd local =
        locals.middleCols(tree.leaves[k] * kFields, kFields).cast<double>();
    for (Index t = leaf(k).first; t < leaf(k).first + leaf(k).count; ++t) {
      moments[t] +=
          farClusterMoments(surface.panels[t], leaf(k), jumps[t], local, expansions.harmonics());
      moments[t] /= 4 * kPi;
    }
  });
  return moments;
}

}  // namespace ambient
