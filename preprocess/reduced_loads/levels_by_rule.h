#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

// Few faces for shapes that follow from a few numbers: Gauss points on their sides, by rule.

/// Error of these faces in one fluid at most, as FormLevel::p99_error, whatever the sizes.
constexpr double kRuleError = 0.01;

/// Makes the faces of the form law of a box: on each side 1 to 4 x 1 to 4 points, fewer along short
/// edges, 54 for a cube. They serve where a surface of water cuts the body, too. half_sizes [m] and
/// pose in F are those of the box.
FaceTable boxFaces(const Vector3& half_sizes, const FrameOffset& pose);

/// Makes the faces of a cylinder, capsule or cone about the z axis of its frame,
/// centred; the apex of the cone is above. They serve where a surface of water cuts the body, too:
/// 80 to 96 on a body up to twice as long as wide. radius, height [m] and pose in F are those of
/// the shape; the height of a capsule is that of its straight part. `body`: the fluid body of the
/// shape.
FaceTable cylinderFaces(double radius, double height, const FrameOffset& pose,
                        const FluidBody& body);
FaceTable capsuleFaces(double radius, double height, const FrameOffset& pose,
                       const FluidBody& body);
FaceTable coneFaces(double radius, double height, const FrameOffset& pose, const FluidBody& body);

}  // namespace ambient
