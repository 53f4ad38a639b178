#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/motion/surface/surface_model.h"
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

/// Sphere, cube, box, cylinder, ellipsoid and a hull with a deck; sizes of the order of 1 m.
std::vector<SurfaceCase> surfaceCases();

}  // namespace ambient::study
