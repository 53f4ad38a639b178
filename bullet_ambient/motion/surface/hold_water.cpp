#include "bullet_ambient/motion/surface/hold_water.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr double kNoGuess = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-12;  // of a hold, that of fillHold()

HoldFill levelIn(const HoldShape& shape, const HoldState& state, const SurfacePlane& plane_F) {
  return fillHold(shape, plane_F.normal, state.filled(), kNoGuess);
}

}  // namespace

HoldShapes::HoldShapes(const std::vector<Hold>& holds) {
  for (const Hold& hold : holds) {
    const int from = static_cast<int>(shapes.size());
    shapes.emplace_back(hold);
    for (const HoldOpening& opening : hold.openings)
      openings.push_back({OpeningShape(opening), from, opening.to});
  }
}

void OpeningChanges::add(const AddedHole& hole) {
  holes.push_back(hole);
  added.push_back({OpeningShape(openingOf(hole)), hole.hold, -1});
  is_shut.push_back(0);
}

void VesselSloshing::resize(std::size_t count) {
  now.assign(count, {});
  moved.assign(count, {});
  modes.assign(count, {});
  later.assign(count, {});
}

WaterInside waterInside(const HoldShapes& holds, const HoldState* states,
                        const SurfacePlane& plane_F, const HoldsInBody& body,
                        HoldModes* modes) noexcept {
  WaterInside all;
  all.inertia = {};
  all.modes = modes;
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    if (modes) modes[i].modes[0].volume = modes[i].modes[1].volume = 0;
    if (!(states[i].volume > 0)) continue;
    const HoldFill fill = levelIn(holds.shapes[i], states[i], plane_F);
    HoldModes found = modesOf(holds.shapes[i], fill, plane_F, body.fluid_frame);
    // The part of the water alone, where other bodies float in it.
    const double share = states[i].volume / states[i].filled();
    found.turning *= share;
    for (SloshMode& mode : found.modes) mode.volume *= share;
    if (modes) modes[i] = found;
    all.below = withWaterInside(all.below, plane_F, fill);
    all.spread += fill.water.waterplane.spread;
    const SymmetricMatrix carried(carriedInertia(share * fill.water.volume, found));
    for (int entry = 0; entry < kSymmetricEntries; ++entry)
      all.inertia.entries[entry] += body.density * carried.entries[entry];
    all.is_any = true;
  }
  return all;
}

bool areFull(const HoldShapes& holds, const HoldState* states) noexcept {
  for (std::size_t i = 0; i < holds.shapes.size(); ++i)
    if (!(states[i].volume >= (1 - kRounding) * holds.shapes[i].capacity())) return false;
  return true;
}

bool areEmpty(const HoldShapes& holds, const HoldState* states) noexcept {
  return std::none_of(states, states + holds.shapes.size(),
                      [](const HoldState& state) { return state.volume > 0; });
}

void fillCoveredHolds(const HoldShapes& holds, const OpeningChanges* changes,
                      const SurfacePlane& plane_F, HoldState* states) noexcept {
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    const int hold = static_cast<int>(i);
    bool has_opening = false;
    forEachOpening(holds, changes, [&](const HoldShapes::Opening& opening, std::size_t) {
      has_opening = has_opening || opening.from == hold || opening.to == hold;
    });
    const bool is_covered =
        has_opening &&
        computeExtent(holds.shapes[i].hull(), plane_F.normal).second < plane_F.height;
    states[i].volume = is_covered ? holds.shapes[i].capacity() : 0;
  }
}

void mixSloshing(const HoldState* states, const HoldModes* before, const SloshingAt& after,
                 const Vector6& x, Sloshing* sloshing) noexcept {
  const auto volumeOf = [](const HoldModes& of) { return of.modes[0].volume + of.modes[1].volume; };
  for (std::size_t i = 0; i < after.count; ++i) {
    const double was = volumeOf(before[i]), is = volumeOf(after.modes[i]);
    if (!(is > was)) continue;
    const HoldState& state = states[i];
    const double kept = was / is;
    const double from_sea =
        state.change > 0 ? std::clamp(state.inflow / state.change, 0.0, 1.0) : 0;
    Sloshing joined;
    joinVessel({after.density, after.modes + i, 1, after.to_world}, x, &joined);
    sloshing[i].displacement_W *= kept;
    sloshing[i].velocity_W =
        kept * sloshing[i].velocity_W + (1 - kept) * (1 - from_sea) * joined.velocity_W;
    sloshing[i].is_known = true;
  }
}

double levelOf(const HoldShape& shape, const Vector3& normal, HoldState& state) noexcept {
  if (std::isnan(state.level))
    state.level = fillHold(shape, normal, state.filled(), kNoGuess).height;
  return state.level;
}

}  // namespace ambient
