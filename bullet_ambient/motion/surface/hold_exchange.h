#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {

/// Lets the pumps run, and water pass through the openings, one after the other, for the duration
/// of a step; docs/theory.md eq. (138) to (140), where water shuts off air (143) to (147), where
/// waves in a hold reach an opening to the sea (154a), (154b). No level passes that on the other
/// side but by a difference of pressures or of waves. Returns the inertia in F of the water that
/// has come from outside, per unit density; it was at rest there.
/// @param plane_F of the water outside
/// @param states one of each hold
Matrix6 exchangeWater(const HoldShapes& holds, const SurfacePlane& plane_F,
                      const ExchangeStep& step, HoldState* states) noexcept;

/// Tells if all holds are empty, and neither pumps nor the water outside change that: then
/// exchangeWater() does nothing. Parameters are its own.
bool staysDry(const HoldShapes& holds, const SurfacePlane& plane_F, const ExchangeStep& step,
              HoldState* states) noexcept;

/// Finds the waves of the water in the holds where they may reach the openings to the sea,
/// docs/theory.md eq. (154a). Cost: the corners of the openings of holds with waves; where one is
/// reached, 50 ns for each of its edges. Allocates nothing.
/// @param at the water at the place of the body
/// @param changes of its openings; null: none
/// @param states one of each hold
/// @param waves with a place for each opening and hold; takes the waves, of which none is lost
void findWavesInside(const WaterAt& at, const OpeningChanges* changes, const Sloshing* states,
                     WavesInside& waves) noexcept;

/// Takes from the sloshing the energy of the water that has slopped over, eq. (154b). Returns it
/// [J]. Parameters are those of findWavesInside(); the place may have been left since.
double loseSlopped(double weight, const WavesInside& waves, Sloshing* states) noexcept;

// Within exchangeWater().

/// Holds of one body while their air is found, and water flows.
struct HoldsInStep {
  const HoldShapes& holds;
  const SurfacePlane& plane_F;
  const ExchangeStep& step;
  HoldState* states;

  int count() const { return static_cast<int>(holds.shapes.size()); }
  const HoldShape& shape(int hold) const { return holds.shapes[static_cast<std::size_t>(hold)]; }
  /// Height of a level along the normal; kept in the state.
  double level(int hold) const {
    HoldState& state = states[hold];
    if (std::isnan(state.level))
      state.level = fillHold(shape(hold), plane_F.normal, state.filled()).height;
    return state.level;
  }
  double room(int hold) const {
    return std::max(0.0, shape(hold).capacity() - states[hold].filled());
  }
  Outside outside() const { return {step.atmosphere, plane_F.density * plane_F.gravity}; }
  Upward up() const { return {plane_F.normal, plane_F.gravity}; }
  double height(const Vector3& place) const { return plane_F.normal.dot(place); }
  template <class Function>
  void forEach(const Function& function) const {
    forEachOpening(holds, step.changes, function);
  }
};

/// Adds water to a hold [m^3]; its level is then not known.
void addWater(double volume, HoldState& state) noexcept;

/// Finds the holds whose air water shuts off from that outside, and which of them have the same
/// air: HoldState::is_sealed, air and air_group. Air that has more pressure than water at an
/// opening bubbles out, docs/theory.md eq. (143) to (145). Cost where no hold is sealed: the
/// corners of the openings, and the levels that the flow needs anyway.
void sealHolds(const HoldsInStep& h) noexcept;

/// Gives the holds of a group one pressure after water has moved between them. -1: does nothing.
void shareAir(const HoldsInStep& h, int group) noexcept;

/// Lets water pass through an opening that has other air on its two sides, for the duration of a
/// step, eq. (147). Cost: some clips of the holds, 1 to 20 us.
void exchangeSealed(const HoldsInStep& h, const HoldShapes::Opening& opening) noexcept;

}  // namespace ambient
