#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/bullet/members/body_index.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

class TaskRunner;
}  // namespace ambient

AMBIENT_BEGIN

/// Number that Bullet gives to each btRigidBody on construction. Distinguishes a body from a later
/// one at the same address. @pre the body is alive
int instanceNumber(const btRigidBody& body) noexcept;

/// All members of one Fluid: bodies, links, regions, and what they share. Solvers of the fluid keep
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
  /// Called when the Fluid ends: removes members, regions, report function and task runner.
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

  /// Notes that the solver has met the body in this substep. May be called from any thread.
  void meet(AmbientBody& ambient) noexcept;
  /// Takes the list of bodies that the solver has met since the last call, linked by
  /// AmbientBody::next_met; null: none.
  AmbientBody* takeMet() noexcept { return met_.exchange(nullptr); }

  MemberSlots slots;
  AmbientTrees trees{slots};
  Complaints complaints;
  FluidRegions regions;
  ModelTables load_tables;  ///< data that several bodies share
  TaskRunner* task_runner = nullptr;
  std::function<std::string(const btCollisionObject&)> naming;  ///< Fluid::setNaming()
  std::atomic<unsigned> solved{0};  ///< number of groups solved so far by all solvers of this fluid
  bool is_closed = false;           ///< Fluid or world were destroyed

 private:
  void forgetMeeting(const AmbientBody& ambient) noexcept;

  std::list<AmbientBody> bodies_;
  BodyIndex by_object_;
  std::atomic<AmbientBody*> met_{nullptr};
};

AMBIENT_END
