#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/law/surface_load.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Symmetric 6x6 matrix in the memory of its upper triangle.
struct SymmetricMatrix : SymmetricOf<double> {
  SymmetricMatrix() = default;
  explicit SymmetricMatrix(const SymmetricOf<double>& m) : SymmetricOf<double>(m) {}
  /// Takes the upper triangle.
  explicit SymmetricMatrix(const Matrix6& m) {
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        entries[symmetricEntry(row, column)] = m(row, column);
  }

  Matrix6 full() const {
    Matrix6 m;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        m(row, column) = m(column, row) = entries[symmetricEntry(row, column)];
    return m;
  }

  /// The part that acts on velocities of translation.
  Matrix3 bottomRight() const {
    Matrix3 m;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        m(row, column) = m(column, row) = entries[symmetricEntry(row + 3, column + 3)];
    return m;
  }
};

/// Vector x and its image K x under the inertia: a twist and its momentum, or an acceleration and
/// its wrench; in B. Inner products a.K b of pairs need no multiplication by K.
/// `twist`: x; `momentum`: K x.
struct DualPair {
  Vector6 twist = Vector6::Zero();
  Vector6 momentum = Vector6::Zero();
};

/// Inner product a.K b.
inline double inner(const DualPair& a, const DualPair& b) { return a.twist.dot(b.momentum); }

/// Twist after a bound on its energy, and the energy removed by the bound.
struct BoundedTwist {
  Vector6 twist;
  double energy_removed = 0;  ///< [J]
};

/// Scales a twist x down to the allowed energy if it has more. Energies are given as x.K x [2 J].
inline BoundedTwist scaledWithin(const Vector6& x, double twice_energy,
                                 double twice_allowed) noexcept {
  if (!(twice_energy > twice_allowed)) return {x, 0};
  return {std::sqrt(twice_allowed / twice_energy) * x, (twice_energy - twice_allowed) / 2};
}

/// Pose and velocity of a rigid body. Body frame B: origin at the centre of mass, axes fixed to the
/// body.
struct RigidState {
  Quaternion orientation = Quaternion::Identity();  ///< B to W, unit
  Vector3 position = Vector3::Zero();               ///< B's origin in W [m]
  Twist twist;                                      ///< in B

  bool isFinite() const {
    return orientation.coeffs().allFinite() && position.allFinite() && twist.angular.allFinite() &&
           twist.linear.allFinite();
  }
};

/// Response to a wrench with isotropic added mass: D' of docs/theory.md eq. (28b), in B. It is the
/// response of the dry body with mass and moments of inertia scaled by one factor each.
struct IsotropicResponse {
  Matrix3 inverse_inertia{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< [1/(kg m^2)]
  double inverse_mass = 1;                                   ///< [1/kg]

  Vector6 operator*(const Vector6& momentum) const {
    return stack(inverse_inertia * momentum.head<3>(), inverse_mass * momentum.tail<3>());
  }
  /// D' times `momentum`, minus `change` = K^-1 `momentum`: k' - k; 0 if it is only rounding.
  Vector6 beyond(const Vector6& momentum, const Vector6& change) const;
};

/// Computes D'. Its blocks are the smallest that are no smaller than those of K^-1 in any
/// direction. `dry_inertia`: rotational inertia of the body without fluid [kg m^2].
IsotropicResponse makeIsotropicResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia);

/// Motion of the fluid along a body beside its mean velocity, docs/theory.md eq. (85) to (87). Held
/// in the axes of the body over one step.
struct FlowAlongBody {
  static constexpr int kMost = 3;
  int stations = 0;       ///< 0: the fluid moves as one; 1: it turns; 3: it differs along an axis
  Twist twists_B[kMost];  ///< of the fluid at the stations, less its mean velocity
  Vector3 places_B[kMost]{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};  ///< of the stations [m]
  double weights[kMost]{};                                   ///< sum 1
  /// Load on a body that moves with the mean velocity. It acts as an applied wrench; loads that
  /// loadAlong() returns are less by it.
  Wrench at_rest_B;
  Vector3 spin_up_B{0, 0, 0};  ///< angular acceleration of the fluid along the body [rad/s^2]
  Wrench push_B;               ///< by the added mass that is spun up, eq. (88)
  Vector3 lean_W{0, 0, 0};  ///< what gravity is inclined by at a tilted surface, eq. (84) [m/s^2]
  PoolSides sides_F;        ///< sides of its pool that cut the body
  Wrench side_push_W;       ///< pressure of the water across them, eq. (90); world axes
  Wrench growth_W;          ///< of added mass that comes into the pool, eq. (91); world axes
  Wrench layers_W;          ///< buoyancy by layers of other density, eq. (180); world axes

