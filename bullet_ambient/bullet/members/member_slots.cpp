#include "bullet_ambient/bullet/members/member_slots.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

void MemberSlots::enter(const Member& member) {
  AMBIENT_ASSERT(member.ambient->slot < 0);
  if (free_.empty()) {
    slots_.emplace_back();
    free_.reserve(slots_.capacity());  // leave() allocates nothing
    free_.push_back(static_cast<int>(slots_.size()) - 1);
  }
  const int slot = free_.back();
  free_.pop_back();
  slots_[static_cast<std::size_t>(slot)].member = member;
  member.ambient->slot = slot;
}

void MemberSlots::replace(AmbientBody& old, const Member& member) noexcept {
  AMBIENT_ASSERT(old.slot >= 0 && member.ambient->slot < 0);
  slots_[static_cast<std::size_t>(old.slot)].member = member;
  member.ambient->slot = old.slot;
  old.slot = -1;
}

void MemberSlots::leave(AmbientBody& ambient) noexcept {
  if (ambient.slot < 0) return;
  Slot& slot = slots_[static_cast<std::size_t>(ambient.slot)];
  slot.member = {};
  ++slot.generation;
  free_.push_back(ambient.slot);
  ambient.slot = -1;
}

MemberId MemberSlots::nameOf(const AmbientBody& ambient) const noexcept {
  AMBIENT_ASSERT(ambient.slot >= 0);
  return {ambient.slot, slots_[static_cast<std::size_t>(ambient.slot)].generation};
}

Member MemberSlots::find(const MemberId& id) const noexcept {
  if (id.slot < 0 || static_cast<std::size_t>(id.slot) >= slots_.size()) return {};
  const Slot& slot = slots_[static_cast<std::size_t>(id.slot)];
  return slot.generation == id.generation ? slot.member : Member{};
}

AMBIENT_END
