#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

class TaskRunner;
}  // namespace ambient

AMBIENT_BEGIN

/// The number that Bullet gives to each btRigidBody when it is constructed. It tells a body from a
/// later one at the same address. @pre the body is alive.
int instanceNumber(const btRigidBody& body) noexcept;

/// All that is in one Fluid: bodies, links, regions. Solvers of the fluid keep it alive; handles of
/// its members do not.
class AmbientBodies : public std::enable_shared_from_this<AmbientBodies> {
 public:
  std::size_t size() const { return bodies_.size(); }
  /// In the order of attachment. They may have been destroyed.
  const std::list<std::unique_ptr<AmbientBody>>& all() const { return bodies_; }
  /// The body that was attached, never another one at its address; null if there is none.
  /// @pre the body is alive, or nothing was attached at its address.
  AmbientBody* find(const btCollisionObject* body) const;
  /// Whether what is at the address of an attached body is still that one. @pre it is an object.
  static bool isSame(const AmbientBody& ambient);
  /// Takes over a body with a model, in place of what is attached at its address. If that is the
  /// same body, its name and its reading stay.
  void insert(std::unique_ptr<AmbientBody> ambient);
  /// By its address alone. False if nothing was attached there.
  bool erase(const btRigidBody& body);
  void clear();
  /// The end of their Fluid: clears, and forgets regions, report and task runner.
  void close();
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
  /// Takes the bodies that were met since the last call, linked by next_met; null: none.
  AmbientBody* takeMet() noexcept { return met_.exchange(nullptr); }

  MemberSlots slots;
  AmbientTrees trees{slots};
  Complaints complaints;
  FluidRegions regions;
  LoadTables load_tables;  ///< what the loads of bodies share
  TaskRunner* task_runner = nullptr;
  std::function<std::string(const btCollisionObject&)> naming;  ///< Fluid::setNaming()
  std::atomic<unsigned> solved{0};  ///< groups, by any solver of these bodies
  bool is_closed = false;           ///< Fluid or world were destroyed

 private:
  using List = std::list<std::unique_ptr<AmbientBody>>;
  void forgetMeeting(const AmbientBody& ambient) noexcept;

  List bodies_;
  std::unordered_map<const btCollisionObject*, List::iterator> by_object_;
  std::atomic<AmbientBody*> met_{nullptr};
};

AMBIENT_END
