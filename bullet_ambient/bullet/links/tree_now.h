#pragma once

#include <list>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"
#include "bullet_ambient/motion/links/link_dynamics.h"

AMBIENT_BEGIN

/// Copy of a btMultiBody, with the fluid around its links, as it stands and moves now.
class TreeNow {
 public:
  TreeNow(const AmbientTrees& trees, const btMultiBody& body);

  /// Makes the tree's equations of motion at its pose. The TreeNow must outlive them.
  LinkDynamics dynamics() const;
  /// Adds the surface loads to the forces on the links.
  void applyLoads();

  Coordinates velocity;

 private:
  void immerse(AmbientLink& ambient, const btMultiBody& body, const Vector3& gravity);

  LinkTree tree_;
  std::list<BodyModel> models_;  // the tree points at them
  TreePose pose_;
};

AMBIENT_END
