#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <unordered_map>

#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/ambient_trees.h"
#include "bullet_ambient/bullet/complaints.h"
#include "bullet_ambient/bullet/fluid_regions.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/force/load_tables.h"

namespace ambient {

class TaskRunner;

inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientRegistry;

/// The number that Bullet gives to each btRigidBody when it is constructed. It tells a body from a
/// later one at the same address. @pre the body is alive.
int instanceNumber(const btRigidBody& body) noexcept;

/// What a registry holds, for solver, action and saved states.
class AmbientBodies {
 public:
  std::size_t size() const { return bodies_.size(); }
  /// In the order of attachment. They may have been destroyed.
  const std::list<std::unique_ptr<AmbientBody>>& all() const { return bodies_; }
  /// The body that was attached, never another one at its address; null if there is none.
  /// @pre the body is alive, or nothing was attached at its address.
  AmbientBody* find(const btCollisionObject* body) const;
  /// Whether what is at the address of an attached body is still that one. @pre it is an object.
  static bool isSame(const AmbientBody& ambient);
  /// @throws std::invalid_argument if it is not attached.
  AmbientBody& require(const btRigidBody& body) const;

  /// Takes over a body with a model, in place of what is attached at its address.
  void insert(std::unique_ptr<AmbientBody> ambient);
  /// By its address alone. False if nothing was attached there.
  bool erase(const btRigidBody& body);
  void clear();
  /// Calls visit(AmbientBody&) for bodies and links; they may have been destroyed.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const auto& ambient : bodies_) visit(*ambient);
    for (const auto& tree : trees.all())
      for (const auto& link : tree->links) visit(link->ambient);
  }

  /// @throws std::logic_error that names the function, and says so once, if a region is being asked
  /// for its fluid on this thread.
  void requireChangeable(const char* function);

  /// The solver meets the body, on any thread.
  void meet(AmbientBody& ambient) noexcept;
  /// Those that were met since the last call, linked by next_met; null: none.
  AmbientBody* takeMet() noexcept { return met_.exchange(nullptr); }

  AmbientTrees trees;
  Complaints complaints;
  FluidRegions regions;
  LoadTables load_tables;  ///< what the loads of bodies share
  TaskRunner* task_runner = nullptr;
  std::atomic<unsigned> solved{0};  ///< groups, by any solver of these bodies

 private:
  using List = std::list<std::unique_ptr<AmbientBody>>;
  void forgetMeeting(const AmbientBody& ambient) noexcept;

  List bodies_;
  std::unordered_map<const btCollisionObject*, List::iterator> by_object_;
  std::atomic<AmbientBody*> met_{nullptr};
};

AmbientBodies& bodiesOf(const AmbientRegistry& registry);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
