#include "bullet_ambient/motion/body/body_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

Vector6 IsotropicResponse::beyond(const Vector6& momentum, const Vector6& change) const {
  constexpr double kRounding = 1e-12;
  const Vector6 even = *this * momentum;
  Vector6 excess = even - change;
  if (excess.head<3>().norm() <= kRounding * even.head<3>().norm()) excess.head<3>().setZero();
  if (excess.tail<3>().norm() <= kRounding * even.tail<3>().norm()) excess.tail<3>().setZero();
  return excess;
}

IsotropicResponse makeIsotropicResponse(const Matrix6& inverse_inertia,
                                        const Matrix3& dry_inertia) {
  const Cholesky<3> root(dry_inertia);
  AMBIENT_ASSERT(root.isPositive());
  const Matrix3 L = root.lower();
  const Eigen::Matrix3d angular = L.transpose() * inverse_inertia.topLeftCorner<3, 3>() * L;
  const Eigen::Matrix3d linear = inverse_inertia.bottomRightCorner<3, 3>();
  return {symmetricEigen(angular).values[2] * root.inverse(), symmetricEigen(linear).values[2]};
}

namespace {

void require(bool is_fine, const FluidBody& body, const char* quantity, double value,
             const char* limit) {
  if (!is_fine) reject(body, quantity, value, limit);
}

void checkMass(const FluidBody& body, const MassProperties& mass) {
  require(mass.mass > 0 && std::isfinite(mass.mass), body, "mass [kg]", mass.mass,
          "positive and finite");
  for (const double entry : mass.inertia.reshaped())
    require(std::isfinite(entry), body, "moment of inertia [kg m^2]", entry,
            "finite (for a body that must not turn, use its angular factor)");
  const double smallest = symmetricEigen<3>(mass.inertia).values[0];
  require(smallest > 0, body, "smallest principal moment of inertia [kg m^2]", smallest,
          "positive");
}

void checkShape(const FluidBody& body) {
  const auto requireSize = [&body](const char* quantity, double value) {
    require(value >= 0 && std::isfinite(value), body, quantity, value,
            "zero or positive and finite");
  };
  requireSize("volume [m^3]", body.volume);
  requireSize("radius of the sphere [m]", body.sphere_radius);
  requireSize("wetted area [m^2]", body.area);
  require(body.centre_of_volume.allFinite(), body, "distance of its centre of volume [m]",
          body.centre_of_volume.norm(), "finite");
}

void checkFrame(const FluidBody& body, const FrameOffset& frame) {
  require(frame.translation.allFinite(), body, "distance of its frame from the centre of mass [m]",
          frame.translation.norm(), "finite");
  constexpr double kRounding = 1e-6;  // tolerance for a rotation stored in single precision
  const Matrix3 rest = frame.rotation * frame.rotation.transpose() - Matrix3::Identity();
  const double error = rest.cwiseAbs().maxCoeff();
  require(error <= kRounding, body, "error of its frame's rotation matrix", error, "at most 1e-6");
  const double determinant = frame.rotation.determinant();
  require(determinant > 0, body, "determinant of its frame's rotation matrix", determinant,
          "1: a rotation, not a mirror");
}

// Limits the distance of centre of volume and centre of mass to 2^23 sizes, the precision of float.
void checkLever(const FluidBody& body, const BodyModel& model) {
  constexpr double kSizes = 8388608;
  const double size = std::max(std::sqrt(body.area), portable::cbrt(body.volume));
  const double lever = model.centre_of_volume.norm();
  require(!(model.displaced_mass > 0) || lever <= kSizes * size, body,
          "distance of its centre of volume from the centre of mass [m]", lever,
          "at most 2^23 times its size");
}

// Symmetrises K and sets entries of the size of rounding to 0: the change of frame leaves an
// asymmetry, and tiny couplings that symmetry of the body forbids.
Matrix6 withoutRounding(const Matrix6& inertia) {
  constexpr double kRounding = 1e-14;
  Matrix6 K = 0.5 * (inertia + inertia.transpose());
  const Vector6 size = K.diagonal().cwiseAbs().cwiseSqrt();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (i != j && std::abs(K(i, j)) <= kRounding * size[i] * size[j]) K(i, j) = 0;
  return K;
}

/// What one fluid around a body and in its holds displaces and moves with it, per unit density.
struct Displacement {
  double volume = 0;
  Vector3 centre{0, 0, 0};               // in F
  Matrix6 added_mass = Matrix6::Zero();  // about F's origin
};

/// Holds full of the fluid displace nothing; what is in them is carried along.
Displacement withFullHolds(const FluidBody& body, double added_mass_factor) {
  Displacement walls{body.volume, body.volume * body.centre_of_volume,
                     added_mass_factor * body.added_mass};
  for (const Hold& hold : body.holds) {
    walls.volume -= hold.volume;
    walls.centre -= hold.volume * hold.centre;
    walls.added_mass +=
        shiftOrigin(rigidBodyInertia(hold.volume, hold.turning_inertia), -hold.centre);
  }
  // Of walls thinner than rounding nothing is left.
  walls.volume = std::max(walls.volume, 0.0);
  walls.centre = walls.volume > 0 ? walls.centre / walls.volume : body.centre_of_volume;
  return walls;
}

}  // namespace

