#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Faces relative to the centroid of the surface, in units of their root mean square distance from
/// it.
struct CentredFaces {
  Vector3 centre{0, 0, 0};  ///< in the frame of the source [m]
  double length = 0;        ///< [m]
  FaceTable faces;          ///< with the sharpness of the source, where it has one

  /// @throws std::invalid_argument naming the body, if no faces that are apart have an area.
  CentredFaces(const FluidBody& body, const FaceTable& source);

  /// Converts faces of a level from these units to the frame of the source.
  void moveBack(FaceTable& of_level) const;
};

}  // namespace ambient
