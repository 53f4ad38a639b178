#pragma once

#include <Eigen/Core>

#include "preprocess/potential_flow/surface/panel_surface.h"

namespace ambient {

/// Relative position of two panels, from the same panel to far apart.
enum class PairKind { Same, SharedEdge, SharedVertex, Near, Close, Middle, Far };

/// Pairs whose q is larger are PairKind::Far.
inline constexpr double kFarLimit = 3.5449;  // 2 sqrt(pi)

/// Kind of the pair, by shared vertices, else by q = distance of the centroids over the sum of the
/// radii.
PairKind classifyPair(const PanelSurface& surface, Eigen::Index t, Eigen::Index s);

/// int_T int_S 1/|x - y| dx dy [length^3]. Exact reductions for panels that touch (docs/theory.md
/// eq. (9)), quadrature by q for the others. The order of t and s matters to the error of the
/// quadrature only.
double computePairIntegral(const PanelSurface& surface, Eigen::Index t, Eigen::Index s);
/// The same, where the kind of the pair is known.
double computePairIntegral(const PanelSurface& surface, Eigen::Index t, Eigen::Index s,
                           PairKind kind);

/// row[k] = far-field integral of panel t and panel first + k, for a whole row: PairKind::Far.
void computeFarPairIntegrals(const PanelArrays& arrays, Eigen::Index t, Eigen::Index first,
                             Eigen::ArrayXd& row);

}  // namespace ambient
