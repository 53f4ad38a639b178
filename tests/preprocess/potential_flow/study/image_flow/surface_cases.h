#pragma once

#include <memory>
#include <string>

#include "bullet_ambient/motion/surface/surface_model.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// A uniform body of half the water's density, which is 1, and its mesh in F. The origin is the
/// centre of mass.
struct SurfaceCase {
  std::string shape;
  TriangleMesh mesh;
  SurfaceModel model;
};

struct SurfaceCaseDef {
  std::string shape;
  TriangleMesh mesh;
  double sphere_radius = 0;  ///< 0: the mesh is not a sphere's
  int panels = 1000;         ///< body alone, before extrapolation
};
SurfaceCase makeSurfaceCase(const SurfaceCaseDef& def);

/// Copies a body and adds a waterline table with `subdivisions`.
SurfaceCase withWaterline(const SurfaceCase& body, int subdivisions);

/// Scales a mesh about the origin to this volume.
TriangleMesh scaledToVolume(TriangleMesh mesh, double volume);

/// An ellipsoid of the volume of the smooth one.
TriangleMesh ellipsoidMesh(const Vector3& semi_axes, int faces);

/// Total inertia of body and water in F [kg, m], with a plane in F, by the image method: body's
/// inertia plus solveImageFlow() with `panels`.
Matrix6 imageInertia(const SurfaceCase& body, const SurfacePlane& plane, int panels);

/// Largest |x.K x / x.K_ref x - 1| over all motions x, including rotations; independent of the
/// origin. @pre the reference is positive definite
double largestError(const Matrix6& inertia, const Matrix6& reference);

/// Height of the plane along `normal` with half of the volume under water [m].
double floatingHeight(const SurfaceModel& model, const Vector3& normal);

}  // namespace ambient::study
