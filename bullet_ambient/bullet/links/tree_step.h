#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <functional>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"

AMBIENT_BEGIN

/// Calls visit(AmbientTree&) for each tree whose multibody is in the world of the trees.
/// Multibodies outside it may have been destroyed.
template <class Visit>
void forEachTree(const AmbientTrees& trees, const Visit& visit) {
  for (int i = 0; trees.world() && i < trees.world()->getNumMultibodies(); ++i)
    if (AmbientTree* tree = trees.find(trees.world()->getMultiBody(i))) visit(*tree);
}

/// Calls it only if that is this world.
template <class Visit>
void forEachTreeIn(const btCollisionWorld& world, const AmbientTrees& trees, const Visit& visit) {
  if (trees.world() == &world) forEachTree(trees, visit);
}

/// Updates links, fluids and forces of a tree at the start of a substep. Places the links if
/// regions, a smooth link or a tree without joints need it. Returns false if no link is in a fluid.
/// Allocates nothing.
bool prepareLinks(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept;

/// True if the velocity `now` is not `step.end`, up to Bullet's rounding: others have changed it
/// since the last substep.
bool wasMovedByOthers(const AmbientTree& tree, const CoordinatesIn& now) noexcept;

/// Makes the links forget the loads at the end of the last flight, which the motion has left.
void forgetLoads(AmbientTree& tree) noexcept;

/// Sets the motion of each link, AmbientLink::now, to that at `step.pose` and for the generalized
/// velocity `u`. Leaves the dynamics there, with the models that they had.
void computeLinkPoses(AmbientTree& tree, const CoordinatesIn& u) noexcept;

/// Sets the motion of each link to the present one. Call between two steps.
void computeLinkPosesNow(AmbientTree& tree) noexcept;

/// Adds the counts of a flight to the counters of the links: substeps to all, load evaluations in
/// equal parts to those with loads, all others to the first link.
void addCount(const FlightCount& count, AmbientTree& tree) noexcept;

/// Adds energy that a bound has removed from the motion of a tree [J] to the counter of its first
/// link.
void countEnergyRemoved(double energy, AmbientTree& tree) noexcept;

/// Wakes a tree that drifts or moves afloat, whose fluid changes with time, or that floats in an
/// unstable balance; like keepAwake() of bodies.
void keepTreeAwake(AmbientTree& tree) noexcept;

/// Replaces the turns of a tree that Bullet has moved for the time h [s] by those with our sine and
/// cosine: of its base, its spherical and planar joints, what Bullet keeps of its joints, and its
/// colliders. Leaves a base or joint alone that others have moved. Allocates nothing.
/// @pre Bullet has moved it from `step.pose`, the base from `step.to_base`, by the velocity
/// `step.moved`
void settleTree(AmbientTree& tree, double h) noexcept;

/// True if a water surface is near a link.
bool isAtSurface(const AmbientTree& tree) noexcept;

/// Calls visit(AmbientLink&, index in the tree) for links near a water surface.
template <class Visit>
void forEachAtSurface(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links)
    if (tree.tree.links[link->link + 1].model && link->ambient.surface())
      visit(*link, link->link + 1);
}

// A water surface acts on links as on bodies that rows move: waves and wind at the start of a step,
// change of added mass at its end. Each link alone would change its twist V_l = J_l u to y_l. The
// tree takes the motion that is nearest to these twists in the norm of the K_l:
//
//   u' = H^-1 sum over links J_l^T K_l y_l                        docs/theory.md eq. (81a)
//
//   K_l  total inertia of a link;  H = sum over links J_l^T K_l J_l
//
// It has no more energy than the links would have alone, the sum of y_l.K_l y_l / 2.

/// Call before a step. Changes `step.start` by the water that has come into holds of links. @pre
/// prepareLinks()
void addInflow(AmbientTree& tree) noexcept;

/// Call before a step, or before each part of a step that is flown in parts. Changes `step.start`
/// by the waves that links make and by the wind. @pre prepareLinks()
void kickAtSurface(AmbientTree& tree, double duration, Warnings& warnings) noexcept;

/// Call before rows that turn with the tree are prepared. Stiffens the inertia of links whose
/// floating period is too short for the step, docs/theory.md eq. (68). @pre kickAtSurface()
void stiffenForRows(AmbientTree& tree) noexcept;

