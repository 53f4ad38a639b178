#include "bullet_ambient/bullet/members/body_index.h"

#include <utility>

#include "bullet_ambient/base/ambient_assert.h"

AMBIENT_BEGIN

void BodyIndex::reserveOne() {
  if (3 * (count_ + 1) > 2 * entries_.size()) grow();
}

void BodyIndex::insert(const btCollisionObject* object, Place place) {
  reserveOne();
  Entry& entry = entries_[placeOf(object)];
  AMBIENT_ASSERT(!entry.object);
  entry = {object, place};
  ++count_;
}

void BodyIndex::erase(const btCollisionObject* object) noexcept {
  std::size_t gap = placeOf(object);
  AMBIENT_ASSERT(entries_[gap].object == object);
  // Moves later entries into the gap, so that no search ends there too early.
  const std::size_t mask = entries_.size() - 1;
  for (std::size_t at = next(gap); entries_[at].object; at = next(at)) {
    const std::size_t way = (at - homeOf(entries_[at].object)) & mask;
    if (way < ((at - gap) & mask)) continue;
    entries_[gap] = entries_[at];
    gap = at;
  }
  entries_[gap] = {};
  --count_;
}

void BodyIndex::clear() noexcept {
  entries_.clear();
  count_ = 0;
}

void BodyIndex::grow() {
  std::vector<Entry> known(entries_.empty() ? 8 : 2 * entries_.size());
  known.swap(entries_);
  for (const Entry& entry : known)
    if (entry.object) entries_[placeOf(entry.object)] = entry;
}

AMBIENT_END
