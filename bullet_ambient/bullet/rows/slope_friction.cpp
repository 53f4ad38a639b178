#include "bullet_ambient/bullet/rows/slope_friction.h"

#include "bullet_ambient/bullet/core/conversions.h"

AMBIENT_BEGIN

namespace {

// Largest motion across a push relative to the motion, that needs no second row: it lets a body
// creep down a slope by a millimetre in ten seconds.
constexpr double kEvenPush = 1e-3;

}  // namespace

bool isHeldAslant(const btVector3& push_W, const btVector3& normal_W, btScalar friction) noexcept {
  constexpr btScalar kFlat = btScalar(0.01);
  const btScalar pressed = -push_W.dot(normal_W);
  const btScalar along = (push_W + pressed * normal_W).length();
  return along > kFlat * pressed && along <= friction * pressed;
}

bool mayTurnAside(const AmbientBody& ambient) noexcept {
  if (ambient.surface()) return true;
  const BodyModel& model = ambient.model();
  const Vector3 response = model.inverse_inertia.diagonal().tail<3>();
  return !model.has_diagonal_inertia ||
         response.maxCoeff() - response.minCoeff() > kEvenPush * response.minCoeff();
}

bool turnsAside(const AmbientBody& ambient, const btVector3& normal_W) noexcept {
  const BodyModel& model = ambient.model();
  if (ambient.surface() || !model.has_diagonal_inertia) return true;
  const btMatrix3x3& rotation = ambient.body->getWorldTransform().getBasis();
  const Vector3 normal = toVector3(normal_W * rotation);  // in B
  const Vector3 push = model.inverse_inertia.diagonal().tail<3>().cwiseProduct(normal);
  return push.cross(normal).squaredNorm() > kEvenPush * kEvenPush * push.squaredNorm();
}

AMBIENT_END