/// Call before a flight. Gives the links the buoyancy of where `step.start` brings them to in half
/// the time, and stiffens them by their waterplanes if their floating period is too short for the
/// step; docs/theory.md section 14. @pre kickAtSurface()
void floatInMiddle(AmbientTree& tree) noexcept;

/// Changes `step.end` by the change of added mass on the way from the pose of kickAtSurface() to
/// `step.pose`, and removes energy above the work of weight and buoyancy, docs/theory.md eq. (66),
/// (68a). Returns the energy removed [J].
double arriveAtSurface(AmbientTree& tree) noexcept;

// Energy of a tree at a water surface, docs/theory.md eq. (64): kinetic energy relative to the
// flow, potential energy of weight and water, and energy of the waves that its links have made.

/// Call before a step. Stores the energy of the tree with the velocity `step.surface.start`. If
/// wind, applied torques or joint forces act, stores that there is no bound. @pre the dynamics are
/// at the pose, with inertias that are not stiffened
void keepEnergy(AmbientTree& tree) noexcept;

/// Returns false if a flight with mean velocity `step.moved` and end velocity `step.end` cannot
/// have reached a pose with more potential energy than the stored energy: the kinetic energy at the
/// end exceeds the largest error of the work of buoyancy, docs/theory.md eq. (81b). `duration` [s].
/// Cost: O(links).
bool mayGainEnergy(AmbientTree& tree, double duration) noexcept;

/// True if the potential energy at the pose of the dynamics exceeds the stored energy, a time
/// `since_start` [s] after the start of the step.
bool hasGainedEnergy(const AmbientTree& tree, double since_start) noexcept;

/// Call before rows that turn with the tree are solved. Shortens the way `step.moved` to where the
/// stored energy reaches, docs/theory.md eq. (68c). @pre keepEnergy(); the dynamics are at the pose
void keepWithinReach(AmbientTree& tree) noexcept;

/// Call after Bullet has moved the tree. Calls arriveAtSurface() at the present pose. If no rows
/// have moved the tree, scales the motion relative to the flow so that the energy does not exceed
/// the one that keepEnergy() stored.
void applyAddedMassChange(AmbientTree& tree, double duration) noexcept;

/// Flies a tree over a substep, from `step.pose` with velocity `step.start`. Writes the mean
/// velocity to `step.moved`, the end velocity to `step.end`, and the outcome. At a water surface, a
/// step that ends with more potential energy than it had energy is flown again in 2, 4, ... parts,
/// and ends early if that does not help; docs/theory.md section 14, eq. (81b). Returns false if a
/// result is not finite.
/// @pre no row turns with the tree; `step.start` contains the kicks by the surface
bool flyTree(AmbientTree& tree, double duration, Warnings& warnings) noexcept;

/// True if a tree flies as a free rigid body: it has one link, its base is not fixed, it was awake,
/// and no row turns with it. @pre prepareLinks()
bool fliesAsBody(const AmbientTree& tree) noexcept;

/// Flies up to kFlightsTogether trees for which fliesAsBody() is true, side by side. Calls
/// beginFlights() for their links, so that they have the bits of rigid bodies. Writes what
/// flyTree() does. A flight that is not finite, or turns faster than Bullet can move a multibody,
/// leaves its tree and the outcome unchanged. `of`: the fluid of each tree. @pre prepareLinks()
void flyAsBodies(AmbientTree* const* trees, AmbientBodies* const* of, int count,
                 double duration) noexcept;

// Motion of a tree in a substep, docs/theory.md section 14, "Rows".
//
// A tree without rows, or with rows of its own joints alone, flies first. The rows are solved
// against the velocity u_1 at the end of the flight, with H in the middle of the flight. Bullet
// moves the tree by
//
//   u_m + d/2, and the velocity becomes u_1 + d
//
//   u_m   mean velocity of the flight
//   d     velocity change by the rows
//
// The velocity of the base is then corrected, so that the tree keeps the momentum of the flight.
//
// For a tree with contacts or joints to other bodies, rows are solved against x + X at the start
// pose, as for bodies, eq. (28). Bullet moves the tree by
//
//   xi = x + X + d, and the velocity becomes x + d + t(q_m, xi)
//
//   x     start velocity changed by forces and loads
//   t     turning part of eq. (28): velocity change by gyroscopic terms;  X  included share of it
//   q_m   pose in the middle of the step
//
// The energy stays within the bound of eq. (31a). Energy that this bound has left unused in earlier
// steps (`reserve`) may be used later.

