// Flights of trees without joints, as rigid bodies.
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/links/tree_flight.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/motion/flight/flight_task.h"

AMBIENT_BEGIN
namespace {

AmbientLink& baseOf(const AmbientTree& tree) { return *tree.links.front(); }

// Applies the forces on the base to the stand-in, without those of the flow along it, which the
// flight adds.
void applyForces(AmbientTree& tree) {
  btRigidBody& stand_in = baseOf(tree).stand_in;
  Wrench applied = tree.flight.dynamics().appliedWrench(0);
  applied -= pushByFlow(baseOf(tree).ambient);
  stand_in.clearForces();
  stand_in.applyCentralForce(toBullet(applied.force));
  stand_in.applyTorque(toBullet(applied.torque));
}

// Copies the end of the stand-in's flight to the step of the tree. Returns false if the flight has
// failed or Bullet cannot move the tree to its end.
bool takeFlight(AmbientTree& tree, const TreeTask& task) {
  TreeStep& step = tree.step;
  AmbientBody& ambient = baseOf(tree).ambient;
  if (std::exchange(ambient.outcome.kind, Outcome::kNotMet) != Outcome::kFlown) return false;
  const LastFlight& end = std::as_const(ambient.outcome).flight();
  step.moved << end.effective_W.angular, end.effective_W.linear;
  if (turnsTooFastForBullet(tree.tree, step.moved, task.duration)) return false;
  step.end << end.left_W.angular, end.left_W.linear;
  if (ambient.outcome.is_too_long) task.bodies.complaints.sayTooLong(*ambient.def);
  return true;
}

}  // namespace

bool fliesAsBody(const AmbientTree& tree) noexcept {
  return tree.tree.size() == 1 && !tree.tree.links.front().keeps_velocity &&
         tree.tree.has_gyroscopic_term && tree.step.was_awake && !tree.step.turns_rows;
}

void flyAsBodies(AmbientTree* const* trees, int count, const TreeTask& task,
                 bool* have_flown) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  AmbientBody* bodies[kFlightsTogether] = {};
  LastFlight before[kFlightsTogether];
  Twist changes_W[kFlightsTogether];
  for (int i = 0; i < count; ++i) {
    AmbientLink& base = baseOf(*trees[i]);
    applyForces(*trees[i]);
    bodies[i] = &base.ambient;
    before[i] = base.ambient.outcome.flight();
    if (base.ambient.surface()) base.start = surfaceStart(base.ambient);
  }
  beginFlights(bodies, count, task.duration, changes_W);
  for (int i = 0; i < count; ++i) {
    have_flown[i] = takeFlight(*trees[i], task);
    if (have_flown[i]) continue;
    bodies[i]->outcome.motion = before[i];  // in the place where the tree knows its memory
    if (!bodies[i]->surface()) continue;
    restart(*bodies[i], baseOf(*trees[i]).start);
    standNow(*bodies[i]);  // the tree goes on from where it is
  }
}

AMBIENT_END
