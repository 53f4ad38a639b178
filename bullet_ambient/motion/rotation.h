#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Unit quaternion of the rotation vector r [rad]: turns by |r| about r.
Quaternion rotationFromVector(const Vector3& r);

}  // namespace ambient
