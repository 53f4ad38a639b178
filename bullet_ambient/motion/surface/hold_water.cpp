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
  return fillHold(shape, plane_F.normal, state.volume, kNoGuess);
}

/// Returns what is on the side of a hold whose level moves towards another height: the area is the
/// mean on the way, so that the level does not pass it, whatever the shape.
WaterSide sideOf(const HoldShape& shape, const HoldState& state, double level, double towards,
                 const Vector3& normal) {
  const auto [low, high] = computeExtent(shape.hull(), normal);
  const double end = std::clamp(towards, low, high), head = end - level;
  const double change = computeWetVolume(shape.hull(), {normal, end, 0, 0}).volume - state.volume;
  const double area = head * change > 0 ? change / head : 1;  // else nothing flows
  return {level, area, std::min(state.volume, std::max(0.0, -change)),
          std::min(shape.capacity() - state.volume, std::max(0.0, change))};
}

bool isClearOf(const OpeningShape& opening, const SurfacePlane& plane_F) {
  const auto& corners = opening.corners();
  return std::none_of(corners.begin(), corners.end(),
                      [&](const Vector3& corner) { return plane_F.depth(corner) > 0; });
}

void exchangeWithSea(const HoldShape& shape, const OpeningShape& opening,
                     const SurfacePlane& plane_F, double duration, HoldState& state) {
  if (!(state.volume > 0) && isClearOf(opening, plane_F)) return;
  const Vector3& normal = plane_F.normal;
  const double level = levelIn(shape, state, plane_F).height, sea = plane_F.height;
  const double in = volumeThrough(opening, {normal, plane_F.gravity}, WaterSide{sea},
                                  sideOf(shape, state, level, sea, normal), duration);
  state.volume = std::max(0.0, state.volume + in);
  state.inflow += in;
}

void exchangeBetween(const HoldShapes& holds, const HoldShapes::Opening& door,
                     const SurfacePlane& plane_F, double duration, HoldState* states) {
  HoldState &from = states[door.from], &to = states[door.to];
  if (!(from.volume > 0) && !(to.volume > 0)) return;
  const HoldShape& here = holds.shapes[static_cast<std::size_t>(door.from)];
  const HoldShape& there = holds.shapes[static_cast<std::size_t>(door.to)];
  const Vector3& normal = plane_F.normal;
  const double level = levelIn(here, from, plane_F).height;
  const double other = levelIn(there, to, plane_F).height;
  const double passed =
      volumeThrough(door.shape, {normal, plane_F.gravity}, sideOf(here, from, level, other, normal),
                    sideOf(there, to, other, level, normal), duration);
  from.volume = std::max(0.0, from.volume - passed);
  to.volume = std::max(0.0, to.volume + passed);
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

WaterInside waterInside(const HoldShapes& holds, const HoldState* states,
                        const SurfacePlane& plane_F) noexcept {
  WaterInside all;
  Matrix6 inertia = Matrix6::Zero();
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    if (!(states[i].volume > 0)) continue;
    const HoldFill fill = levelIn(holds.shapes[i], states[i], plane_F);
    all.below = withWaterInside(all.below, plane_F, fill);
    all.spread += fill.water.waterplane.spread;
    inertia += carriedInertia(holds.shapes[i], fill.water);
    all.is_any = true;
  }
  if (all.is_any) all.inertia = SymmetricMatrix(inertia);
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

void fillCoveredHolds(const HoldShapes& holds, const SurfacePlane& plane_F,
                      HoldState* states) noexcept {
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    const int hold = static_cast<int>(i);
    bool has_opening = false, is_covered = true;
    for (const HoldShapes::Opening& opening : holds.openings) {
      if (opening.from != hold && opening.to != hold) continue;
      has_opening = true;
      for (const Vector3& corner : opening.shape.corners())
        is_covered = is_covered && plane_F.depth(corner) > 0;
    }
    states[i].volume = has_opening && is_covered ? holds.shapes[i].capacity() : 0;
  }
}

Matrix6 exchangeWater(const HoldShapes& holds, const SurfacePlane& plane_F, bool are_open,
                      double duration, HoldState* states) noexcept {
  AMBIENT_ASSERT(duration >= 0);
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    HoldState& state = states[i];
    state.inflow = std::clamp(duration * state.pump, -state.volume,
                              std::max(0.0, holds.shapes[i].capacity() - state.volume));
    state.change = -state.volume;
    state.volume += state.inflow;
  }
  for (const HoldShapes::Opening& opening : holds.openings) {
    if (!are_open) break;
    const auto from = static_cast<std::size_t>(opening.from);
    if (opening.to < 0) {
      exchangeWithSea(holds.shapes[from], opening.shape, plane_F, duration, states[from]);
    } else {
      exchangeBetween(holds, opening, plane_F, duration, states);
    }
  }
  Matrix6 come = Matrix6::Zero();
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    states[i].change += states[i].volume;
    if (!(states[i].inflow > 0) || !(states[i].volume > 0)) continue;
    const HoldFill fill = levelIn(holds.shapes[i], states[i], plane_F);
    come += std::min(1.0, states[i].inflow / states[i].volume) *
            carriedInertia(holds.shapes[i], fill.water);
  }
  return come;
}

}  // namespace ambient
