#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

class btCollisionObject;

AMBIENT_BEGIN

struct AmbientBody;

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
