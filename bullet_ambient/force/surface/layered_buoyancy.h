#pragma once

#include <limits>

#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/medium/layers.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Body in a fluid in layers. Frame F.
struct LayeredBody {
  const FluidBody& shape;
  const PackedHull* hull;    ///< null: a sphere
  Vector3 up{0, 0, 1};       ///< of the layers, in F
  double origin_height = 0;  ///< of F's origin along it, as the layers count heights [m]
  /// Height along it of the surface of the fluid [m]; infinite: it is all around the body.
  double surface = std::numeric_limits<double>::infinity();
};

/// Fluid that a body displaces beyond that of a constant density.
struct ExcessFluid {
  double mass = 0;          ///< [kg]
  Vector3 moment{0, 0, 0};  ///< int z dm, in F [kg m]
};

/// Computes int (rho - reference) dV and its first moment over the part of a body below the surface
/// of the fluid, docs/theory.md eq. (180). Exact where the density is linear over all of the body,
/// by its second moments (FluidBody::uniform_mass, if that is known), and for spheres, and upright
/// boxes and cylinders. Else the mass errs by less than 1e-3, and the moment over the body's length
/// by less than 3e-3, of its volume times the difference of the densities that it meets. A body
/// without triangles has the density at its centre. Cost: four of computeWetVolume() for each piece
/// of the layers that the body reaches into. Allocates nothing.
ExcessFluid findExcessFluid(const LayeredBody& body, const DensityLayers& layers,
                            double reference) noexcept;

}  // namespace ambient
