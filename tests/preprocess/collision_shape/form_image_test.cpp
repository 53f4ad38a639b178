#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "preprocess/collision_shape/shape_form.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"

namespace ambient {
namespace {

using test::coarse;
using test::differenceOf;

/// A hull without symmetries, turned along axes by signs, its points in another order.
std::unique_ptr<btConvexHullShape> skewHull(const Vector3& signs) {
  std::vector<Vector3> points{
      {0.1, 0, 0.2}, {1, 0.1, 0}, {0.2, 0.7, 0}, {0, 0.2, 0.5}, {0.8, 0.3, 0.4}};
  if (signs.prod() < 0) std::swap(points[0], points[3]);
  if (signs.sum() < 1) std::swap(points[1], points[2]);
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vector3& point : points) hull->addPoint(toBullet(signs.cwiseProduct(point)), false);
  return hull;
}

/// An arm of a box and two capsules, and its image.
class Arm {
 public:
  explicit Arm(const Vector3& signs) : signs_(signs) {
    add({0, 0, 1}, {0, 0, 0}, box_);
    add({0.6, 0.8, 0}, {0.2, 0.3, 0.05}, upper_);
    add({0.36, 0.48, 0.8}, {0.5, 0.6, 0.3}, lower_);
  }

  btCompoundShape shape;

 private:
  /// Turns z to an axis, which an image has the other way round on a right-handed frame.
  void add(const Vector3& axis, const Vector3& place, btCollisionShape& part) {
    const Vector3 z = signs_.prod() * signs_.cwiseProduct(axis);
    const btVector3 turn = btVector3(0, 0, 1).cross(toBullet(z));
    const btScalar angle = btAcos(btScalar(z.z()));
    const btQuaternion rotation =
        turn.length() > 0 ? btQuaternion(turn.normalized(), angle) : btQuaternion::getIdentity();
    shape.addChildShape(btTransform(rotation, toBullet(signs_.cwiseProduct(place))), &part);
  }

