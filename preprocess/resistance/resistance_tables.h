#pragma once

#include <array>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/added_mass_tables/table_places.h"

namespace ambient {

// Generated: tests/preprocess/resistance/resistance_tables.py writes resistance_tables.cpp. Places
// are those of table_places.h.

/// R over that of the ellipsoid whose semi-axes are the roots of three times the mean squares of
/// the surface, as those of a ball are.
struct BoxResistance {
  ChebyshevSeries rotation, translation;
};
const BoxResistance& boxResistance();

/// R of a body of revolution about z over that of an ellipsoid: of a cylinder as for a box, of
/// others with the same extents; the coupling R[w_y, v_x] = -R[w_x, v_y] over its v_x times the
/// height. A series without rows is 0.
struct RoundResistance {
  ChebyshevSeries v_z, v_x, w_z, w_y, coupling;
};
const RoundResistance& cylinderResistance();
const RoundResistance& capsuleResistance();
const RoundResistance& coneResistance();

/// Largest ratio of semi-axes in the table of layers.
constexpr double kLargestEllipsoidRatio = 20;

/// Layers of an ellipsoid that moves along an axis, in the order of SeparationWay: third roots of
/// k, logarithms of the others.
using LayerTable = std::array<ChebyshevSeries, SeparationWay::kNumbers>;
const LayerTable& ellipsoidLayers();

/// Layers of a capsule, to be interpolated.
struct CapsuleLayers {
  double slenderness;  ///< cylindrical part over diameter
  SeparationWay along, across;
};
const std::array<CapsuleLayers, 9>& capsuleLayers();

}  // namespace ambient
