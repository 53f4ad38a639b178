#include "bullet_ambient/motion/surface/hold_water.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"

namespace ambient {
namespace {

constexpr double kRounding = 1e-12;  // of a hold, that of fillHold()

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
                        const SurfacePlane& plane_F, const FrameOffset& frame, double density,
                        HoldModes* modes) noexcept {
  WaterInside all;
  all.inertia = {};
  all.modes = modes;
  for (std::size_t i = 0; i < holds.shapes.size(); ++i) {
    if (modes) modes[i].modes[0].volume = modes[i].modes[1].volume = 0;
    if (!(states[i].volume > 0)) continue;
    const HoldFill fill = fillHold(holds.shapes[i], plane_F.normal, states[i].filled());
    HoldModes found = modesOf(holds.shapes[i], fill, plane_F, frame);
    // The part of the water alone, where other bodies float in it.
    const double share = states[i].volume / states[i].filled();
    found.turning *= share;
    for (SloshMode& mode : found.modes) mode.volume *= share;
    if (modes) modes[i] = found;
    all.below = withWaterInside(all.below, plane_F, fill);
    all.spread += fill.water.waterplane.spread;
    const SymmetricMatrix carried(carriedInertia(share * fill.water.volume, found));
    for (int entry = 0; entry < kSymmetricEntries; ++entry)
      all.inertia.entries[entry] += density * carried.entries[entry];
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

namespace {

/// Calls act(mode, e in W, state) for each mode.
template <class States, class Act>
void forEachMode(const SloshingAt& at, States* states, const Act& act) {
  for (std::size_t i = 0; i < at.count; ++i)
    for (const SloshMode& mode : at.modes[i].modes)
      if (mode.volume > 0) act(mode, Vector3(at.to_world * mode.axis), states[i]);
}

/// Returns N: N.x is the velocity of the pivot of a mode for a twist x in B.
Vector6 motionOf(const SloshMode& mode) { return stack(mode.pivot.cross(mode.axis), mode.axis); }

/// Damping ratio: that of the settings, and what waves lose that reach floor or top of the hold.
double dampingRatio(double least, double displacement, double farthest) {
  constexpr double kMost = 10;
  const double square = displacement * displacement;
  return square == 0 ? least : least + std::min(kMost, square / (2 * farthest * farthest));
}

}  // namespace

void joinVessel(const SloshingAt& at, const Vector6& x, Sloshing* states) noexcept {
  if (std::all_of(states, states + at.count, [](const Sloshing& state) { return state.is_known; }))
    return;
  for (std::size_t i = 0; i < at.count; ++i)
    if (!states[i].is_known) states[i] = {};
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, Sloshing& state) {
    if (!state.is_known) state.velocity_W += motionOf(mode).dot(x) * axis_W;
  });
  forEachMode(at, states,
              [](const SloshMode&, const Vector3&, Sloshing& state) { state.is_known = true; });
}

SloshingEnergy energyOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  SloshingEnergy energy;
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, const Sloshing& state) {
    const double u = axis_W.dot(state.velocity_W), q = axis_W.dot(state.displacement_W);
    const double half_mass = at.density * mode.volume / 2;
    energy.kinetic += half_mass * u * u;
    energy.potential += half_mass * mode.square * q * q;
  });
  return energy;
}

Momentum momentumOfSloshing(const SloshingAt& at, const Sloshing* states) noexcept {
  Vector6 momentum = Vector6::Zero();
  forEachMode(at, states, [&](const SloshMode& mode, const Vector3& axis_W, const Sloshing& state) {
    momentum += at.density * mode.volume * axis_W.dot(state.velocity_W) * motionOf(mode);
  });
  return {at.to_world * momentum.head<3>(), at.to_world * momentum.tail<3>()};
}

double projectOnModes(const SloshingAt& at, double energy, Sloshing* states) noexcept {
  for (std::size_t i = 0; i < at.count; ++i) {
    const Sloshing before = states[i];
    states[i] = {};
    for (const SloshMode& mode : at.modes[i].modes) {
      if (!(mode.volume > 0)) continue;
      const Vector3 axis_W = at.to_world * mode.axis;
      states[i].is_known = true;
      states[i].displacement_W += axis_W.dot(before.displacement_W) * axis_W;
      states[i].velocity_W += axis_W.dot(before.velocity_W) * axis_W;
    }
  }
  const double after = energyOfSloshing(at, states).sum();
  if (!(after > energy)) return after;
  const double scale = std::sqrt(std::max(0.0, energy) / after);
  for (std::size_t i = 0; i < at.count; ++i) {
    states[i].displacement_W *= scale;
    states[i].velocity_W *= scale;
  }
  return std::max(0.0, energy);
}

namespace {

/// A mode in the motion of its body.
struct SloshAlong {
  SloshAlong(const SloshingAt& at, const SloshMode& of, double least_damping, const Sloshing& state)
      : axis_W(at.to_world * of.axis),
        motion(plain(motionOf(of))),
        mass(at.density * of.volume),
        square(of.square),
        way(axis_W.dot(state.displacement_W)),
        velocity(axis_W.dot(state.velocity_W)),
        damping(dampingRatio(least_damping, way, of.farthest)) {}

  /// Lets mode and body act on each other by the implicit midpoint rule. Returns the twist.
  SpatialsOf<double> exchange(const SymmetricOf<double>& inverse, double duration,
                              const SpatialsOf<double>& x, Sloshing& state) {
    const double half = duration / 2, stiffness = mass * square;
    const double loss = 2 * damping * mass * std::sqrt(square);
    const SpatialsOf<double> answer = inverse * motion;
    const double inverse_mass = 1 / mass + dot(motion, answer);
    const double rate = (velocity - dot(motion, x) - half * inverse_mass * stiffness * way) /
                        (1 + half * inverse_mass * (loss + half * stiffness));
    const double impulse = duration * (stiffness * (way + half * rate) + loss * rate);
    const double way_before = way, velocity_before = velocity;
    way = way + duration * rate;
    velocity = velocity - impulse / mass;
    state.displacement_W += (way - way_before) * axis_W;
    state.velocity_W += (velocity - velocity_before) * axis_W;
    return x + impulse * answer;
  }
  double energy() const { return 0.5 * mass * (velocity * velocity + square * way * way); }

  Vector3 axis_W;
  SpatialsOf<double> motion;  ///< N: N.x is the velocity of the pivot for a twist x in B
  double mass;                ///< m_1 [kg]
  double square;              ///< omega^2 [1/s^2]
  double way, velocity;       ///< q [m], u [m/s]
  double damping;             ///< zeta [1]
};

}  // namespace

Sloshed exchangeSloshing(const SloshingAt& at, const SymmetricMatrix& inverse, double damping,
                         double duration, const Vector6& x, Sloshing* states) noexcept {
  AMBIENT_ASSERT(duration >= 0 && damping >= 0);
  SpatialsOf<double> end = plain(x);
  double energy = 0;
  for (std::size_t i = 0; i < at.count; ++i) {
    const Sloshing before = states[i];  // of both modes
    for (const SloshMode& mode : at.modes[i].modes) {
      SloshAlong along(at, mode, damping, before);
      if (!(along.mass > 0)) continue;
      end = along.exchange(inverse, duration, end, states[i]);
      energy += along.energy();
    }
  }
  return {asEigen(end), energy};
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

}  // namespace ambient