void checkMedium(const FluidBody& body, const Medium& medium) {
  if (const auto fault = faultOf(medium))
    reject(body, std::string(fault->quantity) + " of the medium [" + fault->unit + "]",
           fault->value, fault->limit);
}

BodyModel makeBodyModel(const FluidBody& fluid_body, const FrameOffset& fluid_frame,
                        const MassProperties& mass, const Medium& medium,
                        std::shared_ptr<const SurfaceLoads> loads, const FluidEffect& effect) {
  checkMass(fluid_body, mass);
  checkShape(fluid_body);
  checkMedium(fluid_body, medium);
  checkFrame(fluid_body, fluid_frame);
  const bool is_full = effect.content == HoldContent::kFull && !fluid_body.holds.empty();
  const Displacement displaced =
      is_full ? withFullHolds(fluid_body, effect.added_mass_factor)
              : Displacement{fluid_body.volume, fluid_body.centre_of_volume,
                             effect.added_mass_factor * fluid_body.added_mass};
  BodyModel model;
  model.inertia = rigidBodyInertia(mass.mass, mass.inertia) +
                  medium.density * fluid_frame.inertiaToB(displaced.added_mass);
  model.inertia = withoutRounding(model.inertia);
  const Cholesky<6> factor(model.inertia);
  if (!factor.isPositive() || !model.inertia.allFinite()) {
    reject(fluid_body, "largest entry of body and added inertia",
           model.inertia.cwiseAbs().maxCoeff(), "finite, in a positive definite 6x6 matrix");
  }
  model.inverse_inertia = factor.inverse();
  AMBIENT_ASSERT(model.inverse_inertia.diagonal().minCoeff() > 0);
  AMBIENT_ASSERT(isSymmetric(model.inertia));
  AMBIENT_ASSERT(isSymmetric(model.inverse_inertia));
  model.isotropic_response = makeIsotropicResponse(model.inverse_inertia, mass.inertia);
  model.mass = mass.mass;
  model.displaced_mass = medium.density * displaced.volume;
  model.centre_of_volume = fluid_frame.rotation * displaced.centre + fluid_frame.translation;
  AMBIENT_ASSERT(model.displaced_mass >= 0 && model.centre_of_volume.allFinite());
  checkLever(fluid_body, model);
  if (loads) {
    model.load_frame = loads->frame(fluid_frame);
    giveResistance(model, resistanceInB(loads, model.load_frame, effect.load_factor));
  }
  const Resistance* const resistance = model.resistance.get();
  model.has_diagonal_inertia =
      model.inertia.isDiagonal(0) && model.inverse_inertia.isDiagonal(0) &&
      (!resistance || (resistance->matrix.isDiagonal(0) && resistance->centre.isZero(0)));
  model.loads = std::move(loads);
  model.reference_length = std::sqrt(fluid_body.area);
  model.largest_mass = symmetricEigen<3>(model.inertia.bottomRightCorner<3, 3>()).values[2];
  AMBIENT_ASSERT(model.largest_mass > 0 && model.reference_length >= 0);
  return model;
}

