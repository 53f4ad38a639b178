#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/tree_state.h"
#include "bullet_ambient/motion/link_flight.h"

class btMultiBody;
class btMultiBodyDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// One link in a fluid. A body in no world stands in for it, so that regions, surfaces of water,
/// drawing and saved states know links as they know bodies.
struct AmbientLink {
  explicit AmbientLink(int number);
  AmbientLink(const AmbientLink&) = delete;
  AmbientLink& operator=(const AmbientLink&) = delete;

  const int link;        ///< Bullet's number; -1: the base
  btRigidBody stand_in;  ///< with the link's mass, pose and velocity, and the world's gravity
  AmbientBody ambient;
};

/// How the solver leaves a tree in a substep; docs/bullet_step.md has the transitions.
enum class TreeOutcome {
  kNotMet,  ///< asleep, or the solver has not met it since the action took the last outcome
  kStock,   ///< moves as in stock Bullet: no fluid, or not of a physical mass
  kRows,    ///< moved by rows that turn with it: contacts, joints to other bodies
  kFlown,   ///< has flown, and at most rows of its own joints have moved it
};

/// What a substep does to one tree: written by the solver, taken once by the action.
struct TreeStep {
  explicit TreeStep(Eigen::Index coordinates);

  TreeOutcome outcome = TreeOutcome::kNotMet;
  bool was_awake = false;   ///< before Bullet's pass
  bool turns_rows = false;  ///< it has rows that turn with it
  TreePose pose;            ///< q_0
  Coordinates start;        ///< u_0
  Coordinates moved;        ///< that Bullet moves it by
  Coordinates end;     ///< that it has afterwards; with rows, what it would have without a turn
  Coordinates share;   ///< of the turning part in what the rows were solved against
  Coordinates change;  ///< by the rows
  Coordinates spare;   ///< memory of functions
  double extent = 0;   ///< of the turn, docs/theory.md eq. (28a)
  double energy = 0;   ///< with rows, eq. (31a)
  double reserve = 0;  ///< what turns in steps with rows have lost of it
};

/// A btMultiBody of which at least one link is in a fluid.
struct AmbientTree {
  explicit AmbientTree(btMultiBody& attached);
  AmbientTree(const AmbientTree&) = delete;
  AmbientTree& operator=(const AmbientTree&) = delete;

  btMultiBody* const multi_body;  ///< may have been destroyed: look it up in the world first
  std::vector<std::unique_ptr<AmbientLink>> links;
  LinkTree tree;  ///< its links and joints when it was attached; all else as it was last met
  LinkFlight flight;
  TreeStep step;

  /// Null if the link is not in a fluid.
  AmbientLink* find(int link) const noexcept;
};

/// Whether the velocity of a tree is that of the solver, in its fluid, and not Bullet's.
inline bool hasMet(const AmbientTree& tree) noexcept {
  return tree.step.outcome == TreeOutcome::kRows || tree.step.outcome == TreeOutcome::kFlown;
}

/// The trees of a registry, and the world whose they are.
class AmbientTrees {
 public:
  bool empty() const noexcept { return trees_.empty(); }
  const std::vector<std::unique_ptr<AmbientTree>>& all() const noexcept { return trees_; }
  AmbientTree* find(const btMultiBody* multi_body) const noexcept;
  /// @throws std::invalid_argument if this link is not attached.
  AmbientLink& require(const btMultiBody& multi_body, int link) const;

  /// Takes over a link. @pre it is not attached.
  void insert(btMultiBodyDynamicsWorld& world, btMultiBody& multi_body,
              std::unique_ptr<AmbientLink> link);
  /// By the address alone. False if nothing was attached there.
  bool erase(const btMultiBody& multi_body, int link);
  bool erase(const btMultiBody& multi_body);
  void clear();

  /// Null without trees. The fluid of a world that was destroyed must be cleared.
  btMultiBodyDynamicsWorld* world() const noexcept { return world_; }

 private:
  std::vector<std::unique_ptr<AmbientTree>> trees_;
  std::unordered_map<const btMultiBody*, AmbientTree*> by_body_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
