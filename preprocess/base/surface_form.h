#pragma once

#include <functional>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Computes the sharpness of each face, docs/theory.md eq. (45): 0 on a sphere, 1 on flat or hollow
/// surface and at edges. Returns one entry per face, rounded to single precision, in the order of
/// the triangles of `surface`; a sheet has the entries of its back after those of its front. The
/// triangles of one flat side have one sharpness. Scale invariant. Without a surface all faces
/// count as flat. Cost O(F log F).
/// @throws std::invalid_argument in one sentence, if the faces are not these triangles.
std::vector<double> computeSharpness(const FluidBody& body);

/// Returns the sharpness of surface with a largest curvature [1/m], convex if positive, eq. (45).
/// `radius`: of the sphere with the area of the body [m].
double sharpnessOf(double curvature, double radius);

/// Returns the sharpness of a flat side with edges all around it, eq. (45): more than 1 if it is
/// long. `corners` of its outline, one after the other [m].
double sharpnessOfSide(const std::vector<Vector3>& corners);

/// Computes the numbers of a shape. A body without added mass or faces is a block. `borders_count`:
/// borders are edges; false of the rest of a body with wings, whose borders are joints. Cost O(F
/// log F), 1 us per face.
/// @throws std::invalid_argument as computeSharpness().
FormShape formShapeOf(const FluidBody& body, bool borders_count = true);

/// Returns the part of a body whose triangles have a label: 0 of the rest, or the number of a wing.
/// Area and centre of volume are its own, of the rest those of the body; what hangs on a volume is
/// left out. Sharpness is that of the whole. Cost O(F).
FluidBody partOf(const FluidBody& body, std::size_t label);

/// Returns the faces that the form law is summed over: those of the body with their sharpness,
/// except that Gauss points replace the triangles of most flat sides, 16 per four corners, and
/// triangles that are long against the body. The form law has no jump at the edge of the wake:
/// fewer points suffice, docs/accuracy.md. Round faces of a wing are as sharp as its edges are:
/// s + W (1 - s). Cost O(F).
/// @throws std::invalid_argument as computeSharpness().
FaceTable formLawFaces(const FluidBody& body, const FormShape& shape);

/// Fills what FluidBody::form has of a body with wings, docs/theory.md eq. (158), (159): faces part
/// by part, the shape of the rest, and how much of a wing each is. Cost O(F log F).
/// @pre labels and numbers of the wings are there, and the added mass
void makeWingForm(FluidBody& body);

/// Returns triangles that enclose what those of a surface do, three indices of its vertices each:
/// flat sides with a convex outline become fans where that needs fewer. The first `count` triangles
/// may be replaced, all others stay, and come last. Cost O(F log F).
std::vector<std::int32_t> fewTriangles(const Surface& surface, int count);

/// Makes the faces of the form law of a body whose FluidBody::form is there but for them.
using FormFaces = std::function<FaceTable(const FluidBody&)>;

/// Makes FluidBody::form from the other fields, also where it is there already; a part of
/// prepare(). Spheres get none. Cost O(F log F), 2 us per face.
/// @param body its surface, parts of the added mass and sharpness count
/// @param make_faces null: by formLawFaces()
/// @throws std::invalid_argument as computeSharpness().
void makeSurfaceForm(FluidBody& body, const FormFaces& make_faces = nullptr);

}  // namespace ambient
