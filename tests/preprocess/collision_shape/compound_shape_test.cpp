#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using test::coarse;
using test::differenceOf;
using test::kScalarRounding;

btTransform somewhere() {
  return btTransform(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)),
                     btVector3(btScalar(0.3), btScalar(-0.4), btScalar(0.5)));
}

Matrix6 transformed(const Matrix6& K, const btTransform& pose) {
  const Matrix3 R = toQuaternion(pose.getRotation()).toRotationMatrix();
  return shiftOrigin(rotateAxes(K, R), -toVector3(pose.getOrigin()));
}

btTransform at(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(), toBullet(Vector3(x, y, z)));
}

TEST(CompoundShape, OneChildIsTheChildInItsPlace) {
  btCapsuleShape capsule(btScalar(0.3), btScalar(1.2));
  btCompoundShape compound;
  compound.addChildShape(somewhere(), &capsule);
  const FluidBody child = makeFluidBody(capsule, coarse());
  const FluidBody body = makeFluidBody(compound, coarse());
  // On its own axes the capsule's planes of symmetry are found, and forbidden entries, 1e-9, are
  // removed. About an oblique axis the search does not find these planes.
  const double tolerance = 20 * kScalarRounding + 5e-9;
  EXPECT_LT(differenceOf(body.added_mass, transformed(child.added_mass, somewhere())), tolerance);
  EXPECT_LT((body.centre_of_volume - toVector3(somewhere().getOrigin())).norm(), 1e-6);
  EXPECT_EQ(body.origin, Vector3::Zero());
}

TEST(CompoundShape, OneSphereKeepsTheClosedForm) {
  btSphereShape ball(1);
  btCompoundShape compound;
  compound.addChildShape(at(1, 2, 3), &ball);
  Matrix6 K = Matrix6::Zero();
  K.bottomRightCorner<3, 3>().diagonal().setConstant(2 * kPi / 3);
  EXPECT_LT(differenceOf(makeFluidBody(compound).added_mass, shiftOrigin(K, Vector3(-1, -2, -3))),
            1e-12);
}

TEST(CompoundShape, NestedTransformsMultiply) {
  btBoxShape box(btVector3(btScalar(0.2), btScalar(0.4), btScalar(0.6)));
  btCompoundShape inner, outer;
  inner.addChildShape(at(0, 1, 0), &box);
  outer.addChildShape(somewhere(), &inner);
  const FluidBody body = makeFluidBody(outer, coarse());
  const btTransform pose = somewhere() * at(0, 1, 0);
  const FluidBody child = makeFluidBody(box, coarse());
  EXPECT_LT(differenceOf(body.added_mass, transformed(child.added_mass, pose)),
            20 * kScalarRounding + 1e-10);
}

TEST(CompoundShape, FarAwayChildrenAddUp) {
  btSphereShape ball(1);
  btCompoundShape compound;
  compound.addChildShape(at(-10, 0, 0), &ball);
  compound.addChildShape(at(10, 0, 0), &ball);
  const FluidBody body = makeFluidBody(compound, coarse());
  const double volume = 8 * kPi / 3;
  EXPECT_NEAR(body.volume / volume, 1, 1e-12);
  // Dipole interaction: 1 - 3 (R/d)^3 along the line of centres, 1 + 3/2 (R/d)^3 across.
  const double dipole = std::pow(1.0 / 20, 3);
  EXPECT_NEAR(body.added_mass(3, 3) / (volume / 2), 1 - 3 * dipole, 3e-4);
  EXPECT_NEAR(body.added_mass(4, 4) / (volume / 2), 1 + 1.5 * dipole, 3e-4);
  EXPECT_NEAR(body.added_mass(2, 2) / (100 * volume / 2), 1, 2e-3);
  checkFluidBody(body, "dumbbell");
}

