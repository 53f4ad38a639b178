#include "bullet_ambient/bullet/members/object_index.h"

#include <utility>

#include "bullet_ambient/base/ambient_assert.h"

AMBIENT_BEGIN

void ObjectIndex::insert(const Entry& entry) {
  AMBIENT_ASSERT(entry.object && !find(entry.object));
  if (2 * (count_ + 1) > entries_.size()) grow();
  entries_[placeOf(entry.object)] = entry;
  ++count_;
}

void ObjectIndex::erase(const btCollisionObject* object) noexcept {
  if (!find(object)) return;
  std::size_t free = placeOf(object);
  entries_[free] = {};
  --count_;
  // Moves up the entries behind it that a search would not find any more.
  for (std::size_t place = next(free); entries_[place].object; place = next(place)) {
    const std::size_t wanted = placeOf(entries_[place].object);
    if (wanted == place) continue;
    entries_[wanted] = std::exchange(entries_[place], {});
  }
}

void ObjectIndex::clear() noexcept {
  for (Entry& entry : entries_) entry = {};
  count_ = 0;
}

void ObjectIndex::grow() {
  constexpr std::size_t kLeast = 16;
  const std::size_t size = entries_.empty() ? kLeast : 2 * entries_.size();
  std::vector<Entry> old(size);
  old.swap(entries_);
  shift_ = 64;
  for (std::size_t i = size; i > 1; i /= 2) --shift_;
  for (const Entry& entry : old)
    if (entry.object) entries_[placeOf(entry.object)] = entry;
}

AMBIENT_END
