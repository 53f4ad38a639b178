#pragma once

#include <LinearMath/btAlignedObjectArray.h>
#include <LinearMath/btQuaternion.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/motion/links/link_flight.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

/// One link of a multibody in a fluid. Regions, water surfaces, drawing and saved states treat it
/// like a body.
struct AmbientLink {
  explicit AmbientLink(int number) : link(number) {}
  AmbientLink(const AmbientLink&) = delete;
  AmbientLink& operator=(const AmbientLink&) = delete;

  const int link;    ///< Bullet's number; -1: the base
  MotionView now;    ///< pose and velocity of the link, rounded as Bullet rounds those of
                     ///< bodies; gravity of the world
  InverseMass mass;  ///< of the link at the start of the last substep
  AmbientBody ambient;
  StepModel frozen;     ///< at a water surface: the model in the present or last step
  FloatingState start;  ///< that of `ambient` at the start of the step, to repeat a flight from
                        ///< there
  Vector6 fall = Vector6::Zero();  ///< weight and buoyancy of a flight, in the link's frame
};

/// Outcome of a substep for a tree, from the solver; docs/bullet_step.md has the transitions.
enum class TreeOutcome {
  kNotSolved,  ///< asleep, or the solver has not worked on it since the action took the last
               ///< outcome
  kStock,      ///< moves as in stock Bullet: no fluid, or not of a physical mass
  kRows,       ///< moved by rows that turn with it: contacts, joints to other bodies
  kFlown,      ///< has flown; moved by no rows but those of its own joints
};

/// One step of a tree at a water surface, or a part of it.
struct SurfaceStep {
  TreePose pose;           ///< q_0
  TreePose middle;         ///< where the start velocity brings the tree to in half the time
  Coordinates start;       ///< u_0 before the kicks of the surface
  double time = 0;         ///< time since these kicks [s]
  bool has_flown = false;  ///< true: AmbientLink::fall has acted; false: buoyancy of the start
  bool is_bound = false;  ///< true: the energy must not grow in the step, because there is no wind,
                          ///< torque or motor
  double energy = 0;      ///< before the step, docs/theory.md eq. (64), relative to the flow [J]
  double rounding = 0;  ///< rounding error of energy differences due to that of Bullet's poses [J]
  Vector3 origin_W{0, 0, 0};  ///< origin of displacements [m]
};

/// Effect of a substep on one tree: written by the solver, used once by the action. u: generalized
/// velocity.
struct TreeStep {
  TreeStep(Eigen::Index coordinates, std::size_t links);

  TreeOutcome outcome = TreeOutcome::kNotSolved;
  bool was_awake = false;   ///< before Bullet's pass
  bool turns_rows = false;  ///< true: rows whose directions turn with the tree act on it (contacts,
                            ///< joints to other bodies)
  bool meets_surface = false;  ///< true: the links have taken the kicks of a water surface
  SurfaceStep surface;
  TreePose pose;                     ///< q_0
  btQuaternion to_base{0, 0, 0, 1};  ///< Bullet's number for the base's orientation there
  Coordinates start;                 ///< u_0, after the kicks of a water surface
  Coordinates moved;                 ///< velocity that Bullet moves the tree by
  Coordinates end;     ///< velocity after the step; with rows, that without the turning part
  Coordinates share;   ///< part of the turning velocity change included in the velocity that rows
                       ///< were solved for
  Coordinates change;  ///< velocity change by the rows
  Coordinates spare;   ///< scratch memory; so are share and change once Bullet has moved the tree
  std::vector<Wrench>
      impulses;  ///< impulse of the water surface on each link, in the link's frame [N m s, N s]
  double extent = 0;  ///< extent m of the turn, docs/theory.md eq. (28a)
  double energy = 0;  ///< kinetic energy with rows, eq. (31a) [J]
  double reserve =
      0;  ///< energy lost by earlier turning corrections, which later ones may use, eq. (31a) [J]
};

/// A btMultiBody of which at least one link is in a fluid.
struct AmbientTree {
  explicit AmbientTree(btMultiBody& attached);
  AmbientTree(const AmbientTree&) = delete;
  AmbientTree& operator=(const AmbientTree&) = delete;

  btMultiBody* const multi_body;  ///< may have been destroyed: look it up in the world first
  const int instance;             ///< instanceNumber() of the one that was attached
  std::vector<std::unique_ptr<AmbientLink>> links;
  LinkTree
      tree;  ///< links and joints at the time of addition; all other data from the last substep
  LinkFlight flight;
  TreeStep step;
  btAlignedObjectArray<btQuaternion> to_local;  ///< scratch memory of Bullet, one per link
  btAlignedObjectArray<btVector3> origins;      ///< another one

  /// True if the btMultiBody at the address is still the added one. Compares instance numbers; with
  /// RK4 integration, which overwrites them, links and joints. @pre a btMultiBody is alive at that
  /// address
  bool isSame() const noexcept;
  /// Null if the link is not in a fluid.
  AmbientLink* find(int link) const noexcept;
};

/// True if the fluid's solver has set the velocity of a tree in this substep; false: Bullet has.
inline bool isSolved(const AmbientTree& tree) noexcept {
  return tree.step.outcome == TreeOutcome::kRows || tree.step.outcome == TreeOutcome::kFlown;
}

/// All trees of one fluid, and their world.
class AmbientTrees {
 public:
  explicit AmbientTrees(MemberSlots& slots) : slots_(slots) {}

  bool empty() const noexcept { return trees_.empty(); }
  const std::vector<std::unique_ptr<AmbientTree>>& all() const noexcept { return trees_; }
  /// Finds the tree that was added, never another one at the same address; null: none.
  /// @pre the multibody is alive, or nothing was attached at its address
  AmbientTree* find(const btMultiBody* multi_body) const noexcept;
  /// Returns the entry for an address, whatever is there now; null: none.
  AmbientTree* at(const btMultiBody* address) const noexcept;
  /// Null if the link is not in a fluid.
  AmbientLink* find(const btMultiBody* multi_body, int link) const noexcept;

  /// Adds a link of a multibody. @pre it was not added before
  void insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
              std::unique_ptr<AmbientLink> link);
  /// Replaces all links of a multibody. A link that was in the fluid before keeps its name and its
  /// reading.
  void replace(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
               std::vector<std::unique_ptr<AmbientLink>> links);
  /// Removes one link, or all links, of the entry for an address. Returns false if there is no
  /// entry.
  bool erase(const btMultiBody& multi_body, int link);
  bool erase(const btMultiBody& multi_body);
  void clear();

  /// World of the trees; null: there are no trees.
  btMultiBodyDynamicsWorld* world() const noexcept { return world_; }

 private:
  MemberSlots& slots_;
  std::vector<std::unique_ptr<AmbientTree>> trees_;
  std::unordered_map<const btMultiBody*, AmbientTree*> by_body_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

AMBIENT_END
