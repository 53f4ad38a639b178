#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/motion/rows/row_velocity.h"

AMBIENT_BEGIN
namespace {

// Limits of turns, those of bodies, docs/theory.md eq. (28a).
constexpr double kTreeSpin = 0.5, kTreeChange = 0.45;

// Subtracts the velocity of the flow from the velocity of the base.
void subtractFlow(const LinkTree& tree, CoordinatesOut u) { u.segment<3>(3) -= flowAround(tree); }

// Returns the largest angular speed of a link [rad/s].
double fastestSpin(LinkDynamics& dynamics, const CoordinatesIn& u) {
  dynamics.setVelocity(u);
  double fastest = 0;
  for (int i = 0; i < dynamics.tree().size(); ++i)
    fastest = std::max(fastest, dynamics.twist(i).angular.norm());
  return fastest;
}

// Returns m of docs/theory.md eq. (28a) for the velocity `x` relative to the flow and its turning
// part `t` in a step `h` [s].
double turnNumberOf(LinkDynamics& dynamics, const CoordinatesIn& x, const CoordinatesIn& t,
                    double h) {
  const double by_spin = h * fastestSpin(dynamics, x) / kTreeSpin;
  const double size = dynamics.normSquared(x);
  if (!(size > 0)) return by_spin;
  return std::max(by_spin, std::sqrt(dynamics.normSquared(t) / size) / kTreeChange);
}

// Returns X / t of eq. (28).
double turningFactor(double turn_number) {
  return std::min(1.0, std::max(0.0, 2 - 2 * turn_number)) / 2;
}

// Returns 2 a.H b; `free` is scratch memory.
double twiceProduct(LinkDynamics& dynamics, const Coordinates& a, const Coordinates& b,
                    Coordinates& free) {
  free = a + b;
  const double sum = dynamics.normSquared(free);
  free = a - b;
  return (sum - dynamics.normSquared(free)) / 2;
}

void countRejected(AmbientTree& tree, Warnings& warnings) {
  ++tree.links.front()->ambient.counters.rejected;
  warnings.warnOnce(Warning::kNotFinite);
}

void stopIfNotFinite(AmbientTree& tree, Warnings& warnings) {
  if (tree.step.start.allFinite()) return;
  tree.step.start.setZero();
  countRejected(tree, warnings);
}

// Gives a tree the velocity that it had before the substep; its motion in the fluid is not finite.
void giveUp(AmbientTree& tree, Warnings& warnings) {
  forgetLoads(tree);
  tree.step.outcome = Outcome::kStock;
  writeVelocity(*tree.multi_body, tree.step.start);
  countRejected(tree, warnings);
}

// Computes the velocity x + X of a tree whose rows turn with it. Returns false if it is not finite.
bool prepareRows(AmbientTree& tree, double h) {
  TreeStep& step = tree.step;
  LinkFlight& flight = tree.flight;
  if (step.meets_surface) stiffenForRows(tree);
  const LinkFlightResult result = flight.computeRowVelocity(step.pose, step.start, h);
  addCount(result.count, tree);
  if (!result.is_finite) return false;
  step.outcome = Outcome::kRows;
  forgetLoads(tree);
  step.end = flight.rowVelocity();
  step.moved = step.end;
  subtractFlow(tree.tree, step.moved);
  step.turn_number = turnNumberOf(flight.dynamics(), step.moved, flight.turning(), h);
  step.turning = turningFactor(step.turn_number) * flight.turning();
  step.moved = step.end + step.turning;
  if (step.meets_surface) keepWithinReach(tree);
  return true;
}

// Prepares rows of a tree that slept when the substep began and was woken since. Bullet applies no
// forces to it in this substep: rows are solved against its velocity as it is.
bool prepareWoken(AmbientTree& tree) {
  TreeStep& step = tree.step;
  forgetLoads(tree);
  tree.flight.dynamics().setPose(step.pose);
  if (!tree.flight.dynamics().factor()) return false;
  step.outcome = Outcome::kRows;
  step.moved = step.end = step.start;
  step.turning.setZero();
  step.turn_number = 0;
  return true;
}

// Sets the velocity that Bullet moves a flown tree by, u_m + d/2.
void finishFlown(AmbientTree& tree) {
  TreeStep& step = tree.step;
  step.spare = step.moved - step.change / 2;  // Bullet adds the whole change d by the rows
  writeVelocity(*tree.multi_body, step.spare);
  if (!step.change.isZero(0)) forgetLoads(tree);
  step.end += step.change;
}

// Flies a tree that no row has moved and that turns slowly; otherwise stores xi and the energy
// bound of eq. (31a), twice the energy [J].
void finishTreeRows(AmbientTree& tree, double duration, Warnings& warnings) {
  TreeStep& step = tree.step;
  if (step.change.isZero(0) && step.turn_number <= kSlowTurn && step.was_awake) {
    if (flyTree(tree, duration, warnings)) {
      writeVelocity(*tree.multi_body, step.moved);
    } else {
      giveUp(tree, warnings);
    }
    return;
  }
  LinkDynamics& dynamics = tree.flight.dynamics();
  Coordinates& free = step.spare;
  const double on_turning = twiceProduct(dynamics, step.turning, step.change, free);
  free = step.end + step.change;
  subtractFlow(tree.tree, free);
  step.energy = std::max(0.0, dynamics.normSquared(free) + std::min(0.0, on_turning));
}

// Moves `step.end` back towards `step.spare`, both relative to the flow, until twice its energy is
// at most `energy`. If twice the energy of `step.spare` is larger, too, scales `step.end` down, or
// in a fast turn sets it to `step.spare` scaled down. Returns the energy that it has lost [J].
double keepWithin(double energy, LinkDynamics& dynamics, TreeStep& step) {
  const Coordinates& from = step.spare;
  Coordinates& to = step.end;
  const double has = dynamics.normSquared(to);
  if (!(has > energy)) return 0;
  const double removed = (has - energy) / 2;
  const double had = dynamics.normSquared(from), excess = had - energy;
  if (excess > 0) {
    const bool is_slow = step.turn_number <= kSlowTurn;
    to = std::sqrt(energy / (is_slow ? has : had)) * (is_slow ? to : from);
    return removed;
  }
  Coordinates& difference = step.change;
  difference = to - from;
  const double a = dynamics.normSquared(difference), b = (has - had - a) / 2;
  const double root = std::sqrt(std::max(0.0, b * b - a * excess));
  to = from + (b > 0 ? -excess / (b + root) : (root - b) / a) * difference;
  return removed;
}

// Adds the turning part t(q_m, xi) to `step.end`: h times the part of du/dt that depends on u, at
// the pose in the middle of the step. Changes `step.pose`.
void addTurning(AmbientTree& tree, double h) {
  TreeStep& step = tree.step;
  LinkDynamics& dynamics = tree.flight.dynamics();
  Coordinates &turning = step.turning, &at_rest = step.spare;
  movePose(tree.tree, step.pose, step.moved, h / 2, step.pose);
  dynamics.setPose(step.pose);
  dynamics.factor();
  turning.setZero();
  turning.segment<3>(3) = flowAround(tree.tree);
  dynamics.accelerations(turning, at_rest);
  dynamics.accelerations(step.moved, turning);
  step.end += h * (turning - at_rest);
}

// Writes the velocity after the substep, x + d + t(q_m, xi) within the energy bound, to `step.end`.
void turnAfterRows(AmbientTree& tree, double h) {
  TreeStep& step = tree.step;
  LinkDynamics& dynamics = tree.flight.dynamics();
  step.end += step.change;
  addTurning(tree, h);
  Coordinates& from = step.spare;
  from = step.moved;
  subtractFlow(tree.tree, from);
  step.end = step.end - step.moved + from;  // for now relative to the flow
  readPose(*tree.multi_body, step.pose);
  dynamics.setPose(step.pose);
  AMBIENT_ASSERT(!(step.energy < 0));
  const double allowed = step.energy + step.reserve;
  countEnergyRemoved(keepWithin(allowed, dynamics, step), tree);
  step.reserve = std::clamp(allowed - dynamics.normSquared(step.end), 0.0, step.energy);
  step.end = step.end + step.moved - from;
}

// Corrects `step.end` of a flown tree that is not at the end pose of its flight, so that it has the
// momentum of the flight, and without rows also the energy, docs/theory.md eq. (80a). Rows of
// joints, or Bullet's limit of rotations, have moved it elsewhere.
void keepIntegrals(AmbientTree& tree, double h) {
  TreeStep& step = tree.step;
  const bool has_rows = !step.change.isZero(0);
  if (!has_rows && !turnsTooFastForBullet(tree.tree, step.moved, h)) return;
  readPose(*tree.multi_body, step.pose);
  countEnergyRemoved(tree.flight.arriveAt(step.pose, has_rows, step.end), tree);
}

// Computes the velocity that rows are solved against, and sets the outcome. Returns false if the
// velocity is not finite.
bool beginTree(AmbientTree& tree, double duration, Warnings& warnings) {
  TreeStep& step = tree.step;
  if (!step.was_awake) return prepareWoken(tree);
  if (tree.tree.size() == 1 || wasMovedByOthers(tree, step.start)) forgetLoads(tree);
  if (isAtSurface(tree)) {
    addInflow(tree);
    step.surface.start = step.start;
    kickAtSurface(tree, duration, warnings);
    keepEnergy(tree);
  }
  return step.turns_rows ? prepareRows(tree, duration) : flyTree(tree, duration, warnings);
}

// Sets the velocity of a tree that does not fly as a body.
void beginAlone(AmbientTree& tree, double duration, Warnings& warnings) {
  if (!beginTree(tree, duration, warnings)) {
    giveUp(tree, warnings);
    return;
  }
  const TreeStep& step = tree.step;
  writeVelocity(*tree.multi_body, step.outcome == Outcome::kFlown ? step.end : step.moved);
}

// Reports links that their joints turn by half a turn or more in a step: blades then meet the flow
// from few sides, whose mean is not that of a turn.
void warnOfFastJoints(const AmbientTree& tree, double duration, Warnings& warnings) {
  for (const auto& link : tree.links) {
    AmbientBody& ambient = link->ambient;
    if (link->link < 0 || ambient.counters.too_long > 0 || !ambient.isInFluid()) continue;
    const btMultiBody& body = *tree.multi_body;
    if (body.getLink(link->link).m_jointType != btMultibodyLink::eRevolute) continue;
    const auto rate = static_cast<double>(body.getJointVel(link->link));
    const double turns = std::abs(rate) * duration / (2 * kPi);
    if (turns < 0.5) continue;
    ambient.counters.too_long = 1;
    warnings.warnOfFastJoint(*ambient.def, turns, duration);
  }
}

}  // namespace

