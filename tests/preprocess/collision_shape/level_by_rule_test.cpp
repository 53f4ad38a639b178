#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/reduced_loads/form_levels.h"
#include "tests/preprocess/collision_shape/shape_fixtures.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

FluidBody boxOf(const Vector3& half_sizes) {
  const auto scalar = [&](int i) { return static_cast<btScalar>(half_sizes[i]); };
  return makeFluidBody(btBoxShape(btVector3(scalar(0), scalar(1), scalar(2))),
                       CollisionShapeSettings());
}

/// Error of the loads on few faces that one motion in a hundred exceeds, relative to the scale of
/// FormLevel. `is_cut`: by planes through the body, of which half are next to across its axes.
double errorOf(const FluidBody& body, const FaceTable& few, bool is_cut = false) {
  const ShapeFactors shape(formShapeOf(body));
  const FaceTable all = formLawFaces(body, shape.shape);
  double moment = 0;
  const Vector3& middle = body.centre_of_volume;
  for (std::size_t i = 0; i < all.size(); ++i)
    moment += all.area[i] * (all.centroid(i) - middle).squaredNorm();
  const double length = std::sqrt(moment / body.area);
  const PackedHull hull(body);
  test::Arbitrary arbitrary(3);
  std::vector<double> errors;
  for (int i = 0; i < 400; ++i) {
    const double angle = arbitrary.between(0, std::acos(0.0));
    const Vector3 w = std::sin(angle) / length * arbitrary.vector().normalized(),
                  v = std::cos(angle) * arbitrary.vector().normalized();
    const Twist x{w, v - w.cross(middle)};  // v is that of the middle
    const LoadSettings settings{1, 1e-3, 0, true, PressureLaw::kForm, &shape};
    SurfacePlane plane;
    if (is_cut) {
      plane.normal = arbitrary.vector();
      if (i % 2 == 0) plane.normal = 0.02 * plane.normal + Vector3::Unit(i / 2 % 3);
      plane.normal.normalize();
      const auto [low, high] = computeExtent(hull, plane.normal);
      plane.height = arbitrary.between(low, high);
    }
    const auto loadOn = [&](const FaceTable& faces) {
      return computeFaceLoads(faces, 1, x, settings, is_cut ? &plane : nullptr).total().vector();
    };
    Vector6 error = loadOn(few) - loadOn(all);
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

TEST(BoxFaces, AreWithinTheirErrorForAnySides) {
  test::Arbitrary arbitrary(5);
  double mean = 0;
  for (int i = 0; i < 40; ++i) {
    const auto side = [&] { return std::pow(10, arbitrary.between(-1.7, 0)); };
    const Vector3 half_sizes = i == 0 ? Vector3(1, 1, 1) : Vector3(1, side(), side());
    const FluidBody body = boxOf(half_sizes);
    EXPECT_LE(body.form.faces.size(), 96u);
    EXPECT_TRUE(body.form_levels.empty());
    const double error = errorOf(body, body.form.faces);
    EXPECT_LT(error, kRuleError) << half_sizes.transpose();
    const double of_cut = errorOf(body, body.form.faces, true);
    EXPECT_LT(of_cut, half_sizes.minCoeff() > 0.2 ? 0.02 : 0.05) << half_sizes.transpose();
    mean += error / 40;
  }
  EXPECT_LT(mean, 0.3 * kRuleError);
}

TEST(BoxFaces, OfACubeAreFewerThanAFit) { EXPECT_EQ(boxOf({1, 1, 1}).form.faces.size(), 54u); }

TEST(BoxFaces, FollowATurnedBox) {
  btBoxShape box(btVector3(1, btScalar(0.4), btScalar(0.1)));
  btCompoundShape turned;
  const btTransform pose(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(0.7)),
                         btVector3(1, 0, -2));
  turned.addChildShape(pose, &box);
  const FluidBody body = makeFluidBody(turned, CollisionShapeSettings());
  EXPECT_LT(errorOf(body, body.form.faces), kRuleError);
}

/// Expects the rule's error to be kept by shapes whose height is 1/50 to 50 times their width. What
/// is measured where a surface cuts them: 0.5 to 1.6 % at ratios up to two, 0.5 to 4.6 % beyond.
template <class MakeShape>
void expectRule(const MakeShape& make, std::size_t most_faces) {
  test::Arbitrary arbitrary(6);
  CollisionShapeSettings fine;
  fine.faces = 4000;
  for (int i = 0; i < 14; ++i) {
    const double ratio = i < 2 ? std::pow(50, 2 * i - 1) : std::pow(50, arbitrary.between(-1, 1));
    const FluidBody body = makeFluidBody(make(ratio), fine);
    const bool is_compact = ratio > 0.5 && ratio < 2;
    EXPECT_TRUE(body.form_levels.empty());
    EXPECT_LE(body.form.faces.size(), is_compact ? 156u : most_faces);
    EXPECT_LT(errorOf(body, body.form.faces), kRuleError) << ratio;
    EXPECT_LT(errorOf(body, body.form.faces, true), is_compact ? 0.02 : 0.05) << ratio;
  }
}

TEST(RoundFaces, OfACylinderAreWithinTheirError) {
  expectRule(
      [](double ratio) {
        return btCylinderShapeZ(btVector3(btScalar(0.5), btScalar(0.5), btScalar(ratio / 2)));
      },
      288);
}

TEST(RoundFaces, OfACapsuleAreWithinTheirError) {
  expectRule([](double ratio) { return btCapsuleShapeZ(btScalar(0.5), btScalar(ratio)); }, 208);
}

TEST(RoundFaces, OfAConeAreWithinTheirError) {
  expectRule([](double ratio) { return btConeShapeZ(btScalar(0.5), btScalar(ratio)); }, 336);
}

TEST(RoundFaces, FollowATurnedCylinder) {
  btCylinderShape along_y(btVector3(btScalar(0.2), 1, btScalar(0.2)));
  CollisionShapeSettings fine;
  fine.faces = 4000;
  const FluidBody body = makeFluidBody(along_y, fine);
  EXPECT_LT(errorOf(body, body.form.faces), kRuleError);
}

/// Bytes that a box keeps: what a world of boxes that all differ costs.
TEST(BoxFaces, ABoxHasFewTriangles) {
  const FluidBody body = boxOf({0.5, 0.4, 0.3});
  EXPECT_LE(body.faces.size(), 400u);
  CollisionShapeSettings more;
  more.faces = 1300;
  EXPECT_GE(makeFluidBody(btBoxShape(btVector3(1, 1, 1)), more).faces.size(), 1000u);
}

}  // namespace
}  // namespace ambient
