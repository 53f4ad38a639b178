#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Contribution of one triangle to the added mass.
struct PanelInertia {
  Vector3 normal, centroid;
  double area = 0;
  Vector6 spread = Vector6::Zero();   ///< as AddedMassPart::spread
  Matrix6 inertia = Matrix6::Zero();  ///< -int g phi^T dA, perhaps not symmetric
};

/// Joins panels with similar normal and place to at most 96 parts. The sum of the parts is that of
/// the panels, made symmetric. Independent of the unit of length. Cost: O(panels).
std::vector<AddedMassPart> joinPanels(const std::vector<PanelInertia>& panels);

/// Returns the parts without what they give motions that move next to no water in unbounded fluid,
/// as the spin of a body of revolution: these move none at its surface either. A motion x is one if
/// x.Kx < 1e-3 x.Mx, K the added mass, M the inertia of the displaced fluid, both per unit density
/// and about the origin of the parts. Rounds as placed(). @pre M is positive definite
std::vector<AddedMassPart> withoutStillMotions(std::vector<AddedMassPart> parts,
                                               const Matrix6& added_mass, const Matrix6& displaced);

/// Converts parts to another unit of length and another origin: z = length z' + centre, where z'
/// are the coordinates of the given parts. Rounds to single precision, as in files.
std::vector<AddedMassPart> placed(std::vector<AddedMassPart> parts, double length,
                                  const Vector3& centre);

}  // namespace ambient