/// Call before Bullet makes rows. Sets the velocity of a tree to the one that rows are solved
/// against. Returns false, and sets none, for a tree that flies as a body: call flySingleLinks()
/// for it. @pre `step.start` is the velocity before the substep
bool prepareTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept;

/// Flies up to kFlightsTogether trees for which prepareTree() was false, side by side, and sets
/// their velocities to those at the end of the flights. `of`: the fluid of each tree.
void flySingleLinks(AmbientTree* const* trees, AmbientBodies* const* of, int count,
                    double duration) noexcept;

/// Call after the rows are solved. Sets the velocity that Bullet moves the tree by.
void finishTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept;

/// Call after Bullet has moved the tree. Adds the difference between the velocity at the end of the
/// substep and the one that Bullet has moved it by, so that impulses which others have applied
/// meanwhile survive.
void completeTree(AmbientTree& tree, AmbientBodies& bodies, double duration) noexcept;

/// Bodies and trees of several worlds that nothing touches, which fly side by side, and the steps
/// of these worlds, each within the one before:
///
///   rows of world 0, rows of world 1, ..., flights of all, Bullet moves world n - 1, ..., world 0
///
/// All on one thread. Allocates nothing.
class FlightQueue {
 public:
  /// `step(i)` makes a step of world i, whose solver calls goOn(); null: there are no worlds.
  explicit FlightQueue(int worlds = 0, const std::function<void(int)>* step = nullptr)
      : worlds_(worlds), step_(step) {}

  /// Adds one that flies in this substep of `time_step` [s], and its fluid; flies all that wait if
  /// they fill the lanes or if their time step is another one. A tree: prepareTree() was false.
  void add(AmbientBody& body, AmbientBodies& of, double time_step) noexcept {
    add(bodies_, FreeBody{&body}, of, time_step);
  }
  void add(AmbientTree& tree, AmbientBodies& of, double time_step) noexcept {
    add(trees_, &tree, of, time_step);
  }
  /// Flies all that wait.
  void fly() noexcept;

  /// Call when the rows of a world are solved: makes the steps of the worlds that have not begun,
  /// and flies all that wait.
  void goOn() noexcept {
    while (begun_ < worlds_) (*step_)(begun_++);
    fly();
  }

 private:
  template <class Flyer>  // FreeBody or AmbientTree*
  struct Waiting {
    Flyer flyers[kFlightsTogether] = {};
    AmbientBodies* of[kFlightsTogether] = {};
    int count = 0;
  };
  template <class Flyer>
  void add(Waiting<Flyer>& waiting, const Flyer& flyer, AmbientBodies& of,
           double time_step) noexcept {
    if (time_step != time_step_) fly();
    time_step_ = time_step;
    waiting.flyers[waiting.count] = flyer;
    waiting.of[waiting.count++] = &of;
    if (waiting.count == kFlightsTogether) fly();
  }

  Waiting<FreeBody> bodies_;
  Waiting<AmbientTree*> trees_;
  double time_step_ = 0;
  int worlds_, begun_ = 0;
  const std::function<void(int)>* step_;
};

// Functions for links whose wrenches are read. Cost without such links: one test per link.

/// Begins a substep, after the links were prepared and AmbientTree::step has pose and velocity.
void beginTreeReading(AmbientTree& tree) noexcept;

/// Computes the wrenches after the action has set the velocity of the tree; duration [s]. Changes
/// AmbientTree::step.pose.
void finishTreeReading(AmbientTree& tree, double duration) noexcept;

/// Replaces the joint forces in each btMultiBodyJointFeedback of the links, which Bullet has
/// computed without fluid, by those in fluid: inverse dynamics of the mean acceleration of the
/// substep, at the pose in its middle. Forces of rows count as applied forces, as in Bullet.
/// Velocity-dependent terms count once; Bullet counts them twice. `info`: of the solver, which says
/// in which frame. @pre `step` has the velocities of this substep
void writeJointForces(AmbientTree& tree, double duration, const btContactSolverInfo& info) noexcept;

AMBIENT_END
