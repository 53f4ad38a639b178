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

double levelOf(const HoldShape& shape, const Vector3& normal, HoldState& state) noexcept {
  if (std::isnan(state.level)) state.level = fillHold(shape, normal, state.volume, kNoGuess).height;
  return state.level;
}

}  // namespace ambient
