#include "preprocess/potential_flow/double_layer.h"

#include <algorithm>

#include "preprocess/potential_flow/parallel_for.h"
#include "preprocess/potential_flow/quadrature_rules.h"

namespace ambient {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using RowVector6 = Eigen::Matrix<double, 1, 6>;

constexpr double kPi = 3.14159265358979323846;
constexpr Index kPanelsAtOnce = 16;  // columns of one product of matrices
constexpr Index kFarBlock = 256;     // panels per sweep, small enough for the first cache
using FarArray = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kFarBlock, 1>;

/// The linear jumps of a panel: values at the corners, mean, surface gradient.
struct PanelJump {
  Matrix36 corner;
  RowVector6 mean;
  Matrix36 gradient;
};

PanelJump jumpOn(const PanelSurface& surface, const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                 Index t) {
  PanelJump j;
  j.gradient.setZero();
  for (int a = 0; a < 3; ++a) {
    j.corner.row(a) = jump.row(surface.triangles(a, t));
    j.gradient += surface.panels[t].hatGradient(a) * j.corner.row(a);
  }
  j.mean = j.corner.colwise().mean();
  return j;
}

Eigen::Matrix3d momentOf(const PanelArrays& a, Index t) {
  Eigen::Matrix3d m;
  m << a.xx[t], a.xy[t], a.xz[t], a.xy[t], a.yy[t], a.yz[t], a.xz[t], a.yz[t], a.zz[t];
  return m;
}

// ---- near field -------------------------------------------------------------------------------

/// int_S h_b n.(x - y)/r^3 dy by points, for panels a little apart.
Vector3d computeDoubleLayerByPoints(const Panel& panel, const Vector3d& x) {
  Vector3d weights = Vector3d::Zero();
  for (const TriangleNode& node : kTriangleRule6) {
    const Vector3d r = x - panel.at(node.barycentric);
    const double square = r.squaredNorm();
    const double kernel = node.weight / (square * std::sqrt(square));
    weights += kernel * Eigen::Map<const Vector3d>(node.barycentric.data());
  }
  return panel.area * panel.normal.dot(x - panel.centroid) * weights;
}

/// Collects the potential that panels close by cause at the nodes of a rule on one panel.
template <std::size_t N>
class NodePotentials {
 public:
  NodePotentials(const Panel& panel, const std::array<TriangleNode, N>& rule) : rule_(rule) {
    for (std::size_t k = 0; k < N; ++k) nodes_[k] = panel.at(rule[k].barycentric);
    potential_.setZero();
    solid_angle_.setZero();
  }

  template <typename DoubleLayer>
  void add(const Panel& source, const Matrix36& jump, const DoubleLayer& doubleLayer) {
    for (std::size_t k = 0; k < N; ++k) {
      const Vector3d weights = doubleLayer(source, nodes_[k]);
      potential_.row(k) += weights.transpose() * jump;
      solid_angle_[k] += weights.sum();
    }
  }

  /// Moments of int (mu(y) - mu(x)) with the panel's hat functions; `jump` is its own mu.
  Matrix36 moments(const Panel& panel, const Matrix36& jump) const {
    Matrix36 sum = Matrix36::Zero();
    for (std::size_t k = 0; k < N; ++k) {
      const Eigen::Map<const Vector3d> hat(rule_[k].barycentric.data());
      sum += (rule_[k].weight * panel.area) * hat *
             (potential_.row(k) - solid_angle_[k] * (hat.transpose() * jump));
    }
    return sum;
  }

 private:
  const std::array<TriangleNode, N>& rule_;
  std::array<Vector3d, N> nodes_;
  Eigen::Matrix<double, N, 6, Eigen::RowMajor> potential_;
  Eigen::Matrix<double, N, 1> solid_angle_;
};

/// The moments on panel t that the panels near it cause.
Matrix36 nearMoments(const PanelSurface& surface, const std::vector<NearPanels::Entry>& near,
                     const std::vector<PanelJump>& jumps, Index t) {
  NodePotentials<6> coarse(surface.panels[t], kTriangleRule6);
  NodePotentials<16> fine(surface.panels[t], kTriangleRule16);
  for (const NearPanels::Entry& entry : near) {
    const Panel& source = surface.panels[entry.panel];
    const Matrix36& jump = jumps[entry.panel].corner;
    switch (entry.kind) {
      case PairKind::Same:
        break;  // a flat panel has no double layer on itself
      case PairKind::SharedEdge:
      case PairKind::SharedVertex:
      case PairKind::Near:
        fine.add(source, jump, computeDoubleLayer);
        break;
      case PairKind::Close:
        coarse.add(source, jump, computeDoubleLayer);
        break;
      case PairKind::Middle:
      case PairKind::Far:
        coarse.add(source, jump, computeDoubleLayerByPoints);
        break;
    }
  }
  return fine.moments(surface.panels[t], jumps[t].corner) +
         coarse.moments(surface.panels[t], jumps[t].corner);
}

// ---- far field --------------------------------------------------------------------------------

/// Taylor coefficients of the kernel n_S.r/r^3 between centroids, times the source's area: a column
/// per target panel, a row per source; zero where the near field takes over.
struct FarKernel {
  MatrixXd value;  ///< with both second moments
  MatrixXd gradient_x, gradient_y, gradient_z;

