#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <vector>

#include "bullet_ambient/bullet/ambient_registry.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/reference/dense_rows.h"

namespace ambient::test {

using reference::DenseVector6;
using reference::Real;

/// A step so short [s] that forces and turns do nothing, but more than Bullet's zero. In double the
/// error is proportional to it: contacts are 2.5e-12 off at 1e-13, 2.5e-14 at 1e-15.
constexpr double kMoment = byPrecision(1e-15, 2e-7);
/// Of twistError().
constexpr double kRowTolerance = byPrecision(1e-12, 1e-5);

/// A robot in maximal coordinates: the base is body 0, link l body l + 1, and the last one is the
/// ground. Joints are rows at their pivots and about their axes. Nothing of it is recursive.
struct DenseRobot {
  std::vector<reference::DenseBody> bodies;
  std::vector<reference::DenseRow> rows;

  int ground() const { return static_cast<int>(bodies.size()) - 1; }
};

/// As it stands and moves now; links in fluid with the inertia that the registry tells.
/// @pre its colliders and cached transforms are those of now
DenseRobot denseRobot(const btMultiBody& body, const AmbientRegistry& registry);

/// World axes, of the centre of mass.
std::vector<DenseVector6> twistsOf(const btMultiBody& body);

/// Velocity along a direction of a point of a link, against the ground.
reference::DenseRow groundRow(const btMultiBody& body, int link, const btVector3& point,
                              const btVector3& direction);

/// Rate of a revolute or prismatic joint.
reference::DenseRow rateRow(const btMultiBody& body, int link);

/// Spin of a link against its parent about one of the link's own axes, 0 to 2.
reference::DenseRow turnRow(const btMultiBody& body, int link, int axis);

/// Keeps the twist of the base, as one that is driven.
void driveBase(const btMultiBody& body, DenseRobot& robot);

/// Of all links, relative to the fastest before or after; angular parts in 0.15 m.
double twistError(const btMultiBody& now, const std::vector<DenseVector6>& expected,
                  const std::vector<DenseVector6>& before);

}  // namespace ambient::test
