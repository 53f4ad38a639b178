#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Wing::nose of a wing whose sections are round at both ends, as ellipses are, eq. (161e).
constexpr double kRoundAtBothEnds = 2;

/// Part of a body that lifts as a whole. Frame F.
struct LiftedPart {
  Matrix3 added_mass = Matrix3::Zero();  ///< in translation, per unit density [m^3]
  double volume = 0;                     ///< [m^3]
  double area = 0;                       ///< of all its sides [m^2]
  Vector3 centre{0, 0, 0};               ///< of its volume [m]
};

/// Returns W of docs/theory.md eq. (158) of a wing with a volume A t [m^3] and phi, 1 of flat
/// sides; 1 of one with a nose.
double wingShare(const Wing& wing, double volume, double phi);

/// Returns both sides of the rectangle b c of a wing, at 4 x 2 Gauss points of span and chord.
FaceTable plateFaces(const Wing& wing);

/// Returns the faces of the form law that have a label: 0 of the rest, or the number of a wing.
/// @pre form.part_of_face is filled
FaceTable facesOfPart(const SurfaceForm& form, std::size_t label);

/// Returns the rest of a body with wings, then its wings, docs/theory.md eq. (156) and (159); where
/// hardly any volume is left, the rest has neither volume nor added mass. Cost O(F).
/// @pre the faces of the form and their parts are filled
std::vector<LiftedPart> liftedPartsOf(const FluidBody& body);

}  // namespace ambient
