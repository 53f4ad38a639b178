#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

struct AmbientBody;
struct AmbientTree;

/// Names a body or a link that was put into a fluid. No two are ever equal in one fluid.
struct MemberId {
  int slot = -1;
  unsigned generation = 0;
};

/// A body in its fluid, or a link in its fluid and its tree.
struct Member {
  AmbientBody* ambient = nullptr;  ///< null: there is none
  AmbientTree* tree = nullptr;     ///< null: a rigid body
};

/// Finds members by their names, in constant time. A slot that is free again is given to the next
/// member with the next generation, so that the names of earlier ones find nothing.
class MemberSlots {
 public:
  /// Gives the member a slot, and notes the slot in AmbientBody::slot.
  void enter(const Member& member);
  /// Puts a member into the slot of another one, whose name finds it from now on.
  void replace(AmbientBody& old, const Member& member) noexcept;
  /// Frees the slot of a member; without harm if it has none.
  void leave(AmbientBody& ambient) noexcept;

  MemberId nameOf(const AmbientBody& ambient) const noexcept;
  /// Empty if the member has left.
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