  Wrench wrenchAtSides() const { return side_push_W + growth_W; }
  bool isNone() const {
    return stations == 0 && lean_W.isZero(0) && spin_up_B.isZero(0) && sides_F.count == 0 &&
           layers_W.force.isZero(0) && layers_W.torque.isZero(0);
  }
};

/// Returns the mean of a law over the stations of a body, less FlowAlongBody::at_rest_B.
/// `loadFor(x)`: SurfaceLoad for a twist relative to the fluid; `relative_twist`: relative to the
/// mean velocity, in which the resistance (null: none) acts besides the result. Where the fluid
/// moves as one, returns loadFor(relative_twist).
template <class LoadFor>
SurfaceLoad loadAlong(const FlowAlongBody* flow, const Twist& relative_twist,
                      const Resistance* resistance, const LoadFor& loadFor) noexcept {
  if (!flow || flow->stations == 0) return loadFor(relative_twist);
  SurfaceLoad mean{};
  Twist against;  // mean of the fluid's motion, negative
  for (int i = 0; i < flow->stations; ++i) {
    const Twist& of_fluid = flow->twists_B[i];
    const SurfaceLoad load = loadFor(
        {relative_twist.angular - of_fluid.angular, relative_twist.linear - of_fluid.linear});
    mean.wrench += flow->weights[i] * load.wrench;
    mean.wrench.torque += flow->weights[i] * flow->places_B[i].cross(load.wrench.force);
    mean.guarded = mean.guarded || load.guarded;
    mean.growth.rotation += flow->weights[i] * load.growth.rotation;
    mean.growth.translation += flow->weights[i] * load.growth.translation;
    against.angular -= flow->weights[i] * of_fluid.angular;
    against.linear -= flow->weights[i] * of_fluid.linear;
  }
  if (resistance) mean.wrench += resistance->load(mean.growth, against);
  mean.wrench -= flow->at_rest_B;
  return mean;
}

class SurfaceLoads;

/// Mass [kg] and rotational inertia about the centre of mass in B's axes [kg m^2].
struct MassProperties {
  double mass = 0;
  Matrix3 inertia = Matrix3::Zero();
};

/// Parameters of the equations of motion for one body in one medium; constant until body or medium
/// change. Frame: body frame B at the centre of mass.
struct BodyModel {
  Matrix6 inertia;                       ///< K = K_body + rho K_fluid, docs/theory.md eq. (3); SPD
  Matrix6 inverse_inertia;               ///< K^-1
  bool has_diagonal_inertia = false;     ///< K and K^-1 are diagonal: three planes of symmetry
  IsotropicResponse isotropic_response;  ///< isotropic response k' of eq. (28b)
  double mass = 0;                       ///< mass of the body without fluid [kg]
  double displaced_mass = 0;             ///< m_f = rho volume [kg]
  Vector3 centre_of_volume;              ///< in B [m]
  std::shared_ptr<const SurfaceLoads> loads;     ///< null: no surface loads
  FrameOffset load_frame;                        ///< pose in B of the frame of the loads
  std::optional<WetPart> wet;                    ///< that the loads act on; none: all of the body
  std::shared_ptr<const Resistance> resistance;  ///< of the loads, in B; null: none
  double settling = 0;  ///< of the resistance in a creeping flow, over K in translation [1/s]
  double reference_length = 0;  ///< sqrt(area) [m]
  double largest_mass = 0;      ///< largest eigenvalue of K's translation block [kg]
};

/// Throws std::invalid_argument, naming value and limit, if the medium is not physical.
void checkMedium(const FluidBody& fluid_body, const Medium& medium);

/// What is in the holds of a body that one fluid surrounds: that fluid, which then moves with the
/// body and is not displaced, docs/theory.md eq. (134); or nothing.
enum class HoldContent { kFull, kSealed };

