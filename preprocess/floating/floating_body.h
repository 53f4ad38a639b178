#pragma once

#include <array>
#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/surface/hydrostatics.h"

namespace ambient {

/// A body on still water; all in frame F.
struct FloatingBody {
  std::shared_ptr<const FluidBody> shape;
  double mass = 0;                    ///< [kg]
  Vector3 centre_of_mass{0, 0, 0};    ///< [m]
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre of mass [kg m^2]
  double density = 998;               ///< of the water [kg/m^3]
  double gravity = 9.81;              ///< [m/s^2]
};

/// Metacentric height of a floating body for turns about one axis in the plane of the water.
struct Metacentre {
  Vector3 axis{0, 0, 0};  ///< unit
  double height = 0;      ///< GM, above the centre of mass [m]
};

/// A small oscillation about a floating attitude, without the waves that it makes; the other
/// motions are free.
struct SmallOscillation {
  double period = 0;      ///< [s]
  Vector3 turn{0, 0, 0};  ///< unit axis of the rotation; zero: heave alone
  bool is_heave = false;  ///< true: most of its potential energy is that of heave
};

/// Stable floating attitude: a local minimum of the energy.
struct FloatingAttitude {
  Vector3 up{0, 0, 1};  ///< upward normal of the water, in F
  SurfacePlane plane;   ///< surface of the water in F
  WetVolume wet;
  double draught = 0;                     ///< depth of the lowest point [m]
  double height_of_mass = 0;              ///< height of the centre of mass above the surface [m]
  std::array<Metacentre, 2> metacentres;  ///< the smaller height first
  std::array<SmallOscillation, 3> modes;  ///< the longest period first
  double energy = 0;  ///< energy of weight and water [J]; reference: centre of mass at the surface,
                      ///< no water displaced
  double share = 0;   ///< share of all attitudes from which the body comes to this one
  int alike = 1;      ///< number of attitudes of the same energy, equal by symmetry
};

}  // namespace ambient
