#include "tests/fuzz/fuzz_scene.h"

#include <LinearMath/btAlignedAllocator.h>

#include <cstdlib>
#include <stdexcept>

#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

constexpr double kSpeedLimit = 1e5;            // [m/s], far above speeds from events
constexpr std::size_t kAllocationLimit = 500;  // per scene of any length

std::shared_ptr<const FluidBody> named(const char* name, FluidBody shape) {
  shape.name = name;
  return std::make_shared<FluidBody>(std::move(shape));
}

// A disc without volume: added mass is all of its fluid inertia.
FluidBody sheet() {
  FluidBody shape = meshedEllipsoid(Vector3(0.4, 0.4, 0.02), 1);
  shape.volume = 0;
  return shape;
}

std::size_t g_bullet_allocations = 0;

// Replaces Bullet's malloc and free by counting ones. Bullet's own steps allocate: for pairs,
// contacts and sorting.
void countBulletsAllocations() {
  btAlignedAllocSetCustom(
      [](std::size_t bytes) {
        ++g_bullet_allocations;
        return std::malloc(bytes);
      },
      std::free);
}

std::size_t allocationsBesidesBullets() { return allocationCount() - g_bullet_allocations; }

bool isFinite(const btRigidBody& body) {
  const auto& pose = body.getWorldTransform();
  return toVector3(pose.getOrigin()).allFinite() && toVector3(pose.getBasis()[0]).allFinite() &&
         toVector3(body.getLinearVelocity()).norm() < kSpeedLimit &&
         toVector3(body.getAngularVelocity()).norm() < kSpeedLimit;
}

}  // namespace

FuzzScene::FuzzScene(unsigned seed) : arbitrary_(seed) {
  countBulletsAllocations();
  fluid_bodies_ = {named("box", meshedEllipsoid(Vector3(0.5, 0.35, 0.25), 1)),
                   named("ball", meshedEllipsoid(Vector3::Constant(0.3), 1)),
                   named("without faces", facelessEllipsoid(Vector3(0.3, 0.2, 0.4))),
                   named("sheet", sheet())};
  pair_of_balls_.addChildShape(
      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.2), 0, 0)), &ball_);
  pair_of_balls_.addChildShape(
      btTransform(btQuaternion::getIdentity(), btVector3(btScalar(-0.2), 0, 0)), &ball_);
  is_repeatable_ = chance(0.6);
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  if (!is_repeatable_ && chance(0.5)) world_.getSolverInfo().m_solverMode |= SOLVER_RANDMIZE_ORDER;
  world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
  fluid_.setReport([this](const std::string& sentence) {
    // True of what is thrown about here, and no fault.
    const bool is_too_fast = sentence.find("too long for the motion") != std::string::npos;
    const bool is_light = sentence.find("so that it rises") != std::string::npos;
    const bool is_torn = sentence.find("comes apart") != std::string::npos;
    if (!is_too_fast && !is_light && !is_torn) complaint_ = sentence;
  });
  floor_ =
      &host_.contents.add(0, floor_shape_, btTransform(btQuaternion::getIdentity(), {0, 0, -1}));
  for (int i = below(12); i >= 0; --i) addBody();
}

FuzzScene::~FuzzScene() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const FuzzBody& fuzz : bodies_) {
    if (fuzz.is_in_world) world_.removeRigidBody(fuzz.body.get());
  }
}

int FuzzScene::below(int count) {
  return std::min(static_cast<int>(arbitrary_.between(0, count)), count - 1);
}

FuzzBody* FuzzScene::anyBody() {
  return bodies_.empty()
             ? nullptr
             : &bodies_[static_cast<std::size_t>(below(static_cast<int>(bodies_.size())))];
}

void FuzzScene::play() {
  static constexpr Event kEvents[] = {
      &FuzzScene::addBody,        &FuzzScene::destroyBody,   &FuzzScene::moveBetweenWorldAndShelf,
      &FuzzScene::attach,         &FuzzScene::attach,        &FuzzScene::attachWrongly,
      &FuzzScene::detach,         &FuzzScene::changeMedium,  &FuzzScene::changeMedium,
      &FuzzScene::changeShape,    &FuzzScene::changeMass,    &FuzzScene::push,
      &FuzzScene::push,           &FuzzScene::changeFactors, &FuzzScene::changeFlags,
      &FuzzScene::changeSleep,    &FuzzScene::addJoint,      &FuzzScene::addJoint,
      &FuzzScene::removeJoint,    &FuzzScene::draw,          &FuzzScene::saveAndRestore,
      &FuzzScene::saveAndRestore, &FuzzScene::damageBytes};
  const Event event = kEvents[below(static_cast<int>(std::size(kEvents)))];
  (this->*event)();
  check();
  step(1 + below(4));
}

void FuzzScene::step(int count) {
  for (int i = 0; i < count; ++i) {
    const std::size_t before = allocationsBesidesBullets();
    world_.stepSimulation(btScalar(1) / 120, 0);
    allocations_ += allocationsBesidesBullets() - before;
    ++steps_;
    check();
  }
}

void FuzzScene::check() {
  std::size_t attached = 0;
  for (const FuzzBody& fuzz : bodies_) {
    if (!isFinite(*fuzz.body)) throw std::logic_error("a body's state is not finite or too fast");
    if (fluid_.find(*fuzz.body).has_value() != fuzz.is_attached) {
      throw std::logic_error("the fluid does not know who is in it");
    }
    attached += fuzz.is_attached;
    if (fuzz.is_attached && !fluid_.find(*fuzz.body)->inertia().allFinite()) {
      throw std::logic_error("an inertia is not finite");
    }
  }
  if (fluid_.size() < attached) throw std::logic_error("the fluid has lost a body");
  if (!complaint_.empty()) throw std::logic_error("reported: " + complaint_);
  if (allocations_ > kAllocationLimit) throw std::logic_error("steps go on allocating");
}

}  // namespace ambient::test
