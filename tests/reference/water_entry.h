#pragma once

#include <array>
#include <cmath>

// Forces on bodies that enter still water at a constant speed V, without gravity: potential flow.
namespace ambient::reference {

/// Slope c in F / (1/2 rho pi R^2 V^2) = c sqrt(d / R) for a sphere of radius R at small depth d of
/// its lowest point. Von Karman: added mass 4/3 a^3 of a disc, a^2 = 2 R d.
inline double karmanSphereSlope() { return 8 * std::sqrt(2.0) / std::acos(-1.0); }
/// Wagner's slope: disc of a^2 = 3 R d, since the raised water wets more of the sphere.
inline double wagnerSphereSlope() { return 12 * std::sqrt(3.0) / std::acos(-1.0); }
/// Measured slope: Moghisi and Squire, Journal of Fluid Mechanics 108 (1981). Quoted from memory.
inline double measuredSphereSlope() { return 5.5; }

// Forces F / (rho V^3 t) per length on a wedge that enters with the deadrise [rad].

/// Von Karman: added mass pi/2 b^2 of a plate; 2 b is the wedge's width at the undisturbed surface.
inline double karmanWedgeForce(double deadrise) {
  return std::acos(-1.0) / std::pow(std::tan(deadrise), 2);
}

/// Added mass of the wet wedge over rho d^2, d its draught; the potential is 0 on the undisturbed
/// surface: half the added mass of a rhombus. Faltinsen, Hydrodynamics of High-Speed Marine
/// Vehicles (2005), eq. 9.63, as cited in python-openplaning. Checks: half a square at 45 degrees,
/// the plate at small angles.
inline double wedgeAddedMass(double deadrise) {
  const double pi = std::acos(-1.0), p = deadrise / pi;
  const double gammas =
      std::tgamma(1.5 - p) / (std::pow(std::tgamma(1 - p), 2) * std::tgamma(0.5 + p));
  return (pi / std::sin(deadrise) * gammas - 1) / std::tan(deadrise);
}

/// Similarity solutions, Zhao and Faltinsen, Journal of Fluid Mechanics 246 (1993), table 1. Quoted
/// from memory.
struct WedgeForce {
  double degrees, force;
};
inline constexpr std::array<WedgeForce, 5> kSimilarWedges{
    {{10, 213.98}, {15, 85.522}, {20, 42.485}, {25, 23.657}, {30, 14.139}}};

}  // namespace ambient::reference
