#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

namespace ambient {

/// A flat triangle of the surface with what the integrals over it need. Counter-clockwise seen from
/// the side the normal points to. Unit of length: any.
struct Panel {
  std::array<Eigen::Vector3d, 3> corner;
  std::array<Eigen::Vector3d, 3> edge;         ///< corner k+1 - corner k
  std::array<Eigen::Vector3d, 3> edge_normal;  ///< unit, in the plane, pointing outward, of edge k
  std::array<double, 3> edge_length;
  Eigen::Vector3d normal;    ///< unit
  Eigen::Vector3d centroid;  ///< barycentre
  double area = 0;
  double radius = 0;  ///< largest distance of a corner from the centroid

  /// Surface gradient of the hat function of corner a (1 there, 0 at the other two) [1/length].
  Eigen::Vector3d hatGradient(int a) const {
    const int opposite = (a + 1) % 3;
    return edge_normal[opposite] * (-edge_length[opposite] / (2 * area));
  }
  /// n x hatGradient(a), the surface curl of the hat function up to its sign; docs/theory.md eq.
  /// (9).
  Eigen::Vector3d hatCurl(int a) const { return edge[(a + 1) % 3] / (2 * area); }
  /// Point with barycentric coordinates b.
  Eigen::Vector3d at(const std::array<double, 3>& b) const {
    return b[0] * corner[0] + b[1] * corner[1] + b[2] * corner[2];
  }
};

/// Makes a panel from its corners. If they span no area, its normal is not finite;
/// makePanelSurface() refuses such panels.
Panel makePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

struct PanelNodes;
struct PanelNumbers;
struct PanelViews;

/// Returns the panel in plain numbers, for the kernels of panel_views.h.
PanelNumbers numbersOf(const Panel& panel);
/// Returns the points of kTriangleRule6 on a panel.
PanelNodes nodesOf(const Panel& panel);

/// Computes the views of a panel from up to 16 points, see panel_views.h.
PanelViews viewPanel(const Panel& panel, const Eigen::Vector3d* points, std::size_t count);

/// int_S 1/|x - y| dy [length] at up to 16 points x, exact for every x, on the panel too (Wilton et
/// al. 1984).
void computeNewtonPotentials(const Panel& panel, const Eigen::Vector3d* points, std::size_t count,
                             double* potentials);
double computeNewtonPotential(const Panel& panel, const Eigen::Vector3d& x);

/// int_S h_b(y) n.(x - y)/|x - y|^3 dy [1] for the three hat functions h_b at up to 16 points x,
/// exact; their sum is the solid angle of the panel seen from x, positive on the side of the
/// normal. In the panel's own plane: the principal value, 0, outside of the panel.
void computeDoubleLayers(const Panel& panel, const Eigen::Vector3d* points, std::size_t count,
                         Eigen::Vector3d* weights);
Eigen::Vector3d computeDoubleLayer(const Panel& panel, const Eigen::Vector3d& x);

}  // namespace ambient
