#pragma once

#include <list>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/immersed/ambient_body.h"
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

/// Returns the velocity change of a body per unit impulse at its centre of mass, 6x6 in world axes:
/// K^-1, or with locked axes K_eff^-1 of docs/theory.md eq. (30). Takes the present mass, pose and
/// waterline.
/// @throws std::invalid_argument as makeBodyModel().
Matrix6 inverseInertia(AmbientBody& ambient);

/// Adds the velocity change by an impulse at the centre of mass [N m s, N s], world axes, to the
/// velocity of a body. A body without fluid responds with its dry mass. @throws as
/// inverseInertia().
void applyImpulseToBody(AmbientBody& ambient, const Wrench& impulse);

/// Adds the change H^-1 J^T impulse to the velocities of a tree. `impulse` acts at the centre of
/// mass of `link` (Bullet's number) [N m s, N s], world axes. @throws as inverseInertia().
void applyImpulseToLink(const AmbientTrees& trees, const AmbientTree& tree, int link,
                        const Wrench& impulse);

AMBIENT_END
