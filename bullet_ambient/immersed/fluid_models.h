#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/surface/surface_model.h"

namespace ambient {

/// Pose and motion of a body or link at one moment, and gravity, as read from Bullet. Whatever
/// concerns the fluid reads this in place of Bullet's objects.
struct MotionView {
  RigidState state;          ///< pose in W, twist in B
  Twist twist_W;             ///< that twist in world axes
  Vector3 gravity{0, 0, 0};  ///< [m/s^2]
  double rounding = 0;       ///< relative rounding of Bullet's numbers

  const Vector3& centre() const { return state.position; }
  Matrix3 rotation() const { return state.orientation.toRotationMatrix(); }
};

/// Mass properties of a body or link as Bullet has them. Default: those of bodies that are not
/// dynamic, for which they serve until the body is.
struct InverseMass {
  double mass = 1;           ///< [1/kg]
  Vector3 inertia{1, 1, 1};  ///< of the principal moments [1/(kg m^2)]

  Vector3 moments() const { return inertia.cwiseInverse(); }
  friend bool operator==(const InverseMass& a, const InverseMass& b) {
    return a.mass == b.mass && a.inertia == b.inertia;
  }
};

/// Places along the principal axes of a body at which it samples the fluid beside its centre of
/// mass: outer Gauss points of a bar with the second moment of the body, docs/theory.md eq. (83).
struct BodyStations {
  /// Weight of each outer station; that of the middle one is 1 less all others.
  static constexpr double kWeight = 5.0 / 18;

  /// Columns: offsets from the centre of mass to one of both stations of an axis [m], in B; the
  /// other is opposite. Zero: the body is short along this axis, or has no size.
  Matrix3 offsets_B = Matrix3::Zero();
  Vector3 lengths{0, 0, 0};  ///< of the bars [m]
  double reach = 0;          ///< largest distance of a station from the centre of mass [m]
  /// Axis of a body of revolution, in B: the pressure of no flow spins it about that; else 0.
  Vector3 still_axis_B{0, 0, 0};
};

/// Computes the stations of a body from its volume, or from its surface if it has no volume.
BodyStations makeBodyStations(const AttachDef& def);

/// T in body axes with T D T^T = K^-1, D = diag(I^-1, 1/m) being what Bullet holds; docs/theory.md
/// eq. (26). From one Cholesky factor K = L L^T: T = L^-T diag(sqrt I, sqrt m), upper triangular.
/// `inertia`: K in B; `mass` m [kg], `moments` I [kg m^2]: those of the dry body, principal.
Matrix6 makeVelocityBasis(const Matrix6& inertia, double mass, const Vector3& moments);

/// A body in one medium.
struct MediumModel {
  FluidKind kind;
  BodyModel model;
  Matrix6 basis_B;  ///< velocity basis T of docs/theory.md eq. (26), body axes
};

/// A body at the surface between two fluids.
struct SurfaceMedia {
  SurfaceKind kind;
  SurfaceModel model;
};

/// Models of a body in all fluids that it may meet. Bodies whose shape, settings and mass are equal
/// share them.
struct FluidModels {
  InverseMass inverse_mass;
  std::vector<MediumModel> media;  ///< the first is that of the body's own medium
  std::vector<SurfaceMedia> surfaces;
  BodyStations stations = {};
  double reach = 0;  ///< how far from the centre of mass bounds of regions matter to the body [m]

  /// Null: the body does not meet this medium.
  const MediumModel* find(const FluidKind& kind) const noexcept;
  /// Index of the surface of this kind; -1: none.
  int findSurface(const SurfaceKind& kind) const noexcept;
};

/// Data that bodies of one Fluid share, by the numbers that they depend on.
struct ModelTables {
  SharedTables<FluidBody, FluidModels, std::vector<double>> models;
  SharedTables<FluidBody, AttachDef, std::vector<double>> defs;
};

/// Returns a definition that equal ones without a name share.
std::shared_ptr<const AttachDef> internDef(AttachDef def, ModelTables& tables);

/// Makes the models of a body in its own medium and, if it follows regions, in their fluids; or
/// returns those of an equal body.
/// @throws std::invalid_argument as makeSurfaceLoads(), makeBodyModel() and makeSurfaceModel(), or
/// if the fluid that the body displaces or moves has 2^52 times its mass.
std::shared_ptr<const FluidModels> makeFluidModels(const AttachDef& def, const InverseMass& mass,
                                                   const RegionFluids& fluids, ModelTables& tables);

/// Makes models for another mass; their loads stay. Allocates nothing. If it throws, the models
/// have no mass.
/// @throws std::invalid_argument as makeFluidModels().
void setMass(FluidModels& models, const AttachDef& def, const InverseMass& mass);

}  // namespace ambient
