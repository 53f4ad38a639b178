#include "tests/bullet_ambient/bullet/robots/state/robot_state_scene.h"

#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>

#include "bullet_ambient/force/medium/waves.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {

RobotStateScene::RobotStateScene(RobotStateKind kind) {
  robots_.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
  switch (kind) {
    case RobotStateKind::kFlight:
      addFlight();
      break;
    case RobotStateKind::kMotors:
      addMotors();
      break;
    case RobotStateKind::kContacts:
      addContacts();
      break;
    case RobotStateKind::kTethers:
      addTethers();
      break;
    case RobotStateKind::kWater:
      addWater();
      break;
    case RobotStateKind::kSwimming:
      addSwimmer();
      break;
  }
}

FluidBodyLookup RobotStateScene::lookup() const {
  return [this](const std::string& name) {
    const auto found = shapes_.find(name);
    return found == shapes_.end() ? nullptr : found->second;
  };
}

btMultiBody& RobotStateScene::add(const RobotDef& def) { return robots_.add(arbitrary_, def); }

void RobotStateScene::attach(btMultiBody& body, int link, AttachDef def) {
  auto shape = std::make_shared<FluidBody>(*def.fluid_body);
  shape->name = "shape " + std::to_string(shapes_.size());
  def.fluid_body = shapes_[shape->name] = shape;
  robots_.fluid.add(body, link, def);
}

btMultiBody& RobotStateScene::addInFluid(const RobotDef& def) {
  btMultiBody& body = add(def);
  for (int i = def.has_fixed_base ? 0 : -1; i < def.links; ++i)
    attach(body, i, coupledFluid(arbitrary_, body, i, 3));
  return body;
}

void RobotStateScene::addFlight() {
  RobotDef def{5, Joints::kAll};
  addInFluid(def);
  add(def);
  def.has_fixed_base = true;
  addInFluid(def);
}

void RobotStateScene::addMotors() {
  robots_.world.getSolverInfo().m_solverMode |= SOLVER_USE_ARTICULATED_WARMSTARTING;
  robots_.world.getSolverInfo().m_numIterations = 3;
  RobotDef def;
  def.collider_radius = 0.02;
  for (const bool is_in_fluid : {true, false}) {
    btMultiBody& body = is_in_fluid ? addInFluid(def) : add(def);
    robots_.take(std::make_unique<btMultiBodyJointMotor>(&body, 0, bt(2), bt(0.05)));
    robots_.take(std::make_unique<btMultiBodyJointLimitConstraint>(&body, 1, bt(-0.8), bt(0.8)));
    const btVector3 none(0, 0, 0);
    const btMatrix3x3 axes = btMatrix3x3::getIdentity();
    auto gear =
        std::make_unique<btMultiBodyGearConstraint>(&body, 2, &body, 0, none, none, axes, axes);
    gear->setGearRatio(bt(-1));
    gear->setMaxAppliedImpulse(bt(0.01));
    robots_.take(std::move(gear));
  }
}

void RobotStateScene::addContacts() {
  robots_.world.setGravity({0, 0, bt(-9.81)});
  robots_.world.getSolverInfo().m_numIterations = 10;
  RobotDef def;
  def.collider_radius = 0.06;
  addInFluid(def);
  addInFluid(def);
  add(def);
  const btTransform place = btTransform::getIdentity();
  robots_.addFixed(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), bt(-1)), place);
  const btCollisionObjectArray& objects = robots_.world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    objects[i]->setFriction(bt(0.6));
    objects[i]->setRestitution(bt(0.3));
  }
}

void RobotStateScene::addTethers() {
  RobotDef def;
  def.collider_radius = 0.02;
  for (const bool is_in_fluid : {true, false}) {
    btMultiBody& body = is_in_fluid ? addInFluid(def) : add(def);
    const btVector3 tip(bt(0.1), 0, 0);
    robots_.take(std::make_unique<btMultiBodyPoint2Point>(&body, 2, nullptr, tip,
                                                          body.localPosToWorld(2, tip)));
  }
}

void RobotStateScene::addWater() {
  robots_.world.setGravity({0, 0, bt(-9.81)});
  FluidRegion sea;
  sea.below = water();
  sea.surface =
      std::make_shared<AiryWaves>(CalmSea{}, std::vector<WaveComponent>{{0.1, 3, {1, 0, 0}, 0}});
  robots_.fluid.addRegion(sea);
  AttachDef def;
  def.flow.law = PressureLaw::kPublished;
  def.fluid_body = std::make_shared<FluidBody>(floatingEllipsoid(Vector3(0.15, 0.06, 0.05), 1));
  def.medium = air();
  def.flow.stall_lag = 4.5;
  RobotDef chain;
  chain.speed = 2;
  for (int i = 0; i < 3; ++i) {
    btMultiBody& body = add(chain);
    body.setBasePos({bt(2.0 * i), 0, bt(0.3 * i - 0.1)});
    RobotWorld::moveColliders(body);
    for (int link = -1; link < chain.links; ++link) attach(body, link, def);
  }
}

void RobotStateScene::addSwimmer() {
  AttachDef def{std::make_shared<FluidBody>(meshedEllipsoid(Vector3(0.15, 0.06, 0.05), 1)),
                water()};
  RobotDef chain;
  btMultiBody& body = add(chain);
  for (int link = -1; link < chain.links; ++link) attach(body, link, def);
}

}  // namespace ambient::test
