#pragma once

#include <Eigen/Core>

#include "bullet_ambient/bullet/precision_check.h"

class btMultiBody;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientRegistry;

// Of a btMultiBody and the fluid around its links, as it stands and moves between two steps, for
// controllers and planners. Generalized velocities are those of btMultiBody::getVelocityVector():
// spin and velocity of the base in world axes, then the rates of the joints. Without attached
// links, those of the dry btMultiBody.

/// H: symmetric; rows and columns of a fixed base are those of the identity.
Eigen::MatrixXd ambientMassMatrix(const AmbientRegistry& registry, const btMultiBody& multi_body);

/// Forces of the joints, and wrench at the base, that give it the acceleration du/dt, besides
/// weight, buoyancy and surface loads.
/// @throws std::invalid_argument if `acceleration` has not one entry for each coordinate.
Eigen::VectorXd ambientInverseDynamics(const AmbientRegistry& registry,
                                       const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration);

/// Of links, and of fluid relative to its flow [J].
double kineticEnergy(const AmbientRegistry& registry, const btMultiBody& multi_body);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
