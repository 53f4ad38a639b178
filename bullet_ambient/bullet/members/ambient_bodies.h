#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/bullet/members/member_slots.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/fluid_regions.h"

class btCollisionObject;

AMBIENT_BEGIN

/// Finds ambient bodies in their list by the addresses of their Bullet bodies: a hash table in one
/// array, of which a search reads one line of the cache in most cases.
class BodyIndex {
 public:
  using Place = std::list<AmbientBody>::iterator;

  /// None: there is no entry for this address.
  std::optional<Place> find(const btCollisionObject* object) const noexcept {
    if (entries_.empty()) return std::nullopt;
    const Entry& entry = entries_[placeOf(object)];
    if (!entry.object) return std::nullopt;
    return entry.place;
  }
  /// Makes room for one more entry: the next insert() does not throw.
  void reserveOne();
  /// @pre there is no entry for this address
  void insert(const btCollisionObject* object, Place place);
  /// @pre there is an entry for this address
  void erase(const btCollisionObject* object) noexcept;
  void clear() noexcept;

 private:
  struct Entry {
    const btCollisionObject* object = nullptr;  // null: no entry
    Place place;
  };

  // Returns the place where the search for an address begins, by its product with 2^64 / golden
  // ratio, whose digits from the 32nd on spread near addresses evenly.
  std::size_t homeOf(const btCollisionObject* object) const noexcept {
    const std::uint64_t address = reinterpret_cast<std::uintptr_t>(object);
    return static_cast<std::size_t>((address * 0x9E3779B97F4A7C15u) >> 32) & (entries_.size() - 1);
  }
  std::size_t next(std::size_t at) const noexcept { return (at + 1) & (entries_.size() - 1); }
  // Returns the place of an address, or the free place at which its search ends.
  std::size_t placeOf(const btCollisionObject* object) const noexcept {
    std::size_t at = homeOf(object);
    while (entries_[at].object && entries_[at].object != object) at = next(at);
    return at;
  }
  void grow();

  std::vector<Entry> entries_;  // 2^n, or none; of these at most two thirds are taken
  std::size_t count_ = 0;
};

AMBIENT_END

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

  /// Notes that the solver has worked on the body in this substep. May be called from any thread.
  void noteSolved(AmbientBody& ambient) noexcept;
  /// Takes the list of bodies that the solver has worked on since the last call, linked by
  /// AmbientBody::next_solved; null: none.
  AmbientBody* takeSolved() noexcept { return solved_list_.exchange(nullptr); }

  MemberSlots slots;
  AmbientTrees trees{slots};
  Complaints complaints;
  FluidRegions regions;
  ModelTables load_tables;  ///< data that several bodies share
  TaskRunner* task_runner = nullptr;
  std::function<std::string(const btCollisionObject&)> naming;  ///< Fluid::setNaming()
  std::atomic<unsigned> solved{0};  ///< number of groups solved so far by all solvers of this fluid
  bool has_vessels = false;         ///< true: a body with holds was added
  bool is_closed = false;           ///< Fluid or world were destroyed

 private:
  void forgetSolved(const AmbientBody& ambient) noexcept;

  std::list<AmbientBody> bodies_;
  BodyIndex by_object_;
  std::atomic<AmbientBody*> solved_list_{nullptr};
};

AMBIENT_END