bool prepareTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept {
  AMBIENT_ASSERT(duration > 0 && !tree.links.empty());
  TreeStep& step = tree.step;
  btMultiBody& body = *tree.multi_body;
  if (isAsleep(body)) return true;
  step.outcome = Outcome::kStock;
  step.meets_surface = false;
  readPose(body, step.pose);
  step.to_base = body.getWorldToBaseRot();
  stopIfNotFinite(tree, bodies.warnings);
  if (!prepareLinks(tree, bodies, duration)) return true;
  beginTreeReading(tree);
  if (body.isUsingRK4Integration()) {
    bodies.warnings.warnOnce(Warning::kRungeKutta);
    body.setPosUpdated(false);
    setInstanceNumber(body, tree.instance);
  }
  if (fliesAsBody(tree)) return false;
  beginAlone(tree, duration, bodies.warnings);
  return true;
}

void flySingleLinks(AmbientTree* const* trees, AmbientBodies* const* of, int count,
                    double duration) noexcept {
  flyAsBodies(trees, of, count, duration);
  for (int i = 0; i < count; ++i) {
    if (isSolved(*trees[i])) {
      writeVelocity(*trees[i]->multi_body, trees[i]->step.end);
    } else {
      beginAlone(*trees[i], duration, of[i]->warnings);
    }
  }
}

void finishTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept {
  TreeStep& step = tree.step;
  if (!isSolved(tree)) return;
  readChange(*tree.multi_body, step.change);
  if (!step.change.allFinite()) {
    clearChange(*tree.multi_body);
    step.change.setZero();
    countRejected(tree, bodies.warnings);
  }
  if (step.outcome == Outcome::kFlown) {
    finishFlown(tree);
  } else {
    finishTreeRows(tree, duration, bodies.warnings);
  }
  readChangedVelocity(*tree.multi_body, step.moved);
}

void completeTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept {
  TreeStep& step = tree.step;
  btMultiBody& body = *tree.multi_body;
  if (!isSolved(tree) || isAsleep(body)) return;
  settleTree(tree, duration);
  if (step.outcome == Outcome::kRows) {
    turnAfterRows(tree, duration);
  } else {
    keepIntegrals(tree, duration);
  }
  applyAddedMassChange(tree, duration);
  if (!step.end.allFinite()) {
    countRejected(tree, bodies.warnings);
    return;
  }
  step.change = step.end - step.moved;
  addVelocity(body, step.change);
  warnOfFastJoints(tree, duration, bodies.warnings);
  keepTreeAwake(tree);
  writeJointForces(tree, duration, bodies.trees.world()->getSolverInfo());
  finishTreeReading(tree, duration);
}

AMBIENT_END
