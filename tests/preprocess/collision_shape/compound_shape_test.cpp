#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

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
  EXPECT_LT((body.centre_of_volume - toVector3(pose.getOrigin())).norm(), 1e-6);
  EXPECT_EQ(body.origin, Vector3::Zero());
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

using test::translationError;

// A compound that owns its child shapes.
class Pieces {
 public:
  explicit Pieces(std::unique_ptr<btCollisionShape> first) { with(std::move(first), {0, 0, 0}); }
  Pieces& with(std::unique_ptr<btCollisionShape> child, const Vector3& place, double turn = 0) {
    const btQuaternion about_z(btVector3(0, 0, 1), static_cast<btScalar>(turn));
    compound_.addChildShape(btTransform(about_z, toBullet(place)), child.get());
    children_.push_back(std::move(child));
    return *this;
  }
  FluidBody body(int max_panels = 0) const {
    CollisionShapeSettings settings = coarse();
    settings.flow.max_panels = max_panels;
    settings.report = [](const std::string& line) {
      EXPECT_EQ(line.find("cannot be united"), std::string::npos) << line;
    };
    const FluidBody body = makeFluidBody(compound_, settings);
    checkFluidBody(body, "compound");
    return body;
  }

 private:
  btCompoundShape compound_;
  std::vector<std::unique_ptr<btCollisionShape>> children_;
};

std::unique_ptr<btCollisionShape> block(double x, double y, double z) {
  return std::make_unique<btBoxShape>(toBullet(Vector3(x, y, z)));
}

std::unique_ptr<btCollisionShape> bead(double radius) {
  return std::make_unique<btSphereShape>(static_cast<btScalar>(radius));
}

void expectSurface(const FluidBody& body, double volume, double area) {
  const double tolerance = 40 * kScalarRounding + 1e-12;
  EXPECT_NEAR(body.volume / volume, 1, tolerance);
  EXPECT_NEAR(body.area / area, 1, tolerance);
}

// Two boxes with a box as union: its flow, on a different mesh.
TEST(CompoundUnion, BoxesThatMakeABoxAreThatBox) {
  CollisionShapeSettings settings = coarse();
  settings.flow.max_panels = 1200;
  settings.tables = false;
  const FluidBody box = makeFluidBody(*block(1, 0.5, 0.5), settings);
  const FluidBody touching = Pieces(block(0.5, 0.5, 0.5))
                                 .with(block(0.5, 0.5, 0.5), {1, 0, 0})
                                 .body(settings.flow.max_panels);
  expectSurface(touching, 2, 10);
  const FluidBody overlapping = Pieces(block(0.5, 0.5, 0.5))
                                    .with(block(0.75, 0.5, 0.5), {0.75, 0, 0})
                                    .body(settings.flow.max_panels);
  expectSurface(overlapping, 2, 10);
  for (const FluidBody* body : {&touching, &overlapping}) {
    // Both bodies are shifted by half a side: translation entries are unaffected.
    EXPECT_LT(translationError(body->added_mass, box.added_mass), 2e-3);
    EXPECT_NEAR(body->added_mass(0, 0) / box.added_mass(0, 0), 1, 1e-2);
    EXPECT_NEAR(body->centre_of_volume.x(), 0.5, 1e-6);
  }
}

TEST(CompoundUnion, SurfacesAreThoseOfTheUnion) {
  const auto cube = [] { return block(0.5, 0.5, 0.5); };
  const auto small = [] { return block(0.2, 0.2, 0.2); };
  expectSurface(Pieces(cube()).with(small(), {0.1, 0, 0.1}).body(), 1, 6);  // inside
  expectSurface(Pieces(cube()).with(cube(), {0, 0, 0}).body(), 1, 6);
  expectSurface(Pieces(cube()).with(small(), {0.7, 0.1, 0}).body(), 1.064, 6 + 4 * 0.16);
  // Halfway in, flush with an edge; a cross, flush above and below; a frame of four.
  expectSurface(Pieces(cube()).with(small(), {0.5, 0.3, 0}).body(), 1.032, 6 + 4 * 0.08);
  expectSurface(Pieces(block(1, 0.5, 0.5)).with(block(1, 0.5, 0.5), {0, 0, 0}, kPi / 2).body(), 3,
                14);
  expectSurface(Pieces(block(1, 0.1, 0.1))
                    .with(block(1, 0.1, 0.1), {0, 1, 0})
                    .with(block(0.1, 0.6, 0.1), {0.9, 0.5, 0})
                    .with(block(0.1, 0.6, 0.1), {-0.9, 0.5, 0})
                    .body(),
                0.2 * (2 * 1.2 - 1.6 * 0.8), 2 * (2 * 1.2 - 1.6 * 0.8) + 0.2 * (6.4 + 4.8));
}

