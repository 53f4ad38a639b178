#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/attach_def.h"

AMBIENT_BEGIN

/// Places along the principal axes of a body at which it samples the fluid beside its centre of
/// mass: outer Gauss points of a bar with the second moment of the body, docs/theory.md eq. (83).
struct BodyStations {
  /// Weight of each outer station; that of the middle one is 1 less all others.
  static constexpr double kWeight = 5.0 / 18;

  /// Columns: ways from the centre of mass to one of both stations of an axis [m], in B; the other
  /// is opposite. Zero: the body is short along this axis, or has no size.
  Matrix3 ways_B = Matrix3::Zero();
  Vector3 lengths{0, 0, 0};  ///< of the bars [m]
  double reach = 0;          ///< largest distance of a station from the centre of mass [m]
};

/// Computes the stations of a body from its volume, or from its surface if it has no volume.
BodyStations makeBodyStations(const AttachDef& def);

AMBIENT_END
