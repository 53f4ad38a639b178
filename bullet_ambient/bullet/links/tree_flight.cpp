#include <algorithm>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/motion/flight/flight.h"

// Flights of trees without joints, as rigid bodies.

AMBIENT_BEGIN

namespace {

AmbientLink& baseOf(const AmbientTree& tree) { return *tree.links.front(); }

// Reads where the flights of trees without joints begin, with the roundings of rigid bodies.
void readStartStates(AmbientTree* const* trees, int count, StartStates& starts) {
  btMatrix3x3 rotations[kFlightsTogether];
  const btMatrix3x3* all[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) {
    const LinkDynamics& dynamics = trees[i]->flight.dynamics();
    starts.twists_W[i] = baseOf(*trees[i]).now.twist_W;
    rotations[i] = toBulletMatrix(dynamics.rotation(0));
    all[i] = &rotations[i];
  }
  Quaternion orientations[kFlightsTogether];
  Twist twists_B[kFlightsTogether];
  computeAttitudes(all, starts.twists_W, count, orientations, twists_B);
  for (int i = 0; i < count; ++i) {
    const AmbientLink& base = baseOf(*trees[i]);
    const MotionView& now = base.now;
    starts.states[i] = {orientations[i], now.centre(), twists_B[i]};
    // That of the flow along it is added below.
    Wrench applied = trees[i]->flight.dynamics().appliedWrench(0);
    applied -= pushByFlow(base.ambient, now.state.orientation);
    starts.surroundings[i] = surroundingsOf(base.ambient, now.gravity,
                                            {rounded(applied.torque), rounded(applied.force)});
    addFlowAlong(base.ambient, now.state.orientation, starts.surroundings[i]);
  }
}

void setFlown(TreeStep& step) {
  step.outcome = Outcome::kFlown;
  step.reserve = 0;
}

// Moves a tree to the end of its link's flight. Returns false if the flight has failed or
// Bullet cannot move the tree to its end.
bool applyFlight(AmbientTree& tree, Warnings& warnings, double duration) {
  TreeStep& step = tree.step;
  AmbientBody& ambient = baseOf(tree).ambient;
  if (std::exchange(ambient.outcome.kind, Outcome::kNotSolved) != Outcome::kFlown) return false;
  const LastFlight& end = std::as_const(ambient.outcome).flight();
  step.moved << end.effective_W.angular, end.effective_W.linear;
  if (turnsTooFastForBullet(tree.tree, step.moved, duration)) return false;
  step.end << end.left_W.angular, end.left_W.linear;
  TreePose& reached = step.surface.middle;  // scratch memory: bodies have no middle
  reached.orientation = end.orientation;
  reached.position = end.position;
  tree.flight.stay(reached, step.end);
  setFlown(step);
  if (ambient.outcome.is_too_long) warnings.warnOfLongSteps(*ambient.def);
  return true;
}

}  // namespace

bool fliesAsBody(const AmbientTree& tree) noexcept {
  return tree.tree.size() == 1 && !tree.tree.links.front().keeps_velocity &&
         tree.tree.has_gyroscopic_term && tree.step.was_awake && !tree.step.turns_rows;
}

void flyAsBodies(AmbientTree* const* trees, AmbientBodies* const* of, int count,
                 double duration) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  AmbientBody* bodies[kFlightsTogether] = {};
  LastFlight before[kFlightsTogether];
  Twist changes_W[kFlightsTogether];
  for (int i = 0; i < count; ++i) {
    AmbientLink& base = baseOf(*trees[i]);
    bodies[i] = &base.ambient;
    before[i] = base.ambient.outcome.flight();
    if (base.ambient.surface()) base.start = *base.ambient.floating;
  }
  StartStates starts;
  readStartStates(trees, count, starts);
  beginFlights(bodies, starts, count, duration, changes_W);
  for (int i = 0; i < count; ++i) {
    if (applyFlight(*trees[i], of[i]->warnings, duration)) continue;
    bodies[i]->outcome.motion = before[i];  // in the place where the tree knows its memory
    if (bodies[i]->surface()) *bodies[i]->floating = baseOf(*trees[i]).start;
  }
}

void FlightQueue::fly() noexcept {
  if (const int count = std::exchange(trees_.count, 0))
    flySingleLinks(trees_.flyers, trees_.of, count, time_step_);
  const int count = std::exchange(bodies_.count, 0);
  if (count == 0) return;
  flyBodies(bodies_.flyers, count, time_step_);
  for (int i = 0; i < count; ++i) reportFlight(*bodies_.flyers[i].ambient, bodies_.of[i]->warnings);
}

