#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Indices of faces, cluster by cluster; none is empty.
using FaceClusters = std::vector<std::vector<std::size_t>>;

/// At most `count` clusters of faces that are alike in normal and place: k-means on (n, c) with
/// weights sqrt(A), started from the faces that are farthest from each other. Deterministic. Faces
/// whose other means cannot have come nearer than their own one keep it (Hamerly 2010, from
/// memory). Centroids in units of the body's size. @pre 0 < count <= faces.size().
FaceClusters clusterFaces(const FaceTable& faces, int count);

/// Least and largest number of faces of a level: from one block of the kernel to where the sum over
/// all faces of usual meshes is cheaper.
constexpr int kFewestLevelFaces = 16, kMostLevelFaces = 1024;

/// Makes reduced faces for the form law: one level per number in `faces` that is below the number
/// of faces of the full sum; docs/theory.md eq. (51a). Each cluster of faces with similar normal
/// and place becomes one face, which only takes energy, as its faces do; areas are fitted to the
/// loads. Mirror symmetries of the body along the axes of F are kept, and so is that of a body of
/// revolution about one of them: pressure then has no moment about it. The same bits on every run.
/// Cost: 10 us per face.
/// @throws std::invalid_argument naming the body, if no faces that are apart have an area, and as
/// formLawFaces().
std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& faces);

/// Finds the smallest level of up to 256 faces whose error is at most `p99_error`; none if no level
/// with fewer faces than the full sum reaches that. Cost: 30 us per face. @throws as
/// buildFormLevels().
std::optional<FormLevel> smallestFormLevel(const FluidBody& body, double p99_error);

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
