#pragma once

#include <memory>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "preprocess/floating/floating_energy.h"
#include "preprocess/hand_over/export_settings.h"

namespace ambient {

/// A fluid body with mass, in one fluid at one place. Vectors in F; matrices about F's origin,
/// rotation first.
struct HandedBody {
  std::shared_ptr<const FluidBody> shape;
  ExportSettings settings;
  std::string name;                      ///< the shape's; all but letters, digits, _ . - became _
  PointMass weight;                      ///< [kg], [m]
  Matrix3 inertia = Matrix3::Zero();     ///< about the centre of mass [kg m^2]
  Matrix6 added_mass = Matrix6::Zero();  ///< [kg m^2, kg m; kg m, kg]
  SurfacePlane
      plane;      ///< plane of the surface; its gravity and density count without a surface, too
  WetVolume wet;  ///< wet volume in the fluid

  /// Forward, left and up in F, as columns.
  Matrix3 axes() const;
  /// Centre of buoyancy [m]; for a sheet, which has no volume, the centre of its area.
  Vector3 middle() const;
  /// Inertia of the mass alone.
  Matrix6 ownInertia() const;
};

/// Gives a fluid body mass and fluid. The added mass at a surface is that of fast motions, the
/// potential 0 on the undisturbed surface, docs/theory.md eq. (60).
/// @throws std::invalid_argument in one line that names the fluid body, the value and the limit.
HandedBody handedBody(const std::shared_ptr<const FluidBody>& shape,
                      const ExportSettings& settings);

// Each of these makes a file of one format. Matrices are symmetric to rounding.

/// SDFormat 1.10: a model of one link with mass and fluid_added_mass. The link's frame is F.
ExportedBody makeSdf(const HandedBody& body);

/// MJCF: a free body with mass and the ellipsoid that comes nearest to its added mass. The report
/// compares the two.
ExportedBody makeMjcf(const HandedBody& body);

/// JSON: Fossen's matrices in SNAME's body axes, origin at that of F.
ExportedBody makeFossen(const HandedBody& body);

}  // namespace ambient
