#pragma once

#include <list>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/motion/links/link_dynamics.h"

AMBIENT_BEGIN

/// Copy of the present pose and velocity of a btMultiBody, and of the fluid around its links.
class TreeNow {
 public:
  TreeNow(const AmbientTrees& trees, const btMultiBody& body);

  /// Returns the equations of motion of the tree at its pose. The TreeNow must outlive them.
  LinkDynamics dynamics() const;
  /// Adds the surface loads at the present velocity to the applied forces of the links.
  void applyLoads();

  Coordinates velocity;

 private:
  void immerse(AmbientLink& ambient, const btMultiBody& body, const Vector3& gravity);

  LinkTree tree_;
  std::list<BodyModel> models_;  // tree_ holds pointers to them
  TreePose pose_;
};

AMBIENT_END
