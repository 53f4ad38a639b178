#include "tests/study/stability/atlas_run.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/support/convergence.h"
#include "tests/support/world.h"

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

btScalar bt(double x) { return static_cast<btScalar>(x); }

/// One body of a case, attached to the fluid or dry.
struct AtlasBody {
  btRigidBody* body = nullptr;
  Matrix6 inertia;  ///< body and fluid, in B
  double mass = 0, displaced_mass = 0;
  Vector3 centre_of_volume_B = Vector3::Zero();

  double kineticEnergy() const {
    const Vector6 x = readState(*body).twist.vector();
    return x.dot(inertia * x) / 2;
  }
  double potentialEnergy() const {
    const RigidState state = readState(*body);
    const Vector3 centre_of_volume = state.position + state.orientation * centre_of_volume_B;
    return kGravity * (mass * state.position.z() - displaced_mass * centre_of_volume.z());
  }
};

// World of one case.
class AtlasWorld {
 public:
  AtlasWorld(const AtlasCase& atlas_case, AtlasFluid fluid)
      : case_(atlas_case),
        has_gravity_(atlas_case.setting != AtlasSetting::kFree),
        fluid_body_(std::make_shared<FluidBody>(scaled(*atlas_case.shape->body, atlas_case.size))),
        medium_(atlas_case.water ? water() : air()),
        box_(toBullet(Vector3(atlas_case.size * atlas_case.shape->half_size))),
        plane_({0, 0, 1}, bt(-atlas_case.size / 2)) {
    bullet_.world.setGravity({0, 0, bt(has_gravity_ ? -kGravity : 0)});
    fluid_.setReport(nullptr);
    addBodies();
    if (fluid == AtlasFluid::kAttached)
      for (AtlasBody& body : bodies_) attach(body);
    if (case_.setting == AtlasSetting::kOnPlane) bullet_.contents.add(0, plane_);
    if (case_.setting == AtlasSetting::kOnJoint)
      bullet_.contents.take(std::make_unique<btPoint2PointConstraint>(
          *bodies_.front().body, btVector3(bt(case_.size / 2), 0, 0)));
  }

  void step() { bullet_.step(case_.step); }
  bool isFinite() const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [](const AtlasBody& body) { return readState(*body.body).isFinite(); });
  }
  double kineticEnergy() const {
    return sum([](const AtlasBody& body) { return body.kineticEnergy(); });
  }
  double potentialEnergy() const {
    if (!has_gravity_) return 0;
    return sum([](const AtlasBody& body) { return body.potentialEnergy(); });
  }
  double energyOfAFall() const {
    if (!has_gravity_) return 0;
    return kGravity * case_.size * sum([](const AtlasBody& body) { return body.mass; });
  }
  AmbientCounters counters() const { return fluid_.counters(); }

 private:
  template <class Quantity>
  double sum(const Quantity& quantity) const {
    double sum = 0;
    for (const AtlasBody& body : bodies_) sum += quantity(body);
    return sum;
  }

  void addBodies() {
    const double solid_volume = case_.shape->solid_volume * portable::pow(case_.size, 3);
    const double mass = case_.density_ratio * medium_.density * solid_volume;
    std::mt19937 engine(case_.seed);
    const Vector3 axis = randomDirection(engine);
    const Vector3 turn = 3 * randomDirection(engine);
    btRigidBody& body = add(mass);
    body.setLinearVelocity(toBullet(Vector3(case_.speed * axis)));
    body.setAngularVelocity(toBullet(Vector3(case_.spin * randomDirection(engine))));
    if (case_.load_ratio == 0) {
      body.setWorldTransform(btTransform(
          btQuaternion(toBullet(Vector3(turn.normalized())), bt(turn.norm())), {0, 0, 0}));
      return;
    }
    constexpr double kGap = 0.01;  // gap in units of the size
    const double height = case_.size * (2 * case_.shape->half_size.z() + kGap);
    add(case_.load_ratio * mass).getWorldTransform().setOrigin({0, 0, bt(height)});
  }

  btRigidBody& add(double mass) {
    const PrincipalFrame principal = findPrincipalFrame(mass * fluid_body_->uniform_mass.inertia);
    AtlasBody added;
    added.mass = mass;
    added.inertia = rigidBodyInertia(mass, principal.moments.asDiagonal());
    added.body =
        &bullet_.contents.add(mass, toBullet(principal.moments), box_, btTransform::getIdentity());
    added.body->setActivationState(DISABLE_DEACTIVATION);
    bodies_.push_back(added);
    return *added.body;
  }

  void attach(AtlasBody& body) {
    const MassDistribution& distribution = fluid_body_->uniform_mass;
    const PrincipalFrame principal = findPrincipalFrame(body.mass * distribution.inertia);
    AttachDef def;
    def.fluid_frame.rotation = principal.rotation.transpose();
    def.fluid_frame.translation = -(principal.rotation.transpose() * distribution.centre);
    def.fluid_body = fluid_body_;
    def.medium = medium_;
    def.flow.separation_angle = case_.shape->separation_angle;
    def.flow.law = case_.law;
    body.centre_of_volume_B =
        def.fluid_frame.rotation * fluid_body_->centre_of_volume + def.fluid_frame.translation;
    body.displaced_mass = medium_.density * fluid_body_->volume;
    body.inertia = fluid_.add(*body.body, def).inertia();
  }

  const AtlasCase& case_;
  bool has_gravity_;
  std::shared_ptr<const FluidBody> fluid_body_;
  Medium medium_;
  btBoxShape box_;
  btStaticPlaneShape plane_;
  test::WholeWorld<> bullet_;
  Fluid fluid_{bullet_.world};
  std::vector<AtlasBody> bodies_;
};

}  // namespace
}  // namespace ambient

AMBIENT_BEGIN

AtlasResult runAtlasCase(const AtlasCase& atlas_case, AtlasFluid fluid) {
  AtlasWorld world(atlas_case, fluid);
  AtlasResult result;
  double kinetic = world.kineticEnergy();
  double largest_kinetic = kinetic;
  test::EnergyRise rise(kinetic + world.potentialEnergy());
  const int steps = static_cast<int>(std::lround(kAtlasDuration / atlas_case.step));
  for (int i = 0; i < steps && result.finite; ++i) {
    world.step();
    kinetic = world.kineticEnergy();
    const double energy = kinetic + world.potentialEnergy();
    result.finite = world.isFinite() && std::isfinite(energy);
    largest_kinetic = std::max(largest_kinetic, kinetic);
    rise.see(energy);
  }
  const double scale = largest_kinetic + world.energyOfAFall();
  result.energy_rise = scale > 0 ? rise.overEarlier() / scale : 0;
  const AmbientCounters counters = world.counters();
  result.rejected = counters.rejected;
  result.coarse = static_cast<double>(counters.coarse) / steps;
  return result;
}

AMBIENT_END
