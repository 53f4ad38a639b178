#include "bullet_ambient/bullet/links/cone_friction.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include <algorithm>
#include <cmath>

AMBIENT_BEGIN
namespace {

using Row = btMultiBodySolverConstraint;

// One side of a row: a multibody, a rigid body, or nothing.
struct Side {
  btMultiBody* multibody;
  int jacobian, change;  // where those of the multibody begin
  btSolverBody* body;
  const btVector3 &angular, &linear, &angular_component;
};

// One friction row, its impulse, and the one that it asks for without a limit.
class FrictionRow {
 public:
  FrictionRow(const Row& row, const FrictionPair& pair)
      : row_(row),
        data_(pair.data),
        sides_{{row.m_multiBodyA, row.m_jacAindex, row.m_deltaVelAindex,
                bodyOf(row.m_multiBodyA, row.m_solverBodyIdA, pair), row.m_relpos1CrossNormal,
                row.m_contactNormal1, row.m_angularComponentA},
               {row.m_multiBodyB, row.m_jacBindex, row.m_deltaVelBindex,
                bodyOf(row.m_multiBodyB, row.m_solverBodyIdB, pair), row.m_relpos2CrossNormal,
                row.m_contactNormal2, row.m_angularComponentB}} {
    wanted = row.m_appliedImpulse + row.m_rhs - row.m_appliedImpulse * row.m_cfm -
             (changeAlong(sides_[0]) + changeAlong(sides_[1])) * row.m_jacDiagABInv;
  }

  btScalar wanted;

  // Applies the impulse, at most `limit` either way. Returns the velocity along the row that it
  // changes.
  btScalar apply(btScalar limit) {
    const btScalar impulse = std::clamp(wanted, -limit, limit);
    const btScalar change = impulse - row_.m_appliedImpulse;
    row_.m_appliedImpulse = impulse;
    for (const Side& side : sides_) apply(side, change);
    return change / row_.m_jacDiagABInv;
  }

 private:
  static btSolverBody* bodyOf(const btMultiBody* multibody, int id, const FrictionPair& pair) {
    return multibody || id < 0 ? nullptr : &pair.solver_bodies[id];
  }

  btScalar changeAlong(const Side& side) const {
    btScalar sum = 0;
    if (side.multibody) {
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        sum += data_.m_jacobians[side.jacobian + i] * data_.m_deltaVelocities[side.change + i];
    } else if (side.body) {
      sum = side.linear.dot(side.body->internalGetDeltaLinearVelocity()) +
            side.angular.dot(side.body->internalGetDeltaAngularVelocity());
    }
    return sum;
  }

  void apply(const Side& side, btScalar impulse) {
    if (side.multibody) {
      const btScalar* response = &data_.m_deltaVelocitiesUnitImpulse[side.jacobian];
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        data_.m_deltaVelocities[side.change + i] += response[i] * impulse;
      side.multibody->applyDeltaVeeMultiDof2(response, impulse);
    } else if (side.body) {
      side.body->internalApplyImpulse(side.linear * side.body->internalGetInvMass(),
                                      side.angular_component, impulse);
    }
  }

  const Row& row_;
  btMultiBodyJacobianData& data_;
  const Side sides_[2];
};

}  // namespace

btScalar solveFrictionPair(const FrictionPair& pair) noexcept {
  FrictionRow a(pair.first, pair), b(pair.second, pair);
  btScalar most_a = SIMD_INFINITY, most_b = SIMD_INFINITY;
  const btScalar limit_a = std::abs(pair.first.m_upperLimit);
  const btScalar limit_b = std::abs(pair.second.m_upperLimit);
  const bool is_within = a.wanted * a.wanted + b.wanted * b.wanted < limit_a * limit_b;
  const btScalar largest = std::max(std::abs(a.wanted), std::abs(b.wanted));
  if (!is_within && largest > 0) {
    // Scaled: the squares of tiny numbers vanish.
    const btScalar x = std::abs(a.wanted) / largest, y = std::abs(b.wanted) / largest;
    const btScalar length = std::sqrt(x * x + y * y);
    most_a = limit_a * x / length;
    most_b = limit_b * y / length;
  }
  return a.apply(most_a) + b.apply(most_b);
}

AMBIENT_END
