#include "bullet_ambient/motion/surface/hold_exchange.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

constexpr double kNoWater = -std::numeric_limits<double>::infinity();  // height of its level

/// Returns what is on the side of a hold whose level moves towards another height: the area is the
/// mean on the way, so that the level does not pass it, whatever the shape.
WaterSide waterSideOf(const HoldsInStep& h, int hold, double towards) {
  const HoldShape& shape = h.shape(hold);
  const Vector3& normal = h.plane_F.normal;
  const double level = h.level(hold);
  const auto [low, high] = computeExtent(shape.hull(), normal);
  const double end = std::clamp(towards, low, high), head = end - level;
  const double change =
      computeWetVolume(shape.hull(), {normal, end, 0, 0}).volume - h.states[hold].filled();
  const double area = head * change > 0 ? change / head : 1;  // else nothing flows
  return {level, area, std::min(h.states[hold].volume, std::max(0.0, -change)),
          std::max(0.0, std::min(shape.capacity() - h.states[hold].filled(), change))};
}

/// An opening to the sea; made by seaAt().
struct SeaAt {
  const OpeningShape& opening;
  const SurfacePlane& plane_F;
  const std::vector<double>* rises;             ///< of the sea at its edges [m]; null: none
  const std::vector<double>* inside = nullptr;  ///< of the water in the hold there [m]; null: none

  const double* data() const { return rises ? rises->data() : nullptr; }
  const double* dataInside() const { return inside ? inside->data() : nullptr; }
};

SeaAt seaAt(const HoldsInStep& h, const HoldShapes::Opening& opening, std::size_t number) {
  return {opening.shape, h.plane_F, h.step.rises ? &(*h.step.rises)[number] : nullptr,
          h.step.waves ? h.step.waves->at(number) : nullptr};
}

/// Whether an opening is above a height, the sea and all waves, so that nothing flows.
bool isClear(const SeaAt& sea, double height) {
  const Vector3& normal = sea.plane_F.normal;
  bool is_clear = sea.opening.isAbove(std::max(height, sea.plane_F.height), normal);
  if (sea.rises)
    for (std::size_t i = 0; i < sea.rises->size(); ++i)
      is_clear =
          is_clear && !(sea.plane_F.depth(sea.opening.edges()[i].middle) + (*sea.rises)[i] > 0);
  if (sea.inside)
    for (std::size_t i = 0; i < sea.inside->size(); ++i)
      is_clear =
          is_clear && !(normal.dot(sea.opening.edges()[i].middle) < height + (*sea.inside)[i]);
  return is_clear;
}

/// Lowest and highest of the waves at an opening [m]; 0: none.
std::pair<double, double> extentOf(const std::vector<double>* rises) {
  if (!rises) return {0, 0};
  const auto [low, high] = std::minmax_element(rises->begin(), rises->end());
  return {*low, *high};
}

/// Height to which the level in a hold may go: that of the sea, of waves the highest over the
/// lowest inside if water comes in, else the lowest over the highest inside.
double aimOf(const SeaAt& sea, double level) {
  const double height = sea.plane_F.height;
  if (!sea.rises && !sea.inside) return height;
  const double flow = flowThrough(sea.opening, {sea.plane_F.normal, sea.plane_F.gravity}, height,
                                  level, sea.data(), sea.dataInside());
  const auto outside = extentOf(sea.rises), inside = extentOf(sea.inside);
  return height + (flow > 0 ? outside.second - inside.first : outside.first - inside.second);
}

/// Returns what comes in of a volume over waves inside, docs/theory.md eq. (154b): they lose the
/// energy of what slops over their crests, and what lifts water from the lower level to the higher
/// one. `available`: energy of the waves over rho g [m^4]; it becomes what is left.
double sloppedIn(const HoldShape& shape, const SeaAt& sea, const HoldState& state, double in,
                 double& available) {
  HoldState after = state;
  addWater(in, after);
  const double level = fillHold(shape, sea.plane_F.normal, after.filled()).height;
  const double lift = std::max(0.0, in * (level - sea.plane_F.height));
  const double share = lift > available ? available / lift : 1;
  const double crest = std::max(0.0, extentOf(sea.inside).second);
  const double lost = std::max(share * lift, std::max(0.0, -share * in) * crest);
  available = std::max(0.0, available - lost);
  return share * in;
}

void exchangeWithSea(const HoldsInStep& h, const HoldShapes::Opening& opening, std::size_t number) {
  const SeaAt sea = seaAt(h, opening, number);
  HoldState& state = h.states[opening.from];
  if (!(state.volume > 0) && isClear(sea, kNoWater)) return;
  const double level = h.level(opening.from);
  if (isClear(sea, level)) return;
  WaterSide outside{h.plane_F.height}, inside = waterSideOf(h, opening.from, aimOf(sea, level));
  outside.rises = sea.data();
  inside.rises = sea.dataInside();
  double in = volumeThrough(sea.opening, h.up(), outside, inside, h.step.duration);
  if (sea.inside && in != 0) {
    double& lost = h.step.waves->lost[static_cast<std::size_t>(opening.from)];
    const double energy = h.step.waves->energy[static_cast<std::size_t>(opening.from)];
    double available = energy - lost;
    in = sloppedIn(h.shape(opening.from), sea, state, in, available);
    lost = energy - available;
  }
  addWater(in, state);
  state.inflow += in;
}

