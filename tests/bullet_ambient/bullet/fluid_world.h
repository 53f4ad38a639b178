#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/fluid.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/world.h"

namespace ambient::test {

constexpr bool kDouble = sizeof(btScalar) == sizeof(double);

/// Selects the tolerance of the compiled precision.
constexpr double byPrecision(double in_double, double in_float) {
  return kDouble ? in_double : in_float;
}

inline btScalar bt(double value) { return static_cast<btScalar>(value); }

constexpr double kWorldStep = 1.0 / 120;  // [s]
constexpr double kGravity = 9.81;         // [m/s^2]

inline const Vector3 kUnequalAxes(0.3, 0.25,
                                  0.1);  // ellipsoid, not of revolution

inline const Vector3 kBoxSize(0.8, 0.6, 0.4);  // of floating boxes [m]

inline Medium idealFluid(double density) { return {density, 0, Vector3::Zero(), Vector3::Zero()}; }

/// Still water at a level [m], under air.
inline FluidRegion seaUnderAir(double level = 0) {
  FluidRegion sea = waterBelow(level);
  sea.above = air();
  return sea;
}

/// The same of 1000 kg/m^3 under a vacuum, in which closed forms hold; still without a surface.
inline FluidRegion seaUnderVacuum(std::shared_ptr<const WaterSurface> surface = nullptr) {
  FluidRegion sea = waterBelow(0);
  sea.below = {1000, 1e-3, {0, 0, 0}, {0, 0, 0}};
  sea.above = Medium{};
  if (surface) sea.surface = std::move(surface);
  return sea;
}

/// Attaches a sphere of radius 1.
inline AttachDef unitBallIn(const Medium& medium) {
  return {std::make_shared<FluidBody>(meshedEllipsoid(Vector3::Ones(), 1)), medium};
}

/// Dynamic body of a test: mass properties and initial state. Body axes are principal.
struct BodyDef {
  double mass = 1;
  Vector3 moments = Vector3::Ones();
  RigidState start{};  // twist in world axes here
  btCollisionShape* shape = nullptr;
};

/// State of a BodyDef at a place, at rest or moving.
inline RigidState startAt(const Vector3& position, const Twist& twist = {},
                          const Quaternion& orientation = Quaternion::Identity()) {
  return {orientation, position, twist};
}
inline RigidState startWith(const Twist& twist,
                            const Quaternion& orientation = Quaternion::Identity()) {
  return {orientation, Vector3::Zero(), twist};
}

/// Height of the centre of mass [m].
inline double heightOf(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().z());
}

/// Tells if two bodies have the same bits of pose and velocity.
inline bool moveAlike(const btRigidBody& a, const btRigidBody& b) {
  return a.getWorldTransform() == b.getWorldTransform() &&
         a.getLinearVelocity() == b.getLinearVelocity() &&
         a.getAngularVelocity() == b.getAngularVelocity();
}

/// Remembers the action that it was given first: that of its fluid.
struct ActionWorld : btDiscreteDynamicsWorld {
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
  void addAction(btActionInterface* action) override {
    if (!first_action) first_action = action;
    btDiscreteDynamicsWorld::addAction(action);
  }
  btActionInterface* first_action = nullptr;
};

/// A world with a fluid, gravity 0.
struct FluidWorld : WholeWorld<ActionWorld> {
  FluidWorld() {
    world.setGravity({0, 0, 0});
    fluid.setReport([this](const std::string& sentence) { said.push_back(sentence); });
  }

  btRigidBody& add(const BodyDef& def) {
    btRigidBody& body =
        contents.add(def.mass, toBullet(def.moments), def.shape ? *def.shape : no_shape_,
                     btTransform(toBullet(def.start.orientation), toBullet(def.start.position)));
    body.setAngularVelocity(toBullet(def.start.twist.angular));
    body.setLinearVelocity(toBullet(def.start.twist.linear));
    body.setActivationState(DISABLE_DEACTIVATION);
    return body;
  }
  btRigidBody& add(const BodyDef& def, const FluidBody& fluid_body, const Medium& medium,
                   PressureLaw law = PressureLaw::kForm) {
    btRigidBody& body = add(def);
    AttachDef attach;
    const auto prepared = std::make_shared<FluidBody>(fluid_body);
    makeSurfaceForm(*prepared);
    if (prepared->area > 0 && !prepared->viscous.isKnown()) giveResistance(*prepared);
    attach.fluid_body = prepared;
    attach.medium = medium;
    attach.flow.law = law;
    fluid.add(body, attach);
    return body;
  }
  /// Takes the fluid's action out of the world, and gives it back, after other actions.
  void removeAction() { world.removeAction(world.first_action); }
  void addAction() { world.addAction(world.first_action); }
  /// A body that is in the fluid.
  Immersed of(const btRigidBody& body) const { return fluid.find(body).value(); }

  std::vector<std::string> said;  ///< by the fluid
  Fluid fluid{world};

 private:
  btEmptyShape no_shape_;
};

/// The same with gravity along -z, in one region; pairs of bodies are found in the order of states.
struct SeaWorld : FluidWorld {
  explicit SeaWorld(const FluidRegion& sea = seaUnderAir()) {
    world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world.setGravity({0, 0, bt(-kGravity)});
    fluid.addRegion(sea);
  }
  /// Adds a homogeneous longBox().
  btRigidBody& addBox(const Vector3& size, double mass, const RigidState& start = {},
                      int divisions = 2) {
    btRigidBody& body = FluidWorld::add({mass, boxMoments(size, mass), start, nullptr});
    fluid.add(body, {longBox(size, divisions), Medium{}});
    return body;
  }
};

/// A joint to the world that lets a body move within limits [m], and not turn.
inline std::unique_ptr<btGeneric6DofConstraint> railOf(btRigidBody& body, const btVector3& lowest,
                                                       const btVector3& highest,
                                                       bool in_its_frame = false) {
  auto rail =
      std::make_unique<btGeneric6DofConstraint>(body, btTransform::getIdentity(), in_its_frame);
  rail->setLinearLowerLimit(lowest);
  rail->setLinearUpperLimit(highest);
  rail->setAngularLowerLimit({0, 0, 0});
  rail->setAngularUpperLimit({0, 0, 0});
  return rail;
}

/// Another action of the world, before the fluid's or after it, while it lives.
class OtherAction : public btActionInterface {
 public:
  OtherAction(FluidWorld& scene, std::function<void()> act, bool is_first = true)
      : scene_(scene), act_(std::move(act)) {
    if (is_first) scene_.removeAction();
    scene_.world.addAction(this);
    if (is_first) scene_.addAction();
  }
  ~OtherAction() { scene_.world.removeAction(this); }
  OtherAction(const OtherAction&) = delete;
  OtherAction& operator=(const OtherAction&) = delete;
  void updateAction(btCollisionWorld*, btScalar) override { act_(); }
  void debugDraw(btIDebugDraw*) override {}

 private:
  FluidWorld& scene_;
  std::function<void()> act_;
};

}  // namespace ambient::test
