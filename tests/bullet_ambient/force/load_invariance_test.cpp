#include <gtest/gtest.h>

#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

// Rounding of a sum of some hundred terms; the sum may be a tenth of them.
constexpr double kRounding = 1e-12;

class LoadInvariance : public testing::TestWithParam<double> {
 protected:
  LoadSettings settings() const { return {1.3, 1e-3, GetParam(), true}; }
  FaceLoads loadsOn(const FaceTable& faces, const Twist& x, double length = 1) const {
    return computeFaceLoads(faces, length, x, settings());
  }

  test::Arbitrary arbitrary_{31};
  FaceTable body_ = arbitrary_.body(2);
  Twist x_ = arbitrary_.twist(2, 3);
  FaceLoads loads_ = loadsOn(body_, x_);
};

template <class Map>
FaceTable mapped(const FaceTable& faces, const Map& map) {
  FaceTable result;
  for (std::size_t i = 0; i < faces.size(); ++i) map(result, i);
  return result;
}

void expectClose(const Wrench& actual, const Wrench& expected) {
  EXPECT_LT((actual.vector() - expected.vector()).norm(), kRounding * expected.vector().norm());
}

TEST_P(LoadInvariance, DoesNotDependOnTheOriginAndAxesOfTheFrame) {
  // x_ is the motion in frame F; frame B is random.
  const FrameOffset offset{arbitrary_.rotation(), arbitrary_.vector()};
  const Twist x_B{offset.rotation * x_.angular,
                  offset.rotation * x_.at(-offset.rotation.transpose() * offset.translation)};
  const FaceTable faces_B = mapped(body_, [&](FaceTable& to, std::size_t i) {
    to.add(offset.rotation * body_.normal(i),
           offset.rotation * body_.centroid(i) + offset.translation, body_.area[i]);
  });
  const FaceLoads loads_B = loadsOn(faces_B, x_B);
  const FaceLoads loads_F = loadsOn(body_, offset.toF(x_B));
  expectClose(loads_B.pressure, offset.toB(loads_F.pressure));
  expectClose(loads_B.friction, offset.toB(loads_F.friction));
}

TEST_P(LoadInvariance, IsMirroredWithTheBodyBitForBit) {
  const Vector3 mirror(-1, 1, 1);          // vectors
  const Vector3 pseudo_mirror(1, -1, -1);  // angular velocities and torques
  const FaceTable mirrored = mapped(body_, [&](FaceTable& to, std::size_t i) {
    to.add(mirror.cwiseProduct(body_.normal(i)), mirror.cwiseProduct(body_.centroid(i)),
           body_.area[i]);
  });
  const FaceLoads loads =
      loadsOn(mirrored, {pseudo_mirror.cwiseProduct(x_.angular), mirror.cwiseProduct(x_.linear)});
  EXPECT_EQ(loads.pressure.force, mirror.cwiseProduct(loads_.pressure.force));
  EXPECT_EQ(loads.pressure.torque, pseudo_mirror.cwiseProduct(loads_.pressure.torque));
  EXPECT_EQ(loads.friction.force, mirror.cwiseProduct(loads_.friction.force));
  EXPECT_EQ(loads.friction.torque, pseudo_mirror.cwiseProduct(loads_.friction.torque));
}

TEST_P(LoadInvariance, PressureIsHomogeneousOfDegreeTwoInTheMotion) {
  for (const double factor : {0.5, 8.0, 0x1p-200}) {
    const FaceLoads loads = loadsOn(body_, {factor * x_.angular, factor * x_.linear});
    // A factor of a power of 2 must not change any rounding.
    EXPECT_EQ(loads.pressure.vector(), factor * factor * loads_.pressure.vector()) << factor;
  }
  const FaceLoads loads = loadsOn(body_, {1.7 * x_.angular, 1.7 * x_.linear});
  expectClose(loads.pressure, 1.7 * 1.7 * loads_.pressure);
}

TEST_P(LoadInvariance, ScalesWithTheSizeOfTheBody) {
  const double s = 2;
  const FaceTable scaled = mapped(body_, [&](FaceTable& to, std::size_t i) {
    to.add(body_.normal(i), s * body_.centroid(i), s * s * body_.area[i]);
  });
  // Spin w / s keeps the speed at all points.
  const FaceLoads loads = loadsOn(scaled, {x_.angular / s, x_.linear}, s);
  EXPECT_EQ(loads.pressure.force, s * s * loads_.pressure.force);
  EXPECT_EQ(loads.pressure.torque, s * s * s * loads_.pressure.torque);
  const double friction_scale = s * s * std::pow(s, -0.2);  // Reynolds number grows by s
  expectClose({loads.friction.torque / s, loads.friction.force}, friction_scale * loads_.friction);
}

TEST_P(LoadInvariance, IsProportionalToTheDensityAtOneReynoldsNumber) {
  LoadSettings denser = settings();
  denser.density *= 4;
  denser.viscosity *= 4;
  const FaceLoads loads = computeFaceLoads(body_, 1, x_, denser);
  EXPECT_EQ(loads.pressure.vector(), 4 * loads_.pressure.vector());
  expectClose(loads.friction, 4 * loads_.friction);
}

INSTANTIATE_TEST_SUITE_P(SeparationCosines, LoadInvariance, testing::Values(0.0, -0.3, -0.7, -1.0));

TEST(LoadSymmetry, ForwardAndBackwardLoadsAddUpToThatOfAllFacesAtARightAngle) {
  test::Arbitrary arbitrary(32);
  const FaceTable body = arbitrary.body(2);
  const LoadSettings settings{1.3, 0, 0, false};
  for (int i = 0; i < 100; ++i) {
    const Twist x = arbitrary.twist(2, 3);
    const Twist back{-x.angular, -x.linear};
    const Wrench sum = computeFaceLoads(body, 1, x, settings).pressure +
                       computeFaceLoads(body, 1, back, settings).pressure;
    // Attached everywhere: cos(alpha) = -1.
    const LoadSettings attached{1.3, 0, -1, false};
    expectClose(sum, computeFaceLoads(body, 1, x, attached).pressure);
  }
}

}  // namespace
}  // namespace ambient
