#pragma once

#include <string>

#include "tests/bullet_ambient/bullet/contact/contact_pair.h"

namespace ambient::test {

// Contacts of an ambient body with coupled inertia, K_fluid from 1e-3 to 1e4 times K_body, with
// everything that it may meet.

enum class Other { kPlane, kOrdinary, kAmbient };
constexpr Other kOthers[] = {Other::kPlane, Other::kOrdinary, Other::kAmbient};

double arbitraryRatio(Arbitrary& arbitrary);

/// Two bodies that approach each other.
ContactPair arbitraryPair(Arbitrary& arbitrary, Other other);

/// Largest duration over which the gyroscopic terms of both change their velocities by `part`.
double gyroscopicTime(const ContactPair& pair, double part);

/// Forces and torques that change the velocities by about 5 % during dt. No torques on bodies
/// without fluid: stock friction rows do not see them.
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

/// plainSettings() with which iterative solvers work until nothing changes by more than rounding.
btContactSolverInfo convergingSettings(double dt);

/// Rows of less independence() say nearly the same: they converge slowly, and rounding decides
/// between their impulses.
constexpr Real kIndependent = 0.05L;

/// Whether a row pushes. Bodies that no row pushes fly freely, which is not the dense solution's
/// business.
bool touch(const reference::DenseSolution& solution);

/// Writes a measured error into the log of the test run, as evidence.
void report(const std::string& name, double error);

}  // namespace ambient::test