// Interaction at a distance of ten sizes: (1/20)^3 of the added mass from each neighbour.
TEST(CompoundShape, ManyChildrenApartShareFaces) {
  btBoxShape box(btVector3(btScalar(0.5), btScalar(0.4), btScalar(0.3)));
  btCompoundShape compound;
  for (int i = 0; i < 64; ++i)
    compound.addChildShape(at(10 * (i % 4), 10 * (i / 4 % 4), 10 * (i / 16)), &box);
  CollisionShapeSettings settings;
  settings.load_error = 0;
  const FluidBody body = makeFluidBody(compound, settings);
  EXPECT_LE(body.faces.size(), 7800u);
  const Matrix6 alone = makeFluidBody(box, settings).added_mass;
  for (int k = 3; k < 6; ++k) EXPECT_NEAR(body.added_mass(k, k) / (64 * alone(k, k)), 1, 3e-3) << k;
  checkFluidBody(body, "swarm");
}

// Close bodies interact by dipoles, even with few faces each. Three rows of balls must agree with
// one row, which is solved on all its faces.
TEST(CompoundShape, ManyChildrenApartFeelEachOther) {
  btSphereShape ball(1);
  btCompoundShape few, many;
  for (int i = 0; i < 8; ++i) few.addChildShape(at(2.5 * i, 0, 0), &ball);
  for (int i = 0; i < 24; ++i) many.addChildShape(at(2.5 * (i % 8), 200 * (i / 8), 0), &ball);
  CollisionShapeSettings settings;
  settings.load_error = 0;
  const Matrix6 row = makeFluidBody(few, settings).added_mass;
  const Matrix6 rows = makeFluidBody(many, settings).added_mass;
  const double alone = 8 * 2 * kPi / 3;
  EXPECT_LT(row(3, 3) / alone, 0.8);  // sheltered by neighbours
  EXPECT_GT(row(4, 4) / alone, 1.05);
  for (int k = 3; k < 6; ++k) EXPECT_NEAR(rows(k, k) / (3 * row(k, k)), 1, 1e-2) << k;
}

TEST(CompoundShape, LocalScalingMovesAndScalesChildren) {
  btBoxShape box(btVector3(1, 1, 1));
  btCompoundShape compound;
  compound.addChildShape(at(2, 0, 0), &box);
  compound.setLocalScaling(btVector3(2, 2, 2));
  const FluidBody body = makeFluidBody(compound, coarse());
  EXPECT_NEAR(body.volume / 64, 1, 10 * kScalarRounding);
  EXPECT_NEAR(body.centre_of_volume.x(), 4, 1e-5);
}

TEST(CompoundShape, BadChildrenAreNamed) {
  btBoxShape box(btVector3(1, 1, 1));
  btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
  btCompoundShape inner, outer;
  inner.addChildShape(at(5, 0, 0), &plane);
  outer.addChildShape(at(0, 0, 0), &box);
  outer.addChildShape(at(0, 0, 0), &inner);
  CollisionShapeSettings settings = coarse();
  settings.name = "crane";
  EXPECT_EQ(
      messageOf([&] { makeFluidBody(outer, settings); }),
      "crane: child 1: child 0: a plane (STATICPLANE) is unbounded and cannot move in a fluid");
}

/// Spin about the common axis moves no water: no part has any of it, nor couples it to another
/// motion, or the body would yaw in waves.
TEST(CompoundShape, OfCoaxialCylindersHasNoSpinInItsParts) {
  btCylinderShapeZ spar(btVector3(btScalar(0.3), btScalar(0.3), 1)),
      plate(btVector3(1, 1, btScalar(0.1)));
  btCompoundShape buoy;
  buoy.addChildShape(at(0, 0, 0), &spar);
  buoy.addChildShape(at(0, 0, -1), &plate);
  CollisionShapeSettings settings = coarse();
  settings.faces = 1000;
  const FluidBody body = makeFluidBody(buoy, settings);
  ASSERT_FALSE(body.added_mass_parts.empty());
  const double largest = body.added_mass.cwiseAbs().maxCoeff();
  for (const AddedMassPart& part : body.added_mass_parts.all())
    EXPECT_LT(part.inertia.row(2).cwiseAbs().maxCoeff(), 1e-6 * largest);
}

}  // namespace
}  // namespace ambient
