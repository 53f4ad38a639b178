#pragma once

#include <LinearMath/btAlignedObjectArray.h>
#include <LinearMath/btQuaternion.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/fluid_regions.h"
#include "bullet_ambient/immersed/warnings.h"
#include "bullet_ambient/motion/links/link_flight.h"

class btCollisionObject;
class btMultiBodyDynamicsWorld;

AMBIENT_BEGIN

class FlightQueue;

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
  Vector6 hydrostatics = Vector6::Zero();  ///< weight and buoyancy of a flight, in the link's frame
};

/// One step of a tree at a water surface, or a part of it.
struct SurfaceStep {
  TreePose pose;      ///< q_0
  TreePose middle;    ///< where the start velocity brings the tree to in half the time
  Coordinates start;  ///< u_0 before the kicks of the surface
  double time = 0;    ///< time since these kicks [s]
  bool has_flown =
      false;  ///< true: AmbientLink::hydrostatics has acted; false: buoyancy of the start
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

  Outcome outcome = Outcome::kNotSolved;  ///< none of kNoFlight, kDisabled
  bool was_awake = false;                 ///< before Bullet's pass
  bool turns_rows = false;  ///< true: rows whose directions turn with the tree act on it (contacts,
                            ///< joints to other bodies)
  bool meets_surface = false;  ///< true: the links have taken the kicks of a water surface
  SurfaceStep surface;
  TreePose pose;                     ///< q_0
  btQuaternion to_base{0, 0, 0, 1};  ///< Bullet's number for the base's orientation there
  Coordinates start;                 ///< u_0, after the kicks of a water surface
  Coordinates moved;                 ///< velocity that Bullet moves the tree by
  Coordinates end;      ///< velocity after the step; with rows, that without the turning part
  Coordinates turning;  ///< part of the turning velocity change included in the velocity that rows
                        ///< were solved for
  Coordinates change;   ///< velocity change by the rows
  Coordinates spare;  ///< scratch memory; so are turning and change once Bullet has moved the tree
  std::vector<Wrench>
      impulses;  ///< impulse of the water surface on each link, in the link's frame [N m s, N s]
  double turn_number = 0;  ///< turn number m of the turn, docs/theory.md eq. (28a)
  double energy = 0;       ///< kinetic energy with rows, eq. (31a) [J]
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
  return tree.step.outcome == Outcome::kRows || tree.step.outcome == Outcome::kFlown;
}

/// All trees of one fluid, and their world.
class AmbientTrees {
 public:
  bool empty() const noexcept { return trees_.empty(); }
  const std::vector<std::unique_ptr<AmbientTree>>& all() const noexcept { return trees_; }
  /// Finds the tree that was added, never another one at the same address; null: none.
  /// @pre the multibody is alive, or nothing was attached at its address
  AmbientTree* find(const btMultiBody* multi_body) const noexcept;
  /// Finds the tree of a multibody if the fluid's solver moves it in this substep, isSolved().
  AmbientTree* findSolved(const btMultiBody* multi_body) const noexcept {
    AmbientTree* const tree = find(multi_body);
    return tree && isSolved(*tree) ? tree : nullptr;
  }
  /// Returns the entry for an address, whatever is there now; null: none.
  AmbientTree* at(const btMultiBody* address) const noexcept;
  /// Null if the link is not in a fluid.
  AmbientLink* find(const btMultiBody* multi_body, int link) const noexcept;
  /// Returns the tree of a link, and the link. @pre it is one of these trees
  AmbientTree& treeOf(const AmbientBody& link) const noexcept { return *at(link.multi_body); }
  AmbientLink& linkOf(const AmbientBody& link) const noexcept;

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
  std::vector<std::unique_ptr<AmbientTree>> trees_;
  std::unordered_map<const btMultiBody*, AmbientTree*> by_body_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
};

/// Finds ambient bodies in their list by the addresses of their Bullet bodies: a hash table in one
/// array, of which a search reads one line of the cache in most cases.
class BodyIndex {
 public:
  using Iterator = std::list<AmbientBody>::iterator;

  /// None: there is no entry for this address.
  std::optional<Iterator> find(const btCollisionObject* object) const noexcept {
    if (entries_.empty()) return std::nullopt;
    const Entry& entry = entries_[slotOf(object)];
    if (!entry.object) return std::nullopt;
    return entry.iterator;
  }
  /// Makes room for one more entry: the next insert() does not throw.
  void reserveOne();
  /// @pre there is no entry for this address
  void insert(const btCollisionObject* object, Iterator iterator);
  /// @pre there is an entry for this address
  void erase(const btCollisionObject* object) noexcept;
  void clear() noexcept;

