#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/reduced_loads/levels_by_rule.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

FluidBody boxOf(const Vector3& half_sizes) {
  const auto scalar = [&](int i) { return static_cast<btScalar>(half_sizes[i]); };
  return makeFluidBody(btBoxShape(btVector3(scalar(0), scalar(1), scalar(2))),
                       CollisionShapeSettings());
}

/// Error of the level's loads that one motion in a hundred exceeds, relative to the scale of
/// FormLevel.
double errorOf(const FluidBody& body, const FormLevel& level) {
  const ShapeFactors shape(formShapeOf(body));
  const FaceTable all = formLawFaces(body, shape.shape);
  double moment = 0;
  const Vector3& middle = body.centre_of_volume;
  for (std::size_t i = 0; i < all.size(); ++i)
    moment += all.area[i] * (all.centroid(i) - middle).squaredNorm();
  const double length = std::sqrt(moment / body.area);
  test::Arbitrary arbitrary(3);
  std::vector<double> errors;
  for (int i = 0; i < 400; ++i) {
    const double angle = arbitrary.between(0, std::acos(0.0));
    const Vector3 w = std::sin(angle) / length * arbitrary.vector().normalized(),
                  v = std::cos(angle) * arbitrary.vector().normalized();
    const Twist x{w, v - w.cross(middle)};  // v is that of the middle
    const LoadSettings settings{1, 1e-3, 0, true, PressureLaw::kForm, &shape};
    Vector6 error = computeFaceLoads(level.faces, 1, x, settings).total().vector() -
                    computeFaceLoads(all, 1, x, settings).total().vector();
    error.head<3>() -= middle.cross(Vector3(error.tail<3>()));
    error.head<3>() /= length;
    double scale = 0;
    for (std::size_t face = 0; face < all.size(); ++face)
      scale += 0.5 * all.area[face] * x.at(all.centroid(face)).squaredNorm();
    errors.push_back(error.norm() / scale);
  }
  std::sort(errors.begin(), errors.end());
  return errors[396];
}

TEST(BoxLevel, IsWithinItsErrorForAnySides) {
  test::Arbitrary arbitrary(5);
  double mean = 0;
  for (int i = 0; i < 40; ++i) {
    const auto side = [&] { return std::pow(10, arbitrary.between(-1.7, 0)); };
    const FluidBody body = boxOf(i == 0 ? Vector3(1, 1, 1) : Vector3(1, side(), side()));
    ASSERT_EQ(body.form_levels.size(), 1u);
    EXPECT_LE(body.form_levels[0].faces.size(), 96u);
    EXPECT_EQ(body.form_levels[0].p99_error, kRuleError);
    const double error = errorOf(body, body.form_levels[0]);
    EXPECT_LT(error, kRuleError) << extentsOf(body).transpose();
    mean += error / 40;
  }
  EXPECT_LT(mean, 0.3 * kRuleError);
}

TEST(BoxLevel, OfACubeHasFewerFacesThanAFit) {
  EXPECT_EQ(boxOf({1, 1, 1}).form_levels[0].faces.size(), 54u);
}

TEST(BoxLevel, FollowsATurnedBox) {
  btBoxShape box(btVector3(1, btScalar(0.4), btScalar(0.1)));
  btCompoundShape turned;
  const btTransform pose(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)),
                         btVector3(1, 0, -2));
  turned.addChildShape(pose, &box);
  const FluidBody body = makeFluidBody(turned, CollisionShapeSettings());
  EXPECT_LT(errorOf(body, body.form_levels[0]), kRuleError);
}

/// Expects the rule's error to be kept by shapes whose height is 1/50 to 50 times their width.
template <class MakeShape>
void expectRule(const MakeShape& make, std::size_t most_faces) {
  test::Arbitrary arbitrary(6);
  CollisionShapeSettings fine;
  fine.faces = 4000;
  for (int i = 0; i < 14; ++i) {
    const double ratio = i < 2 ? std::pow(50, 2 * i - 1) : std::pow(50, arbitrary.between(-1, 1));
    const FluidBody body = makeFluidBody(make(ratio), fine);
    ASSERT_EQ(body.form_levels.size(), 1u);
    EXPECT_LE(body.form_levels[0].faces.size(), most_faces);
    EXPECT_LT(errorOf(body, body.form_levels[0]), kRuleError) << ratio;
  }
}

TEST(RoundLevel, OfACylinderIsWithinItsError) {
  expectRule(
      [](double ratio) {
        return btCylinderShapeZ(btVector3(btScalar(0.5), btScalar(0.5), btScalar(ratio / 2)));
      },
      80);
}

TEST(RoundLevel, OfACapsuleIsWithinItsError) {
  expectRule([](double ratio) { return btCapsuleShapeZ(btScalar(0.5), btScalar(ratio)); }, 60);
}

TEST(RoundLevel, OfAConeIsWithinItsError) {
  expectRule([](double ratio) { return btConeShapeZ(btScalar(0.5), btScalar(ratio)); }, 70);
}

TEST(RoundLevel, FollowsATurnedCylinder) {
  btCylinderShape along_y(btVector3(btScalar(0.2), 1, btScalar(0.2)));
  CollisionShapeSettings fine;
  fine.faces = 4000;
  const FluidBody body = makeFluidBody(along_y, fine);
  EXPECT_LT(errorOf(body, body.form_levels[0]), kRuleError);
}

/// Bytes that a box keeps: what a world of boxes that all differ costs.
TEST(BoxLevel, ABoxHasFewTriangles) {
  const FluidBody body = boxOf({0.5, 0.4, 0.3});
  EXPECT_LE(body.faces.size(), 400u);
  CollisionShapeSettings more;
  more.faces = 1300;
  EXPECT_GE(makeFluidBody(btBoxShape(btVector3(1, 1, 1)), more).faces.size(), 1000u);
}

}  // namespace
}  // namespace ambient
