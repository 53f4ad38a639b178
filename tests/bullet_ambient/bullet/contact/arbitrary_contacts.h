#pragma once

#include <string>

#include "tests/bullet_ambient/bullet/contact/contact_pair.h"

namespace ambient::test {

// Contacts of an ambient body of coupled inertia, K_fluid from 1e-3 to 1e4 times K_body, with a
// fixed, an ordinary or an ambient body.

enum class Other { kPlane, kOrdinary, kAmbient };
constexpr Other kOthers[] = {Other::kPlane, Other::kOrdinary, Other::kAmbient};

double arbitraryRatio(Arbitrary& arbitrary);

/// Two bodies that approach each other.
ContactPair arbitraryPair(Arbitrary& arbitrary, Other other);

/// Largest duration for which gyroscopic terms of both bodies change their velocities by `part`.
double gyroscopicTime(const ContactPair& pair, double part);

/// Applies forces and torques that change the velocities by about 5 % during dt. No torques on
/// bodies without fluid: Bullet's stock friction rows ignore them.
void pushAtRandom(Arbitrary& arbitrary, const ContactPair& pair, double dt);

/// Velocities of a pair before a step.
struct Before {
  explicit Before(const ContactPair& pair) : a(pair.a().velocity()), b(pair.b().velocity()) {}
  DenseVector6 a, b;
};

/// Larger of both bodies' CoupledBody::error.
double worstError(const ContactPair& pair, const reference::DenseSolution& expected,
                  const Before& before);

using Rows = std::vector<reference::DenseRow>;

/// plainSettings() with iterations until changes are below rounding.
btContactSolverInfo convergingSettings(double dt);

/// Least independence() compared. Below it rows are nearly dependent: iterations converge slowly,
/// and rounding decides the split between impulses.
constexpr Real kIndependent = 0.05L;

/// Tells if a row pushes. Bodies without any impulse fly freely, which the dense solution does not
/// contain.
bool touch(const reference::DenseSolution& solution);

/// Records a measured error in the log of the test run.
void report(const std::string& name, double error);

}  // namespace ambient::test
