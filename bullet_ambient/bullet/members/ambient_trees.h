#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/motion/links/link_flight.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

/// One link in a fluid. A body in no world stands in for it, so that regions, surfaces of water,
/// drawing and saved states know links as they know bodies.
struct AmbientLink {
  explicit AmbientLink(int number);
  AmbientLink(const AmbientLink&) = delete;
  AmbientLink& operator=(const AmbientLink&) = delete;

  const int link;        ///< Bullet's number; -1: the base
  btRigidBody stand_in;  ///< with the link's mass, pose and velocity, and the world's gravity
  AmbientBody ambient;
  SurfaceEncounter met;  ///< encounter at the start of a step that is flown again
};

/// Outcome of a substep for a tree, from the solver; docs/bullet_step.md has the transitions.
enum class TreeOutcome {
  kNotMet,  ///< asleep, or the solver has not met it since the action took the last outcome
  kStock,   ///< moves as in stock Bullet: no fluid, or not of a physical mass
  kRows,    ///< moved by rows that turn with it: contacts, joints to other bodies
  kFlown,   ///< has flown, and at most rows of its own joints have moved it
};

/// Step, or part of one, of a tree at a water surface.
struct SurfaceStep {
  TreePose pose;          ///< q_0
  Coordinates start;      ///< u_0 before the kicks of the surface
  double time = 0;        ///< since these kicks [s]
  bool is_bound = false;  ///< the step must not end with more energy: no wind, torque, motor
  double energy = 0;      ///< before the step, docs/theory.md eq. (64), relative to the flow [J]
  double rounding = 0;    ///< of differences of energies, by that of Bullet's poses [J]
  Vector3 origin_W{0, 0, 0};  ///< from where ways are counted [m]
};

/// Effect of a substep on one tree: written by the solver, taken once by the action.
struct TreeStep {
  TreeStep(Eigen::Index coordinates, std::size_t links);

  TreeOutcome outcome = TreeOutcome::kNotMet;
  bool was_awake = false;      ///< before Bullet's pass
  bool turns_rows = false;     ///< it has rows that turn with it
  bool meets_surface = false;  ///< its links have taken the kicks of a water surface
  SurfaceStep surface;
  TreePose pose;       ///< q_0
  Coordinates start;   ///< u_0, after the kicks of a water surface
  Coordinates moved;   ///< that Bullet moves it by
  Coordinates end;     ///< that it has afterwards; with rows, what it would have without a turn
  Coordinates share;   ///< of the turning part in what the rows were solved against
  Coordinates change;  ///< by the rows
  Coordinates spare;   ///< memory of functions
  std::vector<Wrench> impulses;  ///< of a surface on each link, in the link's frame [N m s, N s]
  double extent = 0;             ///< of the turn, docs/theory.md eq. (28a)
  double energy = 0;             ///< with rows, eq. (31a)
  double reserve = 0;            ///< what turns in steps with rows have lost of it
};

/// A btMultiBody of which at least one link is in a fluid.
struct AmbientTree {
  explicit AmbientTree(btMultiBody& attached);
  AmbientTree(const AmbientTree&) = delete;
  AmbientTree& operator=(const AmbientTree&) = delete;

  btMultiBody* const multi_body;  ///< may have been destroyed: look it up in the world first
  const int instance;             ///< instanceNumber() of the one that was attached
  std::vector<std::unique_ptr<AmbientLink>> links;
  LinkTree tree;  ///< its links and joints when it was attached; all else as it was last met
  LinkFlight flight;
  TreeStep step;

  /// Whether what is at the address of the btMultiBody is still that one, with the same links and
  /// joints. One that uses RK4 integration is known by its links alone. @pre it is alive
  bool isSame() const noexcept;
  /// Null if the link is not in a fluid.
  AmbientLink* find(int link) const noexcept;
};

/// Whether the velocity of a tree is that of the solver, in its fluid, and not Bullet's.
inline bool hasMet(const AmbientTree& tree) noexcept {
  return tree.step.outcome == TreeOutcome::kRows || tree.step.outcome == TreeOutcome::kFlown;
}

/// The trees of a fluid, and the world whose they are.
class AmbientTrees {
 public:
  explicit AmbientTrees(MemberSlots& slots) : slots_(slots) {}

  bool empty() const noexcept { return trees_.empty(); }
  const std::vector<std::unique_ptr<AmbientTree>>& all() const noexcept { return trees_; }
  /// The tree that was attached, never another one at its address; null if there is none.
  /// @pre the multibody is alive, or nothing was attached at its address
  AmbientTree* find(const btMultiBody* multi_body) const noexcept;
  /// Returns the tree that was attached at an address; null: none.
  AmbientTree* at(const btMultiBody* address) const noexcept;
  /// Null if the link is not in a fluid.
  AmbientLink* find(const btMultiBody* multi_body, int link) const noexcept;

  /// Takes over a link. @pre it is not attached.
  void insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
              std::unique_ptr<AmbientLink> link);
  /// Takes over links in place of all of a multibody that are in a fluid. Names and readings of
  /// links that are in one before and after stay.
  void replace(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
               std::vector<std::unique_ptr<AmbientLink>> links);
  /// By the address alone. False if nothing was attached there.
  bool erase(const btMultiBody& multi_body, int link);
  bool erase(const btMultiBody& multi_body);
  void clear();

  /// Null without trees.
  btMultiBodyDynamicsWorld* world() const noexcept { return world_; }

 private:
  MemberSlots& slots_;
  std::vector<std::unique_ptr<AmbientTree>> trees_;
  std::unordered_map<const btMultiBody*, AmbientTree*> by_body_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

AMBIENT_END
