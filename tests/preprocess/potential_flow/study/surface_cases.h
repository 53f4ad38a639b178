#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/motion/surface_model.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// A body of half the density of the water, which is 1, uniform inside, and its mesh in F. The
/// origin is the centre of mass.
struct SurfaceCase {
  std::string shape;
  TriangleMesh mesh;
  SurfaceModel model;
};

struct SurfaceCaseDef {
  std::string shape;
  TriangleMesh mesh;
  double sphere_radius = 0;  ///< of a mesh that stands for a sphere
  int panels = 1000;         ///< of the body alone, before extrapolation
};
SurfaceCase makeSurfaceCase(const SurfaceCaseDef& def);

/// The same body with a waterline table of so many subdivisions.
SurfaceCase withWaterline(const SurfaceCase& body, int subdivisions);

/// Sphere, cube, box, cylinder, ellipsoid and a hull with a deck; sizes of the order of 1 m.
std::vector<SurfaceCase> surfaceCases();

}  // namespace ambient::study