 private:
  struct Entry {
    const btCollisionObject* object = nullptr;  // null: no entry
    Iterator iterator;
  };

  // Returns the place where the search for an address begins, by its product with 2^64 / golden
  // ratio, whose digits from the 32nd on spread near addresses evenly.
  std::size_t homeOf(const btCollisionObject* object) const noexcept {
    const std::uint64_t address = reinterpret_cast<std::uintptr_t>(object);
    return static_cast<std::size_t>((address * 0x9E3779B97F4A7C15u) >> 32) & (entries_.size() - 1);
  }
  std::size_t next(std::size_t at) const noexcept { return (at + 1) & (entries_.size() - 1); }
  // Returns the place of an address, or the free place at which its search ends.
  std::size_t slotOf(const btCollisionObject* object) const noexcept {
    std::size_t at = homeOf(object);
    while (entries_[at].object && entries_[at].object != object) at = next(at);
    return at;
  }
  void grow();

  std::vector<Entry> entries_;  // 2^n, or none; of these at most two thirds are taken
  std::size_t count_ = 0;
};

/// Number that Bullet gives to each btRigidBody on construction. Distinguishes a body from a later
/// one at the same address. @pre the body is alive
int instanceNumber(const btRigidBody& body) noexcept;

/// A body or link that moves in a world, where it is now.
struct MovingBody {
  Vector3 centre;      ///< of mass [m]
  std::size_t number;  ///< in the order of the world
  AmbientBody* body;
  const AmbientLink* link;  ///< null: a rigid body
};

/// All that is in one Fluid: bodies, links, regions, and what they share. Solvers of the fluid keep
/// this object alive; handles (Immersed) do not.
class AmbientBodies : public std::enable_shared_from_this<AmbientBodies> {
 public:
  std::size_t size() const { return bodies_.size(); }
  /// Finds the body that was added, never another one at the same address; null: none.
  /// @pre the body is alive, or nothing was attached at its address.
  AmbientBody* find(const btCollisionObject* body) const;
  /// True if the object at the address of an added body is still that body. @pre there is a
  /// collision object at that address
  static bool isSame(const AmbientBody& ambient);
  /// Adds a body with its model, in place of an entry for the same address, and returns where it is
  /// kept. If that entry is for the same body, its name and its reading are kept.
  AmbientBody& insert(AmbientBody ambient);
  /// Removes the entry for an address, whatever is there now. Returns false if there is no entry.
  bool erase(const btRigidBody& body);
  void clear();
  /// Called when the Fluid ends: removes bodies, regions, report function and task runner.
  void close();
  /// Calls visit(AmbientBody&) for all bodies in the order of addition, and links; the Bullet
  /// objects may have been destroyed.
  template <class Visit>
  void forEach(const Visit& visit) {
    for (AmbientBody& ambient : bodies_) visit(ambient);
    for (const auto& tree : trees.all())
      for (const auto& link : tree->links) visit(link->ambient);
  }

  /// Refuses changes while a function of a region runs on this thread. @throws std::logic_error
  /// that names `function`; reports it once, too.
  void requireChangeable(const char* function);

  /// Notes that the solver has worked on the body in this substep. May be called from any thread.
  void noteSolved(AmbientBody& ambient) noexcept;
  /// Takes the list of bodies that the solver has worked on since the last call, linked by
  /// AmbientBody::next_solved; null: none.
  AmbientBody* takeSolved() noexcept { return solved_list_.exchange(nullptr); }

  AmbientTrees trees;
  Warnings warnings;
  FluidRegions regions;
  ModelTables load_tables;              ///< data that several bodies share
  TaskRunner task_runner;               ///< null: flights run on the thread of the solver
  FlightQueue* flight_queue = nullptr;  ///< of worlds that step together; null: it steps alone
  std::function<std::string(const btCollisionObject&)> naming;  ///< Fluid::setNaming()
  std::atomic<unsigned> solved{0};  ///< number of groups solved so far by all solvers of this fluid
  bool has_vessels = false;         ///< true: a body with holds was added
  std::vector<MovingBody> west_to_east;  ///< scratch memory of findBodiesInHolds()
  bool is_closed = false;                ///< the Fluid was destroyed

 private:
  void forgetSolved(const AmbientBody& ambient) noexcept;

  std::list<AmbientBody> bodies_;
  BodyIndex by_object_;
  std::atomic<AmbientBody*> solved_list_{nullptr};
};

AMBIENT_END