TEST(CompoundUnion, ObliqueBoxesKeepWhatLiesOutside) {
  const double turn = 0.5, c = std::cos(turn), s = std::sin(turn);
  const FluidBody body = Pieces(block(1, 1, 0.5)).with(block(1, 1, 0.5), {0, 0, 0}, turn).body();
  // Each protruding corner is a right triangle with legs h / c and h / s; its height over the
  // longest side, on the other square, is h = (c + s) - 1.
  const double h = c + s - 1, triangle = h / c * h / s / 2;
  EXPECT_NEAR(body.volume, 4 + 4 * triangle, 1e-5);
}

// Motion along the line of centres, by successive images of dipoles. Their strengths are those of
// the spheres times 1, -1/8, 1/27, ...: the sum is eta(3).
TEST(CompoundUnion, SpheresThatTouchHaveTheAddedMassOfTheirImages) {
  constexpr double kEta3 = 0.9015426773696957;
  CollisionShapeSettings settings = coarse();
  settings.faces = 2000;
  btSphereShape ball(1);
  btCompoundShape pair;
  for (const btScalar x : {btScalar(-1), btScalar(1)}) {
    pair.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0)), &ball);
  }
  const FluidBody body = makeFluidBody(pair, settings);
  EXPECT_NEAR(body.volume / (8 * kPi / 3), 1, 4e-3);
  EXPECT_NEAR(body.added_mass(3, 3) / (4 * kPi / 3 * (3 * kEta3 - 2)), 1, 5e-3);
}

TEST(CompoundUnion, DumbbellsAndChassisJustWork) {
  const FluidBody dumbbell =
      Pieces(std::make_unique<btCylinderShapeX>(toBullet(Vector3(1, 0.1, 0.1))))
          .with(bead(0.5), {-1, 0, 0})
          .with(bead(0.5), {1, 0, 0})
          .body();
  const double rod = kPi * 0.01, ends = 2 * 4 * kPi / 3 * 0.125;
  EXPECT_NEAR(dumbbell.volume, ends + rod, 0.01 * ends);
  Pieces car(block(1, 0.2, 0.5));
  for (const double x : {-0.7, 0.7}) {
    for (const double z : {-0.55, 0.55}) {
      car.with(std::make_unique<btCylinderShapeZ>(toBullet(Vector3(0.2, 0.2, 0.1))), {x, -0.2, z});
    }
  }
  const FluidBody chassis = car.body();
  // Wheels: half above the lower side of the chassis, a quarter of their width inside.
  const double wheel = kPi * 0.04 * 0.2;
  EXPECT_NEAR(chassis.volume, 0.8 + 4 * wheel * (1 - 0.25 / 2), 0.02);
}

TEST(CompoundUnion, EdgesCornersAndNarrowGapsAreClosed) {
  for (const Vector3& place : {Vector3(1, 1, 0), Vector3(1, 1, 1), Vector3(1.0005, 0, 0)}) {
    const FluidBody body = Pieces(block(0.5, 0.5, 0.5)).with(block(0.5, 0.5, 0.5), place).body();
    EXPECT_NEAR(body.volume, 2, 2 * 4e-3);  // each enlarged by 0.12 % at most
  }
}

// Union of an L and the box that completes it.
TEST(CompoundUnion, MeshesAreUnitedToo) {
  const std::vector<Eigen::Vector2d> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  btTriangleMesh triangles;
  const auto corner = [&](std::size_t i, double z) {
    return toBullet(Vector3(outline[i % 6].x(), outline[i % 6].y(), z));
  };
  for (std::size_t i = 0; i < 6; ++i) {
    triangles.addTriangle(corner(i, 0), corner(i + 1, 0), corner(i + 1, 1));
    triangles.addTriangle(corner(i, 0), corner(i + 1, 1), corner(i, 1));
  }
  for (const auto& [a, b, c] :
       {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    triangles.addTriangle(corner(a, 1), corner(b, 1), corner(c, 1));
    triangles.addTriangle(corner(a, 0), corner(c, 0), corner(b, 0));
  }
  auto mesh = std::make_unique<btGImpactMeshShape>(&triangles);
  mesh->setMargin(0);
  mesh->updateBound();
  EXPECT_NEAR(makeFluidBody(*mesh, coarse()).volume, 3, 1e-5);
  const FluidBody body = Pieces(std::move(mesh)).with(block(0.5, 0.5, 0.5), {1.5, 1.5, 0.5}).body();
  expectSurface(body, 4, 16);
}

}  // namespace
}  // namespace ambient