SurfaceLoad computeSurfaceLoad(const BodyModel& model, const Twist& relative_twist,
                               double load_scale, const FlowAlongBody* flow) noexcept {
  AMBIENT_ASSERT(model.loads);
  const Resistance* const resistance = model.resistance.get();
  return loadAlong(flow, relative_twist, resistance, [&](const Twist& x) -> SurfaceLoad {
    const FrameOffset& frame = model.load_frame;
    const bool is_B = frame.isIdentity();
    const SplitLoad split =
        model.loads->split(is_B ? x : frame.toF(x), model.wet ? &*model.wet : nullptr);
    const Wrench wrench = load_scale * (is_B ? split.wrench : frame.toB(split.wrench));
    SurfaceLoad load{wrench};
    if (model.loads->needsGuard()) load = removePositivePower(wrench, x, model.inertia);
    load.growth = split.growth;
    return load;
  });
}

std::shared_ptr<const Resistance> resistanceInB(const std::shared_ptr<const SurfaceLoads>& loads,
                                                const FrameOffset& frame, double factor) {
  const Resistance* const in_F = loads->resistance();
  if (!in_F) return nullptr;
  if (frame.isIdentity() && factor == 1) return {loads, in_F};
  Resistance in_B{factor * in_F->matrix, frame.rotation * in_F->centre + frame.translation};
  if (!frame.rotation.isIdentity(0)) in_B.matrix = rotateAxes(in_B.matrix, frame.rotation);
  return std::make_shared<const Resistance>(in_B);
}

void giveResistance(BodyModel& model, std::shared_ptr<const Resistance> resistance) noexcept {
  model.resistance = std::move(resistance);
  if (!model.resistance) return;
  model.settling = model.resistance->matrix.bottomRightCorner<3, 3>().trace() /
                   model.inertia.bottomRightCorner<3, 3>().trace();
}

double settlingIn(const BodyModel& model, const Growth& growth, double duration) noexcept {
  constexpr double kSettled = 0.02;
  const double rate = growth.translation * growth.translation * model.settling;
  return duration * rate > kSettled ? rate : 0;
}

Wrench gyroscopicWrench(const DualPair& motion) {
  return gyroscopicWrench(Momentum::fromVector(motion.momentum), Twist::fromVector(motion.twist));
}

namespace {

constexpr double kWakeLength = 1.5;  // lambda_w, diameters in which the wake follows the motion
constexpr double kDeveloped = 0.7;   // share from which on it counts as developed

/// Product of motions as velocities of points of a ball of that surface.
double product(const Twist& a, const Twist& b, double area) {
  return a.linear.dot(b.linear) + area / (4 * kPi) * a.angular.dot(b.angular);
}

}  // namespace

double developWake(const Twist& x, double area, double volume, double duration,
                   Wake& wake) noexcept {
  AMBIENT_ASSERT(duration >= 0 && area >= 0 && volume >= 0);
  if (!wake.has_begun) wake = {x, true};
  const double square = product(x, x, area);
  const double wake_length = area > 0 ? kWakeLength * 6 * volume / area : 0;
  if (!(square > 0) || !(wake_length > 0)) return 1;
  const double share =
      std::clamp(product(wake.velocity_W, x, area) / (kDeveloped * square), 0.0, 1.0);
  const double kept = portable::exp(-std::sqrt(square) * duration / wake_length);
  Twist& w = wake.velocity_W;
  w = {x.angular + kept * (w.angular - x.angular), x.linear + kept * (w.linear - x.linear)};
  return share * share;
}

}  // namespace ambient