  explicit FarKernel(Index panels)
      : value(panels, kPanelsAtOnce),
        gradient_x(panels, kPanelsAtOnce),
        gradient_y(panels, kPanelsAtOnce),
        gradient_z(panels, kPanelsAtOnce) {}
};

void fillFarKernel(const PanelArrays& a, Index t, const std::vector<NearPanels::Entry>& near,
                   Index column, FarKernel& kernel) {
  const Index n = a.area.size();
  for (Index first = 0; first < n; first += kFarBlock) {
    const Index count = std::min(kFarBlock, n - first);
    const auto part = [&](const ArrayXd& array) { return array.segment(first, count); };
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
  for (const NearPanels::Entry& entry : near)
    for (MatrixXd* m : {&kernel.value, &kernel.gradient_x, &kernel.gradient_y, &kernel.gradient_z})
      (*m)(entry.panel, column) = 0;
}

/// What the far field needs of the sources: rows 0-5 the mean jumps, row 6 ones, and per axis rows
/// 7-12 that component of moment times gradient.
struct FarSources {
  std::array<MatrixXd, 3> axis;
};

FarSources makeFarSources(const PanelSurface& surface, const std::vector<PanelJump>& jumps) {
  FarSources sources;
  for (MatrixXd& m : sources.axis) m.resize(13, surface.panelCount());
  for (Index s = 0; s < surface.panelCount(); ++s) {
    const Matrix36 slope = momentOf(surface.arrays, s) * jumps[s].gradient;
    for (int k = 0; k < 3; ++k) {
      sources.axis[k].col(s) << jumps[s].mean.transpose(), 1, slope.row(k).transpose();
    }
  }
  return sources;
}

/// The moments on `count` panels from `first` on that all far panels cause.
void addFarMoments(const PanelSurface& surface, const NearPanels& near,
                   const std::vector<PanelJump>& jumps, const FarSources& sources, Index first,
                   PanelMoments& moments) {
  const Index count = std::min(kPanelsAtOnce, surface.panelCount() - first);
  FarKernel kernel(surface.panelCount());
  for (Index k = 0; k < count; ++k)
    fillFarKernel(surface.arrays, first + k, near.of_panel[first + k], k, kernel);
  const MatrixXd by_value = sources.axis[0].topRows<7>() * kernel.value.leftCols(count);
  const std::array<MatrixXd, 3> by_gradient = {
      MatrixXd(sources.axis[0] * kernel.gradient_x.leftCols(count)),
      MatrixXd(sources.axis[1] * kernel.gradient_y.leftCols(count)),
      MatrixXd(sources.axis[2] * kernel.gradient_z.leftCols(count))};
  for (Index k = 0; k < count; ++k) {
    const Panel& panel = surface.panels[first + k];
    const PanelJump& jump = jumps[first + k];
    const Eigen::Matrix3d moment = momentOf(surface.arrays, first + k);
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
      moments[first + k].row(a) +=
          panel.area * (value / 3 + (moment * panel.hatGradient(a)).transpose() * slope);
  }
}

}  // namespace

PanelMoments computeExteriorMoments(const PanelSurface& surface, const NearPanels& near,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads) {
  const Index panels = surface.panelCount();
  std::vector<PanelJump> jumps(panels);
  for (Index t = 0; t < panels; ++t) jumps[t] = jumpOn(surface, jump, t);
  const FarSources sources = makeFarSources(surface, jumps);
  PanelMoments moments(panels, Matrix36::Zero());
  parallelFor(threads, (panels + kPanelsAtOnce - 1) / kPanelsAtOnce, [&](Index block) {
    const Index first = block * kPanelsAtOnce;
    addFarMoments(surface, near, jumps, sources, first, moments);
    for (Index t = first; t < std::min(first + kPanelsAtOnce, panels); ++t) {
      moments[t] += nearMoments(surface, near.of_panel[t], jumps, t);
      moments[t] /= 4 * kPi;
    }
  });
  return moments;
}

}  // namespace ambient
