#pragma once

// Mass matrix and inverse dynamics of a btMultiBody in a fluid.

#include <Eigen/Core>

#include "bullet_ambient/bullet/core/precision_check.h"

class btMultiBody;

AMBIENT_BEGIN

class Fluid;

// Dynamics of a btMultiBody and the fluid around its links, for its present pose and velocity
// between two steps; for controllers and planners. Generalized velocities u are those of
// btMultiBody::getVelocityVector(): angular and linear velocity of the base in world axes, then the
// joint rates. If no link is in a fluid, results are those of the dry btMultiBody.

/// Computes the mass matrix H, symmetric; rows and columns of a fixed base are those of the
/// identity.
Eigen::MatrixXd ambientMassMatrix(const Fluid& fluid, const btMultiBody& multi_body);

/// Computes the joint forces, and the wrench at the base, that give the acceleration du/dt together
/// with weight, buoyancy and surface loads.
/// @throws std::invalid_argument if `acceleration` has not one entry for each coordinate.
Eigen::VectorXd ambientInverseDynamics(const Fluid& fluid, const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration);

/// Computes the kinetic energy of the links, and of the fluid relative to the ambient flow [J].
double kineticEnergy(const Fluid& fluid, const btMultiBody& multi_body);

AMBIENT_END
