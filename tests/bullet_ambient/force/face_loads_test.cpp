#include "bullet_ambient/force/loads/face_loads.h"

#include <gtest/gtest.h>

#include <limits>
#include <new>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "tests/reference/loads/face_by_face_loads.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

TEST(SeparationCosine, IsExactlyZeroAtARightAngle) {
  EXPECT_EQ(separationCosine(kPi / 2), 0);
  EXPECT_EQ(separationCosine(1.5707963267948966), 0);
  EXPECT_EQ(separationCosine(std::nextafter(kPi / 2, 2)), 0);
}

TEST(SeparationCosine, IsTheCosineElsewhere) {
  for (const double angle : {kPi / 2 + 1e-9, 1.7, 2.0, 3.0, kPi})
    EXPECT_EQ(separationCosine(angle), std::cos(angle)) << angle;
  EXPECT_EQ(separationCosine(kPi), -1);
}

TEST(FaceLoads, AreTheSumOfTheModelFaceByFace) {
  test::Arbitrary arbitrary(41);
  for (int i = 0; i < 200; ++i) {
    FaceTable body = arbitrary.body(1);
    for (int face = 0; face < i % 10; ++face) body.add({0, 0, 1}, arbitrary.vector(), 0.1);
    const Twist x = arbitrary.twist(2, 3);
    const double alpha = i % 4 == 0 ? kPi / 2 : arbitrary.between(kPi / 2, kPi);
    const LoadSettings settings{arbitrary.between(1, 1000), arbitrary.between(1e-5, 1e-2),
                                separationCosine(alpha), true};
    const double length = test::referenceLength(body);
    Vector6 pressure = Vector6::Zero();
    Vector6 friction = Vector6::Zero();
    for (std::size_t k = 0; k < body.size(); ++k) {
      reference::FaceInFlow face{body.normal(k), body.centroid(k), body.area[k], x.angular,
                                 x.linear};
      face.density = settings.density;
      face.viscosity = settings.viscosity;
      face.reference_length = length;
      face.separation_cosine = settings.separation_cosine;
      pressure += face.wrenchOf(face.pressureForce());
      friction += face.wrenchOf(face.frictionForce());
    }
    const FaceLoads loads = computeFaceLoads(body, length, x, settings);
    // Rounding of 80 terms.
    EXPECT_LT((loads.pressure.vector() - pressure).norm(), 1e-13 * pressure.norm());
    EXPECT_LT((loads.friction.vector() - friction).norm(), 1e-13 * friction.norm());
  }
}

TEST(FaceLoads, AreTheQuadraticFormsOfTheSlipMatrixWhenAttachedEverywhere) {
  test::Arbitrary arbitrary(42);
  const FaceTable body = arbitrary.body(1);
  const Twist x = arbitrary.twist(2, 3);
  const auto slip = (computeSlipMatrix(body) * x.vector()).eval();
  Wrench expected;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const double speed_sq = slip.segment<3>(static_cast<Eigen::Index>(3 * i)).squaredNorm();
    expected +=
        Wrench::ofForceAt(-0.5 * 1.3 * speed_sq * body.area[i] * body.normal(i), body.centroid(i));
  }
  const Wrench pressure = computeFaceLoads(body, 1, x, {1.3, 0, -1, false}).pressure;
  EXPECT_LT((pressure.vector() - expected.vector()).norm(), 1e-13 * expected.vector().norm());
}

// Magnitudes of the loads in double and in single precision.
Vector6 loadsOf(const FaceTable& faces, const Twist& x, const LoadSettings& settings) {
  return computeFaceLoads(faces, 1, x, settings).total().vector().cwiseAbs() +
         computeFaceLoad(PackedFaces(faces), 1, x, settings).vector().cwiseAbs();
}

TEST(FaceLoads, VanishWithoutMotionFacesOrDensity) {
  test::Arbitrary arbitrary(44);
  const FaceTable body = arbitrary.body();
  const Twist x = arbitrary.twist();
  for (const double cosine : {0.0, -0.5, -1.0}) {
    const LoadSettings settings{1.3, 1e-3, cosine, true};
    const LoadSettings vacuum{0, 1e-3, cosine, true};
    for (const Vector6& load : {loadsOf(body, Twist{}, settings), loadsOf(FaceTable{}, x, settings),
                                loadsOf(body, x, vacuum)})
      EXPECT_EQ(load, Vector6::Zero());
  }
}

TEST(FaceLoads, StayFiniteForTheSmallestAndForLargeMotions) {
  test::Arbitrary arbitrary(45);
  const FaceTable body = arbitrary.body();
  const Twist x = arbitrary.twist();
  for (const double cosine : {0.0, -0.5, -1.0})
    for (const double factor :
         {std::numeric_limits<double>::denorm_min(), 1e-308, 1e-160, 1e-154, 1e-100, 1e100}) {
      const FaceLoads loads = computeFaceLoads(body, 1, {factor * x.angular, factor * x.linear},
                                               {1.3, 1e-3, cosine, true});
      EXPECT_TRUE(loads.total().vector().allFinite()) << factor;
    }
}

TEST(FaceLoads, OfAMotionThatIsNotFiniteAreNotFiniteOrZero) {
  test::Arbitrary arbitrary(46);
  const FaceTable body = arbitrary.body();
  const PackedFaces packed(body);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()})
    for (int component = 0; component < 6; ++component)
      for (const double cosine : {0.0, -0.5, -1.0}) {
        Vector6 x = arbitrary.twist().vector();
        x[component] = bad;
        const FaceLoads loads =
            computeFaceLoads(body, 1, Twist::fromVector(x), {1.3, 1e-3, cosine, true});
        const Wrench single =
            computeFaceLoad(packed, 1, Twist::fromVector(x), {1.3, 1e-3, cosine, true});
        for (const Wrench& wrench : {loads.pressure, loads.friction, single})
          EXPECT_TRUE(!wrench.vector().allFinite() || wrench.vector() == Vector6::Zero());
      }
}

TEST(FaceLoads, AllocateNothing) {
  test::Arbitrary arbitrary(47);
  const FaceTable body = arbitrary.body(2);
  const Twist x = arbitrary.twist();
  const PackedFaces packed(body);
  const LoadSettings settings{1.3, 1e-3, -0.5, true};
  const std::size_t before = test::allocationCount();
  const FaceLoads loads = computeFaceLoads(body, 1, x, settings);
  const Wrench single = computeFaceLoad(packed, 1, x, settings);
  EXPECT_EQ(test::allocationCount(), before);
  EXPECT_NE(loads.total().vector(), Vector6::Zero());
  EXPECT_NE(single.vector(), Vector6::Zero());
}

}  // namespace
}  // namespace ambient
