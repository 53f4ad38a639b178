#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Numbers of a shape that tell the form law a wing from a block, and a slender hull from both;
/// docs/theory.md eq. (45a) to (45d). All follow from added mass, faces and surface. Frame F.
struct FormShape {
  double wing = 0;           ///< W in [0, 1]: 1 of a thin plate, 0 of a body as thick as it is wide
  double edges = 1;          ///< E in [0, 1]: 0 of a smooth body, 1 of a sheet
  double aspect = 1;         ///< L >= 1: span over chord
  double chord = 0;          ///< c_w [m]
  Vector3 facing{0, 0, 0};   ///< z: normal of the mean plane, either way; unit length
  Vector3 span{0, 0, 0};     ///< h: longest direction of that plane, either way; unit length
  Vector3 slender{0, 0, 0};  ///< m: long axis of a smooth slender body; length in [0, 1]
  Vector3 pitching{0, 0, 0};  ///< a: axis of pitching of a wing, along the span; length in [0, 1]
  Vector3 centre{0, 0, 0};    ///< centre of volume [m]

  bool isWing() const { return wing > 0; }
  bool isSlender() const { return !slender.isZero(0); }
  /// Returns mu of a face, eq. (43d): its arm in pitching [m].
  double pitchingArm(const Vector3& normal, const Vector3& place) const;
};

/// Computes the numbers of a shape. A body without added mass or faces is a block. Cost O(F log F),
/// 1 us per face.
/// @throws std::invalid_argument as computeSharpness().
FormShape formShapeOf(const FluidBody& body);

}  // namespace ambient
