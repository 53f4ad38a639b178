#pragma once

#include <Eigen/Core>

#include "bullet_ambient/bullet/core/precision_check.h"

class btMultiBody;

AMBIENT_BEGIN

class Fluid;

// Dynamics of a btMultiBody and the fluid around its links, as it moves between two steps, for
// controllers and planners. Generalized velocities are those of btMultiBody::getVelocityVector():
// spin and velocity of the base in world axes, then the rates of the joints. Without attached
// links, those of the dry btMultiBody.

/// H: symmetric; rows and columns of a fixed base are those of the identity.
Eigen::MatrixXd ambientMassMatrix(const Fluid& fluid, const btMultiBody& multi_body);

/// Forces of the joints, and wrench at the base, that give it the acceleration du/dt, besides
/// weight, buoyancy and surface loads.
/// @throws std::invalid_argument if `acceleration` has not one entry for each coordinate.
Eigen::VectorXd ambientInverseDynamics(const Fluid& fluid, const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration);

/// Kinetic energy of links, and of fluid relative to its flow [J].
double kineticEnergy(const Fluid& fluid, const btMultiBody& multi_body);

AMBIENT_END
