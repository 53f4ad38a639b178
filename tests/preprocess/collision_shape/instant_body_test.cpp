#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"

namespace ambient {
namespace {

using test::rotationError;
using test::translationError;

CollisionShapeSettings instant() {
  CollisionShapeSettings settings = test::coarse();
  settings.quality = Quality::kInstant;
  settings.report = nullptr;
  return settings;
}

std::unique_ptr<btConvexHullShape> pebble() {
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < 24; ++i) {
    const auto a = static_cast<btScalar>(2.4 * i), z = static_cast<btScalar>(i / 12.0 - 1);
    hull->addPoint(btVector3(std::cos(a), btScalar(0.7) * std::sin(a), btScalar(0.5) * z));
  }
  hull->setMargin(0);
  return hull;
}

TEST(InstantBody, IsABodyWithTheShapesVolumeAndAGuess) {
  const auto hull = pebble();
  const FluidBody guess = makeFluidBody(*hull, instant());
  const FluidBody solved = makeFluidBody(*hull, test::coarse());
  checkFluidBody(guess, "pebble");
  EXPECT_NEAR(guess.volume / solved.volume, 1, 1e-6);
  EXPECT_LE(guess.faces.size(), 2u * kInstantFaces);
  EXPECT_LT(translationError(guess.added_mass, solved.added_mass), 0.25);
  EXPECT_LT(rotationError(guess.added_mass, solved.added_mass), 0.5);
}

TEST(InstantBody, OfASphereIsExact) {
  btSphereShape ball(1);
  const FluidBody guess = makeFluidBody(ball, instant());
  EXPECT_EQ(guess.added_mass, makeFluidBody(ball, test::coarse()).added_mass);
  EXPECT_EQ(guess.sphere_radius, 1);
}

TEST(InstantBody, OfADumbbellIsNearItsParts) {
  btSphereShape ball(btScalar(0.5));
  btCylinderShapeX rod(btVector3(1, btScalar(0.1), btScalar(0.1)));
  btCompoundShape dumbbell;
  for (const btScalar x : {btScalar(-1), btScalar(1)}) {
    dumbbell.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0)), &ball);
  }
  dumbbell.addChildShape(btTransform::getIdentity(), &rod);
  const FluidBody guess = makeFluidBody(dumbbell, instant());
  const FluidBody solved = makeFluidBody(dumbbell, test::coarse());
  EXPECT_LT(translationError(guess.added_mass, solved.added_mass), 0.25);
  EXPECT_LT(rotationError(guess.added_mass, solved.added_mass), 0.25);
}

// Children share the number of faces: a union takes time with the product of their faces.
TEST(InstantBody, OfManyChildrenHasNoMoreFaces) {
  btSphereShape ball(btScalar(0.3));
  btCompoundShape beads;
  for (int i = 0; i < 5; ++i) {
    beads.addChildShape(
        btTransform(btQuaternion::getIdentity(), btVector3(btScalar(0.4 * i), 0, 0)), &ball);
  }
  EXPECT_LE(makeFluidBody(beads, instant()).faces.size(), 2u * kInstantFaces);
}

TEST(InstantBody, OfSlenderChildrenHasAsManyFacesAsTheyNeed) {
  btCylinderShapeX rod(btVector3(4, btScalar(0.05), btScalar(0.05)));
  btCapsuleShape mast(btScalar(0.05), 4);
  btConeShapeZ spike(btScalar(0.05), 4);
  btCompoundShape cross;
  for (btCollisionShape* arm :
       {static_cast<btCollisionShape*>(&rod), static_cast<btCollisionShape*>(&mast),
        static_cast<btCollisionShape*>(&spike)}) {
    arm->setMargin(0);
    cross.addChildShape(btTransform::getIdentity(), arm);
  }
  const double rods = kPi * 0.0025 * 8, masts = kPi * 0.0025 * 4, spikes = masts / 3;
  const FluidBody guess = makeFluidBody(cross, instant());
  EXPECT_NEAR(guess.volume, rods + masts + spikes, 0.1 * rods);
}

TEST(InstantCache, GoesOnToTheSolutionAndTells) {
  FluidBodyCache cache(instant(), {}, FluidBodyCache::Replacement::kWhenAsked);
  FluidBodyCache standard(test::coarse());
  const auto hull = pebble();
  const unsigned before = cache.revision();
  const auto guess = cache.fluidBody(*hull);
  EXPECT_EQ(cache.fluidBody(*hull), guess);
  cache.finish();
  EXPECT_NE(cache.revision(), before);
  const auto solved = cache.fluidBody(*hull);
  EXPECT_EQ(encodeFluidBody(*solved, ""), encodeFluidBody(*standard.fluidBody(*hull), ""));
  EXPECT_EQ(cache.counts().instant, 1);
  EXPECT_EQ(cache.counts().made, 1);
  const unsigned after = cache.revision();
  cache.finish();
  EXPECT_EQ(cache.revision(), after) << "nothing new";
}

TEST(InstantCache, TellsByItselfWhenItIsReady) {
  FluidBodyCache cache(instant());
  const auto hull = pebble();
  const unsigned before = cache.revision();
  cache.fluidBody(*hull);
  const auto start = std::chrono::steady_clock::now();
  while (cache.revision() == before &&
         std::chrono::steady_clock::now() - start < std::chrono::seconds(60)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(cache.fluidBody(*hull)->provenance.settings.find("instant"), std::string::npos);
}

TEST(InstantCache, MayBeDestroyedWhileItWorks) {
  FluidBodyCache cache(instant());
  for (const double x : {0.5, 0.6, 0.7, 0.8}) {
    cache.fluidBody(btBoxShape(toBullet(Vector3(x, 1, 1))));
  }
}

// Body in a world keeps the guess until the cache has finished and one more substep has passed.
TEST(InstantCache, WorldsGetTheSolutionBetweenTwoSteps) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  const auto hull = pebble();
  btRigidBody body(3000, nullptr, hull.get(), btVector3(1000, 1000, 1000));
  FluidBodyCache cache(instant(), {}, FluidBodyCache::Replacement::kWhenAsked);
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, nullptr, &configuration);
  Fluid fluid(world);
  world.addRigidBody(&body);
  EXPECT_EQ(fluid.addAll(cache, water()).attached, 1);
  const auto step = [&] { world.stepSimulation(btScalar(1) / 60, 0, btScalar(1) / 60); };
  const Matrix6 guessed = fluid.find(body)->inertia();
  for (int i = 0; i < 5; ++i) step();
  EXPECT_EQ(fluid.find(body)->inertia(), guessed);
  cache.finish();
  step();
  const Matrix6 wet = 998 * cache.fluidBody(*hull)->added_mass;
  EXPECT_NE(fluid.find(body)->inertia(), guessed);
  EXPECT_NEAR(fluid.find(body)->inertia()(3, 3), 3000 + wet(3, 3), 1e-3);
  world.removeRigidBody(&body);
}

}  // namespace
}  // namespace ambient