/// How the fluid acts on a body beside what its shape says.
struct FluidEffect {
  HoldContent content = HoldContent::kFull;
  double added_mass_factor = 1;  ///< AttachDef::added_mass_factor
  double load_factor = 1;        ///< on the resistance; the other loads have that of Surroundings
};

/// Builds the model. `fluid_frame`: pose of F in B; `loads`: of this body and medium, or null.
/// @throws std::invalid_argument, naming value and limit, if shape, mass, inertia or medium are not
/// physical.
BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium,
                        std::shared_ptr<const SurfaceLoads> loads, const FluidEffect& effect = {});

/// The share of pressure and friction in B for a twist in B relative to the ambient flow, after
/// removePositivePower(); docs/theory.md eq. (13) to (17) and (20). `load_scale`: factor of eq.
/// (51d). `flow`: how the fluid moves along the body, null: as one; see loadAlong().
SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist,
                               double load_scale = 1, const FlowAlongBody* flow = nullptr) noexcept;

/// Returns the resistance of loads in B times a factor; null: they have none. `frame`: where they
/// sit in B.
std::shared_ptr<const Resistance> resistanceInB(const std::shared_ptr<const SurfaceLoads>& loads,
                                                const FrameOffset& frame, double factor = 1);

/// Sets the resistance of a model and how quickly it settles the body. @pre the inertia is set
void giveResistance(BodyModel& model, std::shared_ptr<const Resistance> resistance) noexcept;

/// All of a load: with what the resistance (null: none) makes of the twist.
inline Wrench wholeLoad(const SurfaceLoad& load, const Resistance* resistance, const Twist& x) {
  return resistance ? load.wrench + resistance->load(load.growth, x) : load.wrench;
}

/// Returns the rate at which the resistance settles a body [1/s] if that is within some times
/// `duration` [s], else 0. Then a step has to take up forces and resistance at once for a steady
/// motion to be right.
double settlingIn(const BodyModel& model, const Growth& growth, double duration) noexcept;

/// Pair of a twist x and its momentum K x.
inline DualPair pairOfTwist(const BodyModel& model, const Vector6& x) {
  if (model.has_diagonal_inertia) return {x, model.inertia.diagonal().cwiseProduct(x)};
  return {x, model.inertia * x};
}

/// Pair of a momentum (or wrench) m and its twist (or acceleration) K^-1 m.
inline DualPair pairOfMomentum(const BodyModel& model, const Vector6& m) {
  if (model.has_diagonal_inertia) return {model.inverse_inertia.diagonal().cwiseProduct(m), m};
  return {model.inverse_inertia * m, m};
}

/// Twice the kinetic energy of body and fluid, x.K x [J].
inline double inertiaNormSquared(const BodyModel& model, const Vector6& x) {
  const DualPair pair = pairOfTwist(model, x);
  return inner(pair, pair);
}

/// Gyroscopic wrench (l x w + p x v, p x w) of Kirchhoff's equations in B, docs/theory.md eq. (2):
/// K dx/dt = gyroscopic wrench + applied wrench, for a twist x with momentum (l, p) = K x.
inline Wrench gyroscopicWrench(const Momentum& m, const Twist& x) {
  return {m.angular.cross(x.angular) + m.linear.cross(x.linear), m.linear.cross(x.angular)};
}
Wrench gyroscopicWrench(const DualPair& x);

/// Motion that the wake of a smooth body has taken up, w of docs/theory.md eq. (51b): in world
/// axes, relative to the ambient flow.
struct Wake {
  Twist velocity_W;
  bool has_begun = false;  ///< false: it is the motion itself when the body is first met
};

/// Returns the share in [0, 1] of a developed wake that a motion has at the start of a step, eq.
/// (51c), and lets the wake follow it over the step. 1 in steady motion; 0 at a reversal.
/// @param velocity_W of the body, relative to the ambient flow
/// @param area of its surface [m^2]
/// @param volume [m^3]
/// @param duration of the step [s]
/// @param wake changes
double developWake(const Twist& velocity_W, double area, double volume, double duration,
                   Wake& wake) noexcept;

}  // namespace ambient
