#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"

AMBIENT_BEGIN

// A water surface acts on links as on bodies that rows move: waves and wind at the start of a step,
// change of added mass at its end. Each link alone would change its twist V_l = J_l u to y_l. The
// tree takes the motion that is nearest to these twists in the norm of the K_l:
//
//   u' = H^-1 sum over links J_l^T K_l y_l                        docs/theory.md eq. (81a)
//
//   K_l  total inertia of a link;  H = sum over links J_l^T K_l J_l
//
// It has no more energy than the links would have alone, the sum of y_l.K_l y_l / 2.

/// Call before a step, or before each part of a step that is flown in parts. Changes `step.start`
/// by the waves that links make and by the wind. @pre prepareLinks()
void kickAtSurface(AmbientTree& tree, const TreeTask& task) noexcept;

/// Call before rows that turn with the tree are prepared. Stiffens the inertia of links whose
/// floating period is too short for the step, docs/theory.md eq. (68). @pre kickAtSurface()
void stiffenForRows(AmbientTree& tree) noexcept;

/// Call before a flight. Gives the links the buoyancy of where `step.start` brings them to in half
/// the time, and stiffens them by their waterplanes if their floating period is too short for the
/// step; docs/theory.md section 14. @pre kickAtSurface()
void floatInMiddle(AmbientTree& tree) noexcept;

/// Changes `step.end` by the change of added mass on the way from the pose of kickAtSurface() to
/// `step.pose`, and removes energy above the work of weight and buoyancy, docs/theory.md eq. (66),
/// (68a). Returns the energy removed [J].
double arriveAtSurface(AmbientTree& tree) noexcept;

/// Call after Bullet has moved the tree. Calls arriveAtSurface() at the present pose, and
/// boundEnergy() if no rows have moved the tree.
void passSurface(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
