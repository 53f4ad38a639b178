#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

/// Finds bodies by the address of their btCollisionObject: a flat table with open addresses, one
/// line of the cache for a search. The solver asks it for every body in every step.
class ObjectIndex {
 public:
  using List = std::list<std::unique_ptr<AmbientBody>>;

  struct Entry {
    const btCollisionObject* object = nullptr;  ///< null: the entry is free
    AmbientBody* ambient = nullptr;
    List::iterator place;  ///< where the list of all bodies has it
  };

  /// Returns null if there is no entry. The next change of the index invalidates the result.
  const Entry* find(const btCollisionObject* object) const noexcept {
    if (count_ == 0) return nullptr;
    const Entry& entry = entries_[placeOf(object)];
    return entry.object ? &entry : nullptr;
  }
  /// @pre the object has no entry
  void insert(const Entry& entry);
  /// Does nothing if there is no entry.
  void erase(const btCollisionObject* object) noexcept;
  void clear() noexcept;

 private:
  std::size_t firstPlaceOf(const btCollisionObject* object) const noexcept {
    // Addresses are multiples of 16 at least: Fibonacci hashing takes the upper bits of a product.
    const auto address = static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(object));
    return static_cast<std::size_t>((address >> 4) * 0x9e3779b97f4a7c15U >> shift_);
  }
  std::size_t next(std::size_t place) const noexcept { return (place + 1) & (entries_.size() - 1); }
  // Returns the place of the object, or the free one where it would be.
  std::size_t placeOf(const btCollisionObject* object) const noexcept {
    std::size_t place = firstPlaceOf(object);
    while (entries_[place].object && entries_[place].object != object) place = next(place);
    return place;
  }
  void grow();

  std::vector<Entry> entries_;  // a power of two, at most half of them in use
  std::size_t count_ = 0;
  int shift_ = 64;  // 64 minus the binary logarithm of the number of entries
};

AMBIENT_END
