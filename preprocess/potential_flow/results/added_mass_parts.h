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
/// the panels, made symmetric. Parts of a body of revolution are eight rings of twelve alike, none
/// of which gives spin about the axis any inertia; their sum is the mean of the panels' over all
/// turns about it. Independent of the unit of length. Cost: O(panels).
std::vector<AddedMassPart> joinPanels(const std::vector<PanelInertia>& panels);

/// Makes parts that planes across axes through the origin mirror, but for rounding, mirror each
/// other to the last bit: then AddedMassParts keeps few. Others stay as they are.
std::vector<AddedMassPart> mirrored(const std::vector<AddedMassPart>& parts);

/// Converts parts to another unit of length and another origin: z = length z' + centre, where z'
/// are the coordinates of the given parts. Rounds to single precision, as in files.
std::vector<AddedMassPart> placed(std::vector<AddedMassPart> parts, double length,
                                  const Vector3& centre);

}  // namespace ambient