namespace {

// Returns the settings of the flight of all links: the strictest tolerance and the largest number
// of substeps among them.
LinkFlightSettings settingsOf(const AmbientTree& tree) {
  LinkFlightSettings settings;
  int most = 0;
  for (const auto& link : tree.links) {
    settings.tolerance = std::min(settings.tolerance, link->ambient.def->flight.tolerance);
    most = std::max(most, link->ambient.def->flight.max_substeps);
  }
  if (most > 0) settings.max_substeps = most;
  return settings;
}

// Adds the error of a step to that of each link. Counts and reports links for which steps are too
// long, unless the user limits max_substeps.
void addErrors(double error, AmbientTree& tree, Warnings& warnings) {
  for (const auto& link : tree.links) {
    AmbientBody& ambient = link->ambient;
    if (!ambient.step_errors.add(error) || ambient.def->flight.max_substeps > 0) continue;
    ambient.counters.too_long = 1;
    warnings.warnOfLongSteps(*ambient.def);
  }
}

// Flight of a tree in one substep.
class TreeFlight {
 public:
  TreeFlight(AmbientTree& tree, double duration, Warnings& warnings)
      : tree_(tree),
        step_(tree.step),
        duration_(duration),
        warnings_(warnings),
        settings_(settingsOf(tree)) {}

  bool fly() {
    flyPart(duration_);
    step_.moved = tree_.flight.meanVelocity();
    if (is_finite_ && step_.meets_surface && mayGainEnergy(tree_, duration_) && hasGained(1, 1))
      flyInParts();
    if (count_.halted) forgetLoads(tree_);
    if (!is_finite_) return false;
    addCount(count_, tree_);
    addErrors(count_.error, tree_, warnings_);
    countEnergyRemoved(count_.energy_removed, tree_);
    setFlown(step_);
    return true;
  }

 private:
  void flyPart(double duration) {
    if (step_.meets_surface) floatInMiddle(tree_);
    const LinkFlightResult result = tree_.flight.fly(step_.pose, step_.start, duration, settings_);
    is_finite_ = is_finite_ && result.is_finite;
    step_.end = tree_.flight.endVelocity();
    count_ += result.count;
  }

  // True if the energy has grown after `made` of `parts` parts. The pose is the end of the last
  // part.
  bool hasGained(int made, int parts) {
    tree_.flight.dynamics().setPose(tree_.flight.endPose());
    return hasGainedEnergy(tree_, made * duration_ / parts);
  }

  // Flies the step again in 2, 4, ... parts, until the energy suffices for the pose at the end. If
  // it never does, the motion ends after the last part at whose end it suffices.
  void flyInParts() {
    step_.surface.pose = step_.pose;
    forEachAtSurface(tree_, [](AmbientLink& link, int) { link.start = *link.ambient.floating; });
    int parts = 1, reached = 0;
    while (is_finite_ && reached < parts && parts < settings_.max_substeps) {
      parts = std::min(2 * parts, settings_.max_substeps);
      reached = flyParts(parts, parts);
    }
    if (reached < parts) halt(reached, parts);
    step_.pose = step_.surface.pose;
    step_.start = step_.surface.start;
    velocityBetween(tree_.tree, step_.pose, tree_.flight.endPose(), duration_, step_.moved);
    step_.moved.segment<3>(3) +=
        (1 - static_cast<double>(reached) / parts) * flowAround(tree_.tree);
  }

  // Ends the motion after `reached` of `parts` parts. After 0 parts the tree rests in the flow.
  void halt(int reached, int parts) {
    count_.halted = true;
    if (reached > 0) {
      flyParts(reached, parts);
      return;
    }
    returnToStart();
    kickAtSurface(tree_, duration_ / parts, warnings_);
    restInFlow(tree_.tree, step_.end);
    tree_.flight.stay(step_.pose, step_.end);
  }

  // Flies the first `made` of `parts` parts. Returns the number of the last part at whose end the
  // energy suffices; 0: none.
  int flyParts(int made, int parts) {
    returnToStart();
    const double part = duration_ / parts;
    int reached = 0;
    for (int i = 1; i <= made && is_finite_; ++i) {
      if (i > 1) arrive();
      kickAtSurface(tree_, part, warnings_);
      flyPart(part);
      if (!hasGained(i, parts)) reached = i;
    }
    return reached;
  }

  // Passes the surface at the end of a part.
  void arrive() {
    step_.pose = tree_.flight.endPose();
    forgetLoads(tree_);
    count_.energy_removed += arriveAtSurface(tree_);
    step_.start = step_.end;
  }

  // Restores the start of the step: pose, velocity, water surfaces and counts.
  void returnToStart() {
    step_.pose = step_.surface.pose;
    step_.start = step_.surface.start;
    computeLinkPoses(tree_, step_.start);
    forgetLoads(tree_);
    count_.error = count_.halted ? 1 : 0;
    count_.energy_removed = 0;
    count_.coarse = false;
    forEachAtSurface(tree_, [](AmbientLink& link, int) {
      *link.ambient.floating = link.start;
      link.frozen.freeze(link.ambient);
    });
  }

  AmbientTree& tree_;
  TreeStep& step_;
  const double duration_;  // of the step [s]
  Warnings& warnings_;
  const LinkFlightSettings settings_;
  FlightCount count_;
  bool is_finite_ = true;
};

}  // namespace

bool flyTree(AmbientTree& tree, double duration, Warnings& warnings) noexcept {
  return TreeFlight(tree, duration, warnings).fly();
}

AMBIENT_END