void exchangeBetween(const HoldsInStep& h, const HoldShapes::Opening& door) {
  HoldState &from = h.states[door.from], &to = h.states[door.to];
  if (!(from.volume > 0) && !(to.volume > 0)) return;
  const double level = h.level(door.from), other = h.level(door.to);
  if (door.shape.isAbove(std::max(level, other), h.plane_F.normal)) return;
  const double passed = volumeThrough(door.shape, h.up(), waterSideOf(h, door.from, other),
                                      waterSideOf(h, door.to, level), h.step.duration);
  addWater(-passed, from);
  addWater(passed, to);
}

/// Whether an opening has the same air on both sides, so that no difference of pressures counts.
bool hasOneAir(const HoldShapes::Opening& opening, const HoldState* states) {
  const int there = opening.to < 0 ? -1 : states[opening.to].air_group;
  return states[opening.from].air_group == there;
}

/// Exchanges through an opening that is not shut; `number`: its own among all.
void exchangeThrough(const HoldsInStep& h, const HoldShapes::Opening& opening, std::size_t number) {
  if (!hasOneAir(opening, h.states)) {
    exchangeSealed(h, opening);
  } else if (opening.to < 0) {
    exchangeWithSea(h, opening, number);
  } else {
    exchangeBetween(h, opening);
    shareAir(h, h.states[opening.from].air_group);
  }
}

/// Whether nothing flows: all openings are above the water on both sides, and each hold with water
/// has one to the air.
bool areClear(const HoldsInStep& h) {
  const auto level = [&](int hold) { return h.states[hold].volume > 0 ? h.level(hold) : kNoWater; };
  bool are_clear = true;
  h.forEach([&](const HoldShapes::Opening& opening, std::size_t number) {
    if (!are_clear) return;
    const double here = level(opening.from);
    are_clear = opening.to < 0
                    ? isClear(seaAt(h, opening, number), here)
                    : opening.shape.isAbove(std::max(here, level(opening.to)), h.plane_F.normal);
  });
  for (int i = 0; are_clear && i < h.count(); ++i) {
    if (!(h.states[i].volume > 0)) continue;
    are_clear = false;
    h.forEach([&](const HoldShapes::Opening& opening, std::size_t) {
      are_clear = are_clear || (opening.from == i && opening.to < 0);
    });
  }
  return are_clear;
}

/// Lets the pump of a hold run. Sealed air is pressed together to a half in a step at most.
/// `known`: ExchangeStep::modes of the hold; null: not known.
void runPump(const HoldShape& shape, double duration, const HoldModes* known, HoldState& state) {
  const double room = std::max(0.0, shape.capacity() - state.filled());
  state.inflow = std::clamp(duration * state.pump, -state.volume,
                            state.is_sealed && state.air > 0 ? room / 2 : room);
  state.change = -state.volume;
  state.volume += state.inflow;
  state.level = known && state.inflow == 0 && state.volume > 0
                    ? known->height
                    : std::numeric_limits<double>::quiet_NaN();
  state.air_group = -1;
}

/// The last drops of a hold leave with what has left before: fillHold() sees none.
void loseDregs(const HoldShape& shape, HoldState& state) {
  constexpr double kDregs = 1e-12;  // of the hold
  if (!(state.volume <= kDregs * shape.capacity())) return;
  state.change -= state.volume;
  state.inflow -= state.volume;
  state.volume = 0;
}

}  // namespace

bool staysDry(const HoldShapes& holds, const SurfacePlane& plane_F, const ExchangeStep& step,
              HoldState* states) noexcept {
  return std::none_of(states, states + holds.shapes.size(),
                      [](const HoldState& state) { return state.volume > 0 || state.pump > 0; }) &&
         (!step.are_open || areClear({holds, plane_F, step, states}));
}

Matrix6 exchangeWater(const HoldShapes& holds, const SurfacePlane& plane_F,
                      const ExchangeStep& step, HoldState* states) noexcept {
  AMBIENT_ASSERT(step.duration >= 0 && step.atmosphere > 0);
  for (std::size_t i = 0; i < holds.shapes.size(); ++i)
    runPump(holds.shapes[i], step.duration, step.modes ? &step.modes[i] : nullptr, states[i]);
  const HoldsInStep h{holds, plane_F, step, states};
  if (step.are_open && areClear(h)) {
    for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
      states[i].is_sealed = false;
      states[i].air = 0;
    }
  } else if (step.are_open) {
    sealHolds(h);
    h.forEach([&h](const HoldShapes::Opening& opening, std::size_t number) {
      exchangeThrough(h, opening, number);
    });
  }
  Matrix6 come = Matrix6::Zero();
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    states[i].change += states[i].volume;
    if (states[i].change < 0) loseDregs(holds.shapes[i], states[i]);
    if (!(states[i].inflow > 0) || !(states[i].volume > 0)) continue;
    const HoldFill fill = fillHold(holds.shapes[i], plane_F.normal, states[i].volume);
    come += std::min(1.0, states[i].inflow / states[i].volume) *
            carriedInertia(fill.water.volume, modesOf(holds.shapes[i], fill, plane_F));
  }
  return come;
}

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
