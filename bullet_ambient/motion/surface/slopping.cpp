#include "bullet_ambient/motion/surface/slopping.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

/// Waves in one hold.
struct HoldWaves {
  HoldWaves(const WaterAt& at, std::size_t hold, const Sloshing& state)
      : frame(at.model.fluid_frame), modes(at.place.inside_F->modes[hold]) {
    const double gravity = at.place.plane.gravity;
    for (int i = 0; i < 2; ++i) {
      const SloshMode& mode = modes.modes[i];
      if (!(mode.volume > 0) || !state.is_known) continue;
      const double way = (at.to_world * mode.axis).dot(state.displacement_W);
      crests[i] = crestOf(mode, way, gravity);
      energy += mode.volume * mode.square / gravity * way * way / 2;
    }
  }

  double highest() const { return modes.height + std::abs(crests[0]) + std::abs(crests[1]); }
  /// Height of the surface over the level at a place in F [m].
  double riseAt(const Vector3& place_F) const {
    const Vector3 place = frame.rotation * place_F + frame.translation - modes.middle;
    double rise = 0;
    for (int i = 0; i < 2; ++i) {
      if (crests[i] == 0) continue;
      const double share = 2 * modes.modes[i].axis.dot(place) / modes.modes[i].length;
      rise += crests[i] * portable::sin(kPi / 2 * std::clamp(share, -1.0, 1.0));
    }
    return rise;
  }

  const FrameOffset& frame;
  const HoldModes& modes;
  double crests[2] = {0, 0};  ///< at the walls [m]
  double energy = 0;          ///< over rho g [m^4]
};

}  // namespace

void findWavesInside(const WaterAt& at, const OpeningChanges* changes, const Sloshing* states,
                     WavesInside& waves) noexcept {
  const HoldShapes& holds = *at.model.holds;
  const Vector3& up = at.place.immersion_F.plane.normal;
  AMBIENT_ASSERT(at.place.inside_F && waves.energy.size() == holds.shapes.size());
  std::fill(waves.reaches.begin(), waves.reaches.end(), std::uint8_t{0});
  std::fill(waves.lost.begin(), waves.lost.end(), 0.0);
  waves.is_any = false;
  if (!(at.place.plane.gravity > 0)) return;
  for (std::size_t hold = 0; hold < holds.shapes.size(); ++hold) {
    const HoldWaves of(at, hold, states[hold]);
    waves.energy[hold] = of.energy;
    if (!(of.energy > 0)) continue;
    const double highest = of.highest();
    forEachOpening(holds, changes, [&](const HoldShapes::Opening& opening, std::size_t number) {
      if (opening.to >= 0 || static_cast<std::size_t>(opening.from) != hold) return;
      if (opening.shape.isAbove(highest, up)) return;
      waves.reaches[number] = 1;
      waves.is_any = true;
      std::vector<double>& rises = waves.rises[number];
      for (std::size_t i = 0; i < rises.size(); ++i)
        rises[i] = of.riseAt(opening.shape.edges()[i].middle);
    });
  }
}

double loseSlopped(double weight, const WavesInside& waves, Sloshing* states) noexcept {
  double lost = 0;
  for (std::size_t i = 0; i < waves.lost.size(); ++i) {
    if (!(waves.lost[i] > 0)) continue;
    states[i].displacement_W *= std::sqrt(std::max(0.0, 1 - waves.lost[i] / waves.energy[i]));
    lost += waves.lost[i];
  }
  return weight * lost;
}

}  // namespace ambient
