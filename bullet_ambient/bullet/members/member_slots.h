#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

namespace ambient {

struct AmbientBody;

}  // namespace ambient

AMBIENT_BEGIN

struct AmbientTree;

/// Identifier of a body or link in one fluid; never used twice.
struct MemberId {
  int slot = -1;
  unsigned generation = 0;
};

/// Entry of a body, or of a link and its tree.
struct Member {
  AmbientBody* ambient = nullptr;  ///< null: there is no such member
  AmbientTree* tree = nullptr;     ///< tree of the link; null: the member is a rigid body
};

/// Finds members by their MemberId, in constant time. A slot is used again with the next
/// generation, so that identifiers of removed members find nothing.
class MemberSlots {
 public:
  /// Gives a member a slot, and writes its number to AmbientBody::slot.
  void enter(const Member& member);
  /// Puts a member into the slot of another one, whose identifier finds the new member from now on.
  void replace(AmbientBody& old, const Member& member) noexcept;
  /// Frees the slot of a member; does nothing if it has none.
  void leave(AmbientBody& ambient) noexcept;

  MemberId nameOf(const AmbientBody& ambient) const noexcept;
  /// Returns the member; empty if it was removed.
  Member find(const MemberId& id) const noexcept;

 private:
  struct Slot {
    Member member;
    unsigned generation = 0;
  };
  std::vector<Slot> slots_;
  std::vector<int> free_;
};

AMBIENT_END
