#pragma once

#include <array>

#include "bullet_ambient/motion/links/joint.h"
#include "bullet_ambient/motion/links/link_inertia.h"

namespace ambient {

/// State of one link in LinkDynamics; in the link's frame where nothing else is said.
struct LinkState {
  int parent = -1;
  int first = 0;  ///< entry of its joint in the coordinates
  int axes = 0;   ///< of its joint
  std::array<Twist, kMaxJointAxes> axis;

  // Set by the pose.
  bool is_kept = false;  ///< keeps its velocity, and so do all its ancestors
  FrameOffset offset;    ///< in its parent; of the base in W
  Matrix3 rotation_W;    ///< link to W
  Vector3 position_W;    ///< of its centre of mass [m]
  LinkInertia inertia;   ///< K
  Vector3 flow;          ///< ambient [m/s]

  // Set by the velocity.
  Twist twist;         ///< V
  Twist acceleration;  ///< A without the part that is looked for, or that part
  Wrench force;        ///< f of the link; later of its whole subtree

  // Set by the factorisation of H.
  LinkInertia articulated;                 ///< of the subtree
  std::array<Wrench, kMaxJointAxes> push;  ///< articulated inertia times axes
  Matrix3 inverse;                         ///< of axes times push
  Vector3 weight;                          ///< diagonal of axes times push
  Vector3 rest;                            ///< joint forces less those that the subtree takes
};

}  // namespace ambient