  const Vector3 signs_;
  btBoxShape box_{btVector3(btScalar(0.2), btScalar(0.1), btScalar(0.15))};
  btCapsuleShapeZ upper_{btScalar(0.1), btScalar(0.5)}, lower_{btScalar(0.08), btScalar(0.4)};
};

const std::vector<Vector3> kSigns{{1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}};

Matrix6 imageOf(const Matrix6& inertia, const Vector3& signs) {
  Vector6 both;
  both << signs.prod() * signs, signs;
  return both.asDiagonal() * inertia * both.asDiagonal();
}

/// Wrench of the form law on a body in oil that moves at once along and about skew axes.
Wrench loadOn(const std::shared_ptr<const FluidBody>& body, const Vector3& signs) {
  const Vector3 spin(0.3, -0.7, 0.4), velocity(0.9, 0.2, -0.5);
  const Twist motion{signs.prod() * signs.cwiseProduct(spin), signs.cwiseProduct(velocity)};
  return makeSurfaceLoads(body, {900, 0.1, {}, {}}, FlowSettings())->load(motion);
}

/// Layers leave an image that moves one way as they leave the shape that moves the image of that.
void expectImage(const Separation& image, const Separation& separation, const Vector3& signs) {
  EXPECT_NEAR(image.axes.determinant(), 1, 1e-12);
  for (int way = 0; way < 6; ++way) {
    const int axis = way / 2;
    const double along =
        (way % 2 == 0 ? 1 : -1) *
        signs.cwiseProduct(image.axes.col(axis)).dot(Vector3(separation.axes.col(axis)));
    EXPECT_NEAR(std::abs(along), 1, 1e-12);
    const SeparationWay &found = image.ways[static_cast<std::size_t>(way)],
                        &way_of_shape =
                            separation
                                .ways[static_cast<std::size_t>(2 * axis + (along > 0 ? 0 : 1))];
    EXPECT_EQ(found.wake_turbulent, way_of_shape.wake_turbulent);
    EXPECT_EQ(found.thickness, way_of_shape.thickness);
  }
}

void expectImage(FluidBodyCache& cache, const btCollisionShape& shape,
                 const btCollisionShape& image, const Vector3& signs) {
  const auto body = cache.fluidBody(shape), turned = cache.fluidBody(image);
  EXPECT_EQ(cache.counts().made, 1);
  EXPECT_NE(body->name, turned->name);
  EXPECT_EQ(turned->added_mass, imageOf(body->added_mass, signs));
  EXPECT_EQ(turned->viscous.resistance, imageOf(body->viscous.resistance, signs));
  EXPECT_EQ(turned->volume, body->volume);
  EXPECT_EQ(turned->centre_of_volume, body->centre_of_volume.cwiseProduct(signs));
  EXPECT_EQ(turned->uniform_mass.inertia,
            Matrix3(signs.asDiagonal() * body->uniform_mass.inertia * signs.asDiagonal()));
  expectImage(turned->viscous.separation, body->viscous.separation, signs);
  const double volume = computeMassProperties(meshOf(turned->surface)).volume;
  EXPECT_NEAR(volume, turned->volume, 1e-6 * volume);  // its triangles are not inside out
  EXPECT_LT(
      differenceOf(turned->added_mass_parts.sum(), imageOf(body->added_mass_parts.sum(), signs)),
      1e-6);
  const Wrench load = loadOn(body, Vector3::Ones()), of_image = loadOn(turned, signs);
  const Vector3 torque = signs.prod() * signs.cwiseProduct(load.torque),
                force = signs.cwiseProduct(load.force);
  EXPECT_LT((of_image.force - force).norm(), 2e-6 * force.norm());  // summed in another order
  EXPECT_LT((of_image.torque - torque).norm(), 2e-6 * torque.norm());
  EXPECT_EQ(decodeFluidBody(encodeFluidBody(*turned, ""), "").volume, turned->volume);
}

TEST(FormImage, OfAHullIsItsExactMirrorImage) {
  for (const Vector3& signs : kSigns) {
    FluidBodyCache cache(coarse());
    expectImage(cache, *skewHull({1, 1, 1}), *skewHull(signs), signs);
  }
}

TEST(FormImage, OfACompoundIsItsExactMirrorImage) {
  for (const Vector3& signs : kSigns) {
    FluidBodyCache cache(coarse());
    expectImage(cache, Arm({1, 1, 1}).shape, Arm(signs).shape, signs);
  }
}

TEST(FormImage, IsTheSameWhicheverComesFirst) {
  for (const Vector3& signs : kSigns) {
    FluidBodyCache forwards(coarse()), backwards(coarse());
    const auto left = skewHull({1, 1, 1}), right = skewHull(signs);
    forwards.fluidBody(*left);
    backwards.fluidBody(*right);
    for (const auto* hull : {left.get(), right.get()})
      EXPECT_EQ(encodeFluidBody(*forwards.fluidBody(*hull), ""),
                encodeFluidBody(*backwards.fluidBody(*hull), ""));
  }
}

TEST(FormImage, IsThatOfItsOwnFlow) {
  const Vector3 signs(1, -1, 1);
  const auto hull = skewHull(signs);
  FluidBodyCache cache;
  const auto found = cache.fluidBody(*hull);
  const FluidBody own = makeFluidBody(*hull);
  EXPECT_NEAR(found->volume, own.volume, 1e-6 * own.volume);
  EXPECT_LT(differenceOf(found->added_mass, own.added_mass), 0.005);
  EXPECT_LT(differenceOf(found->viscous.resistance, own.viscous.resistance), 0.005);
}

TEST(FormImage, OfSymmetricFormsAndOfTrianglesIsTheFormItself) {
  ShapeForm form{"Convex", {}, 1};
  PlacedShape part{Hull{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 1}}}};
  form.parts = {part};
  EXPECT_EQ(firstImage(form).turned & 3, 0);
  form.parts = {{TriangleSoup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}}};
  EXPECT_EQ(firstImage(form).turned, 0);
  EXPECT_EQ(contentOf(firstImage(form).form.parts), contentOf(form.parts));
}

}  // namespace
}  // namespace ambient
