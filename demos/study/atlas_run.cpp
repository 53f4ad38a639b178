#include "demos/study/atlas_run.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_body.h"
#include "bullet_ambient/bullet/ambient_solver.h"
#include "bullet_ambient/spatial/elementary.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/principal_frame.h"

namespace ambient {
namespace {

constexpr double kGravity = 9.81;

Vector3 randomDirection(std::mt19937& engine) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (;;) {
    const double x = coordinate(engine), y = coordinate(engine), z = coordinate(engine);
    const double length_sq = x * x + y * y + z * z;
    if (length_sq > 0.01 && length_sq < 1) return Vector3(x, y, z) / std::sqrt(length_sq);
  }
}

// The world of one case; gone with it.
class AtlasWorld {
 public:
  AtlasWorld(const AtlasCase& atlas_case, AtlasFluid fluid)
      : case_(atlas_case),
        has_gravity_(atlas_case.setting != AtlasSetting::kFree),
        fluid_body_(scaled(*atlas_case.shape->body, atlas_case.size)),
        medium_(atlas_case.water ? water() : air()),
        box_(toBullet(Vector3(atlas_case.size * atlas_case.shape->half_size))),
        plane_({0, 0, 1}, static_cast<btScalar>(-atlas_case.size / 2)),
        floor_(0, nullptr, &plane_) {
    world_.addAction(&action_);
    world_.setGravity({0, 0, has_gravity_ ? -kGravity : 0});
    addBody();
    if (fluid == AtlasFluid::kAttached) attachBody();
    if (case_.setting == AtlasSetting::kOnPlane) world_.addRigidBody(&floor_);
    if (case_.setting == AtlasSetting::kOnJoint) {
      joint_ = std::make_unique<btPoint2PointConstraint>(*body_, btVector3(case_.size / 2, 0, 0));
      world_.addConstraint(joint_.get());
    }
  }
  ~AtlasWorld() {
    if (joint_) world_.removeConstraint(joint_.get());
    if (floor_.isInWorld()) world_.removeRigidBody(&floor_);
    world_.removeRigidBody(body_.get());
    world_.removeAction(&action_);
  }
  AtlasWorld(const AtlasWorld&) = delete;
  AtlasWorld& operator=(const AtlasWorld&) = delete;

  void step() { world_.stepSimulation(case_.step, 0, case_.step); }
  bool isFinite() const { return readState(*body_).isFinite(); }
  double kineticEnergy() const {
    const Vector6 x = readState(*body_).twist.vector();
    return x.dot(inertia_ * x) / 2;
  }
  double potentialEnergy() const {
    if (!has_gravity_) return 0;
    const RigidState state = readState(*body_);
    const Vector3 centre_of_volume = state.position + state.orientation * centre_of_volume_B_;
    return kGravity * (mass_ * state.position.z() - displaced_mass_ * centre_of_volume.z());
  }
  double energyOfAFall() const { return has_gravity_ ? mass_ * kGravity * case_.size : 0; }
  AmbientCounters counters() const { return registry_.counters(); }

 private:
  void addBody() {
    const double solid_volume = case_.shape->solid_volume * portable::pow(case_.size, 3);
    mass_ = case_.density_ratio * medium_.density * solid_volume;
    const MassDistribution& distribution = fluid_body_.uniform_mass;
    const PrincipalFrame principal = findPrincipalFrame(mass_ * distribution.inertia);
    body_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        mass_, nullptr, &box_, toBullet(principal.moments)));
    std::mt19937 engine(case_.seed);
    const Vector3 axis = randomDirection(engine);
    const Vector3 turn = 3 * randomDirection(engine);
    body_->setWorldTransform(btTransform(
        btQuaternion(toBullet(Vector3(turn.normalized())), turn.norm()), btVector3(0, 0, 0)));
    body_->setLinearVelocity(toBullet(Vector3(case_.speed * axis)));
    body_->setAngularVelocity(toBullet(Vector3(case_.spin * randomDirection(engine))));
    body_->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(body_.get());
    inertia_ = rigidBodyInertia(mass_, principal.moments.asDiagonal());
  }
  void attachBody() {
    const MassDistribution& distribution = fluid_body_.uniform_mass;
    const PrincipalFrame principal = findPrincipalFrame(mass_ * distribution.inertia);
    AttachDef def;
    def.fluid_frame.rotation = principal.rotation.transpose();
    def.fluid_frame.translation = -(principal.rotation.transpose() * distribution.centre);
    centre_of_volume_B_ =
        def.fluid_frame.rotation * fluid_body_.centre_of_volume + def.fluid_frame.translation;
    def.fluid_body = std::make_shared<FluidBody>(fluid_body_);
    def.medium = medium_;
    def.flow.separation_angle = case_.shape->separation_angle;
    registry_.setReport(nullptr);
    registry_.attach(world_, *body_, def);
    inertia_ = registry_.inertia(*body_);
    displaced_mass_ = medium_.density * fluid_body_.volume;
  }

  const AtlasCase& case_;
  bool has_gravity_;
  FluidBody fluid_body_;
  Medium medium_;
  double mass_ = 0, displaced_mass_ = 0;
  Matrix6 inertia_;  // of body and fluid, in B
  Vector3 centre_of_volume_B_ = Vector3::Zero();
  AmbientRegistry registry_;
  AmbientSolver<> solver_{registry_};
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  AmbientAction action_{registry_};
  btBoxShape box_;
  btStaticPlaneShape plane_;
  btRigidBody floor_;
  std::unique_ptr<btRigidBody> body_;
  std::unique_ptr<btPoint2PointConstraint> joint_;
};

}  // namespace

AtlasResult runAtlasCase(const AtlasCase& atlas_case, AtlasFluid fluid) {
  AtlasWorld world(atlas_case, fluid);
  AtlasResult result;
  double kinetic = world.kineticEnergy();
  double largest_kinetic = kinetic;
  double lowest = kinetic + world.potentialEnergy();
  double rise = 0;
  const int steps = static_cast<int>(std::lround(kAtlasDuration / atlas_case.step));
  for (int i = 0; i < steps && result.finite; ++i) {
    world.step();
    kinetic = world.kineticEnergy();
    const double energy = kinetic + world.potentialEnergy();
    result.finite = world.isFinite() && std::isfinite(energy);
    largest_kinetic = std::max(largest_kinetic, kinetic);
    rise = std::max(rise, energy - lowest);
    lowest = std::min(lowest, energy);
  }
  const double scale = largest_kinetic + world.energyOfAFall();
  result.energy_rise = scale > 0 ? rise / scale : 0;
  const AmbientCounters counters = world.counters();
  result.rejected = counters.rejected;
  result.coarse = static_cast<double>(counters.coarse) / steps;
  return result;
}

}  // namespace ambient
