#include "bullet_ambient/spatial/inertia.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

TEST(Twist, PutsRotationFirst) {
  const Twist x{{1, 2, 3}, {4, 5, 6}};
  Vector6 expected;
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ(x.vector(), expected);
  EXPECT_EQ(Twist::fromVector(expected).angular, x.angular);
  EXPECT_EQ(Twist::fromVector(expected).linear, x.linear);
}

TEST(Twist, MovesAPointByItsLeverArm) {
  const Twist spin_about_z{{0, 0, 2}, {0, 0, 7}};
  EXPECT_EQ(spin_about_z.at(Vector3(3, 0, 0)), Vector3(0, 6, 7));
}

TEST(Wrench, OfAForceHasTheTorqueOfItsLeverArm) {
  const Wrench f = Wrench::ofForceAt(Vector3(0, 5, 0), Vector3(2, 0, 0));
  EXPECT_EQ(f.torque, Vector3(0, 0, 10));
  EXPECT_EQ(f.force, Vector3(0, 5, 0));
}

TEST(Wrench, OfAForceDoesThePowerOfThatForceOnItsPoint) {
  const Vector3 force(1.5, -2, 0.25);
  const Vector3 position(0.5, 3, -1);
  const Twist x{{0.5, -1.5, 2}, {4, 0.25, -3}};
  // Numbers short in binary: no rounding.
  EXPECT_EQ(power(Wrench::ofForceAt(force, position), x), force.dot(x.at(position)));
}

TEST(Wrench, AddsAndScalesByComponent) {
  const Wrench a{{1, 2, 3}, {4, 5, 6}};
  const Wrench b{{10, 20, 30}, {40, 50, 60}};
  EXPECT_EQ((a + 2 * b).vector(), a.vector() + 2 * b.vector());
}

TEST(Momentum, PutsRotationFirst) {
  const Momentum m{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(m.vector().head<3>(), m.angular);
  EXPECT_EQ(Momentum::fromVector(m.vector()).linear, m.linear);
}

// Rounding of a few dozen operations on numbers of order 1 to 10.
constexpr double kShiftRounding = 1e-13;

class FrameOffsetTest : public testing::Test {
 protected:
  test::Arbitrary arbitrary_{7};
  FrameOffset offset_{arbitrary_.rotation(), arbitrary_.vector()};
};

TEST_F(FrameOffsetTest, MovesTheSameBodyPointInBothFrames) {
  const Twist x_B = arbitrary_.twist();
  const Vector3 p_F = arbitrary_.vector();
  const Vector3 p_B = offset_.rotation * p_F + offset_.translation;
  const Vector3 velocity_F = offset_.toF(x_B).at(p_F);
  EXPECT_LT((offset_.rotation * velocity_F - x_B.at(p_B)).norm(), kShiftRounding);
}

TEST_F(FrameOffsetTest, TakesAForceAtAPointToThatForceAtThatPoint) {
  const Vector3 force_F = arbitrary_.vector();
  const Vector3 p_F = arbitrary_.vector();
  const Vector3 p_B = offset_.rotation * p_F + offset_.translation;
  const Wrench expected = Wrench::ofForceAt(offset_.rotation * force_F, p_B);
  const Wrench f_B = offset_.toB(Wrench::ofForceAt(force_F, p_F));
  EXPECT_LT((f_B.vector() - expected.vector()).norm(), kShiftRounding);
}

TEST_F(FrameOffsetTest, KeepsThePower) {
  for (int i = 0; i < 100; ++i) {
    const Twist x_B = arbitrary_.twist();
    const Wrench f_F{arbitrary_.vector(), arbitrary_.vector()};
    EXPECT_NEAR(power(offset_.toB(f_F), x_B), power(f_F, offset_.toF(x_B)),
                kShiftRounding * x_B.vector().norm() * f_F.vector().norm());
  }
}

TEST_F(FrameOffsetTest, KeepsTheKineticEnergy) {
  const Matrix6 K_F = arbitrary_.positiveDefinite();
  const Twist x_B = arbitrary_.twist();
  const Vector6 x_F = offset_.toF(x_B).vector();
  const double energy = x_F.dot(K_F * x_F) / 2;
  EXPECT_NEAR(x_B.vector().dot(offset_.inertiaToB(K_F) * x_B.vector()) / 2, energy,
              kShiftRounding * energy);
}

TEST_F(FrameOffsetTest, OfNothingChangesNothing) {
  const Twist x = arbitrary_.twist();
  const Wrench f{arbitrary_.vector(), arbitrary_.vector()};
  const Matrix6 K = arbitrary_.positiveDefinite();
  EXPECT_EQ(FrameOffset{}.toF(x).vector(), x.vector());
  EXPECT_EQ(FrameOffset{}.toB(f).vector(), f.vector());
  EXPECT_EQ(FrameOffset{}.inertiaToB(K), K);
}

TEST(RotationFromVector, TurnsAboutTheVectorByItsLength) {
  test::Arbitrary arbitrary(2);
  for (const double angle : {1e-5, 0.3, 2.0, 6.0, 100.0}) {
    const Vector3 axis = arbitrary.vector().normalized();
    const Matrix3 expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Matrix3 R = rotationFromVector(angle * axis).toRotationMatrix();
    EXPECT_LT((R - expected).cwiseAbs().maxCoeff(), 1e-14) << angle;
  }
}

TEST(RotationVector, IsThatOfTheQuaternionOrItsNegative) {
  test::Arbitrary arbitrary(3);
  for (const double angle : {0.0, 1e-200, 1e-20, 1e-5, 0.3, 2.0, 3.1}) {
    const Vector3 expected = angle * arbitrary.vector().normalized();
    const Quaternion q = rotationFromVector(expected);
    EXPECT_LE((rotationVector(q) - expected).norm(), 4e-16 * angle) << angle;
    EXPECT_EQ(rotationVector(Quaternion(-q.coeffs())), rotationVector(q)) << angle;
  }
}

TEST(RotationBetween, TakesOneDirectionToTheOther) {
  test::Arbitrary arbitrary(4);
  for (int i = 0; i < 100; ++i) {
    const Vector3 from = 1e-3 * arbitrary.vector(), to = 1e5 * arbitrary.vector();
    const Vector3 turned = rotationBetween(from, to) * from.normalized();
    EXPECT_LT((turned - to.normalized()).norm(), 3e-15);
  }
  for (const Vector3& axis : {Vector3(Vector3::UnitX()), Vector3(1, -2, 3)}) {
    const Vector3 turned = rotationBetween(axis, -axis) * axis;
    EXPECT_LT((turned + axis).norm(), 1e-15 * axis.norm());
    EXPECT_LT(rotationVector(rotationBetween(axis, axis)).norm(), 1e-15);
  }
}

TEST(AngleBetween, IsThatOfTheRotation) {
  const Quaternion a = rotationFromVector({0.1, 0.2, -0.3}), turn = rotationFromVector({0, 0.7, 0});
  EXPECT_NEAR(angleBetween(a, a * turn), 0.7, 1e-15);
  EXPECT_NEAR(angleBetween(a, Quaternion(-(a * turn).coeffs())), 0.7, 1e-15);
}

TEST(IsTurnedFurther, ComparesTheAngleWithTheLimit) {
  test::Arbitrary arbitrary(4);
  const Quaternion a(arbitrary.rotation());
  for (const double angle : {0.0, 1e-9, 0.3, 1.5, 3.0, 3.14}) {
    const Quaternion b = a * rotationFromVector(angle * arbitrary.vector().normalized());
    const Quaternion opposite(-b.coeffs());
    for (const Quaternion& end : {b, opposite}) {
      EXPECT_FALSE(isTurnedFurther(a, end, angle + 1e-14)) << angle;
      EXPECT_TRUE(isTurnedFurther(a, end, angle - 1e-14)) << angle;
      EXPECT_EQ(isTurnedFurther(a, end, angle / 2), angle > 0) << angle;
      EXPECT_FALSE(isTurnedFurther(a, end, 4));
    }
  }
}

TEST(PrincipalFrame, GivesTheInertiaBack) {
  Matrix3 inertia;
  inertia << 2, 0.3, -0.2, 0.3, 3, 0.1, -0.2, 0.1, 4;
  const PrincipalFrame frame = findPrincipalFrame(inertia);
  const Matrix3 moments = frame.moments.asDiagonal();
  const Matrix3 back = frame.rotation * moments * frame.rotation.transpose();
  EXPECT_LE((back - inertia).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(frame.rotation.determinant(), 1, 1e-14);
}

TEST(PrincipalFrame, KeepsTheAxesOfADiagonalInertia) {
  Matrix3 inertia = Vector3(5, 1, 3).asDiagonal();
  inertia(0, 1) = inertia(1, 0) = 1e-16;
  const PrincipalFrame frame = findPrincipalFrame(inertia);
  EXPECT_EQ(frame.rotation, Matrix3::Identity());
  EXPECT_EQ(frame.moments, Vector3(5, 1, 3));
}

// Rounding of a few dozen operations on numbers of order 1 to 10.
constexpr double kRounding = 1e-13;

double kineticEnergy(const Matrix6& K, const Twist& x) {
  return x.vector().dot(K * x.vector()) / 2;
}

/// Point masses without symmetry.
struct PointMass {
  double mass;
  Vector3 position;
};
const std::vector<PointMass> kPoints = {
    {2, {1, 0.5, -1}}, {0.5, {-2, 1, 0.25}}, {1.5, {0, -1, 2}}, {3, {0.5, 0.5, -0.5}}};

/// 6x6 inertia of the points about `origin`, by definition: sum m J^T J, J x = v + w x r.
Matrix6 inertiaOfPoints(const Vector3& origin) {
  Matrix6 K = Matrix6::Zero();
  for (const PointMass& point : kPoints) {
    Eigen::Matrix<double, 3, 6> J;
    J << -crossMatrix(point.position - origin), Matrix3::Identity();
    K += point.mass * J.transpose() * J;
  }
  return K;
}

TEST(CrossMatrix, IsTheCrossProduct) {
  const Vector3 d(1, -2, 3);
  const Vector3 a(0.5, 4, -1);
  EXPECT_EQ(crossMatrix(d) * a, d.cross(a));
}

TEST(ShiftOrigin, GivesTheInertiaOfPointMassesAboutTheNewOrigin) {
  const Vector3 d(0.3, -0.7, 1.1);
  EXPECT_LT((shiftOrigin(inertiaOfPoints(Vector3::Zero()), d) - inertiaOfPoints(d)).norm(),
            kRounding * inertiaOfPoints(d).norm());
}

TEST(ShiftOrigin, KeepsTheKineticEnergyOfAMotion) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100; ++i) {
    const Matrix6 K = arbitrary.positiveDefinite();
    const Vector3 d = arbitrary.vector();
    const Twist x = arbitrary.twist();
    const Twist x_at_new_origin{x.angular, x.at(d)};
    const double energy = kineticEnergy(K, x);
    // Cancelling terms grow with |d|^2.
    EXPECT_NEAR(kineticEnergy(shiftOrigin(K, d), x_at_new_origin), energy,
                kRounding * (1 + d.squaredNorm()) * x.vector().squaredNorm() * K.norm());
  }
}

TEST(ShiftOrigin, BackAndForthChangesNothing) {
  test::Arbitrary arbitrary(2);
  const Matrix6 K = arbitrary.positiveDefinite();
  const Vector3 d(0.4, -1.2, 0.9);
  EXPECT_LT((shiftOrigin(shiftOrigin(K, d), -d) - K).norm(), kRounding * K.norm());
}

TEST(ShiftOrigin, MovesTheHemisphereFromItsSphereCentreToItsCentroid) {
  // Added mass of the hemisphere R = 1 with flat face in z = 0, per unit density. Axisymmetric
  // Nystroem solution for both origins, uncertainty 2e-9.
  const double volume = 2 * std::acos(-1.0) / 3;
  Matrix6 K = Matrix6::Zero();
  K(0, 0) = K(1, 1) = 0.2314263542669546;
  K(3, 3) = K(4, 4) = 0.368533971412441 * volume;
  K(5, 5) = 1.2151482353124803 * volume;
  K(1, 3) = K(3, 1) = 0.09588537248611967;
  K(0, 4) = K(4, 0) = -0.09588537248611967;
  const Matrix6 at_centroid = shiftOrigin(K, Vector3(0, 0, 0.375));
  EXPECT_NEAR(at_centroid(1, 1), 0.2680545390137699, 2e-9);
  EXPECT_NEAR(at_centroid(0, 0), 0.2680545390137699, 2e-9);
  EXPECT_NEAR(at_centroid(1, 3), -0.193560531810821, 2e-9);
  EXPECT_NEAR(at_centroid(0, 4), 0.193560531810821, 2e-9);
  EXPECT_EQ(at_centroid(5, 5), K(5, 5));
}

TEST(RotateAxes, KeepsTheKineticEnergyOfAMotion) {
  test::Arbitrary arbitrary(3);
  const Matrix6 K = arbitrary.positiveDefinite();
  const Matrix3 R = arbitrary.rotation();
  const Twist x = arbitrary.twist();
  const Twist turned{R * x.angular, R * x.linear};
  EXPECT_NEAR(kineticEnergy(rotateAxes(K, R), turned), kineticEnergy(K, x),
              kRounding * K.norm() * x.vector().squaredNorm());
}

TEST(RotateAxes, AQuarterTurnExchangesPrincipalValues) {
  Vector6 diagonal;
  diagonal << 1, 2, 3, 4, 5, 6;
  const Matrix6 K = diagonal.asDiagonal();
  Matrix3 quarter_turn_about_z;
  quarter_turn_about_z << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  Vector6 expected;
  expected << 2, 1, 3, 5, 4, 6;
  EXPECT_EQ(rotateAxes(K, quarter_turn_about_z), Matrix6(expected.asDiagonal()));
}

TEST(ScaleShape, TurnsTheSmallOblateSpheroidIntoTheLargeOne) {
  // Lamb, Hydrodynamics, arts. 114-115: semi-axes (1, 1, 0.2) and (5, 5, 1), per unit density.
  Vector6 unit;
  unit << 0.312444118881301, 0.312444118881301, 0, 0.11941504131050919, 0.11941504131050919,
      2.5197731270494916;
  Vector6 five;
  five << 976.3878715040643, 976.3878715040643, 0, 14.926880163813646, 14.926880163813646,
      314.971640881186;
  const Matrix6 scaled = scaleShape(unit.asDiagonal(), 5);
  EXPECT_LT((scaled - Matrix6(five.asDiagonal())).norm(), 1e-12 * five.norm());
}

TEST(ScaleShape, ScalesTheCouplingWithTheFourthPower) {
  const Matrix6 ones = Matrix6::Ones();
  const Matrix6 scaled = scaleShape(ones, 2);
  EXPECT_EQ(scaled(0, 1), 32);
  EXPECT_EQ(scaled(0, 3), 16);
  EXPECT_EQ(scaled(3, 0), 16);
  EXPECT_EQ(scaled(3, 4), 8);
}

TEST(ScaleShape, CommutesWithAShiftScaledAlike) {
  test::Arbitrary arbitrary(4);
  const Matrix6 K = arbitrary.positiveDefinite();
  const Vector3 d(0.2, 0.5, -0.3);
  const Matrix6 one_way = scaleShape(shiftOrigin(K, d), 1.7);
  EXPECT_LT((one_way - shiftOrigin(scaleShape(K, 1.7), 1.7 * d)).norm(),
            kRounding * one_way.norm());
}

TEST(RigidBodyInertia, IsThatOfPointMassesAboutTheirCentre) {
  double mass = 0;
  Vector3 moment = Vector3::Zero();
  for (const PointMass& point : kPoints) {
    mass += point.mass;
    moment += point.mass * point.position;
  }
  const Vector3 centre = moment / mass;
  Matrix3 J = Matrix3::Zero();
  for (const PointMass& point : kPoints) {
    const Matrix3 arm = crossMatrix(point.position - centre);
    J -= point.mass * arm * arm;
  }
  EXPECT_LT((rigidBodyInertia(mass, J) - inertiaOfPoints(centre)).norm(), kRounding * J.norm());
}

template <int N>
auto arbitraryInertia(test::Arbitrary& arbitrary) {
  typename Cholesky<N>::Matrix A;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) A(i, j) = arbitrary.between(-1, 1);
  return (A * A.transpose() + 0.1 * Cholesky<N>::Matrix::Identity()).eval();
}

// Random matrices with condition numbers below 200: rounding stays below 1e-13.
template <int N>
void expectThatItFactorises() {
  using Matrix = typename Cholesky<N>::Matrix;
  test::Arbitrary arbitrary(3);
  for (int i = 0; i < 100; ++i) {
    const Matrix A = arbitraryInertia<N>(arbitrary);
    const Cholesky<N> factor(A);
    ASSERT_TRUE(factor.isPositive());
    const Matrix L = factor.lower();
    EXPECT_TRUE(L.isLowerTriangular(0));
    EXPECT_LT((L * L.transpose() - A).norm(), kRounding);
    EXPECT_LT((A * factor.inverse() - Matrix::Identity()).norm(), 10 * kRounding);
    EXPECT_TRUE(factor.inverseTransposed().isUpperTriangular(0));
    EXPECT_LT((L.transpose() * factor.inverseTransposed() - Matrix::Identity()).norm(), kRounding);
    const typename Cholesky<N>::Vector b = A.col(0) - A.col(N - 1);
    EXPECT_LT((A * factor.solve(b) - b).norm(), 10 * kRounding);
  }
}

TEST(Cholesky, InvertsMatricesOfAnyScale) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100; ++i) {
    Vector6 scale;
    for (int k = 0; k < 6; ++k) scale[k] = std::pow(10, arbitrary.between(-4, 4));
    const Matrix6 unscaled = arbitraryInertia<6>(arbitrary);
    const Matrix6 K = scale.asDiagonal() * unscaled * scale.asDiagonal();
    const Matrix6 inverse = Cholesky<6>(K).inverse();
    const Matrix6 back = scale.asDiagonal() * inverse * scale.asDiagonal();
    EXPECT_LT((unscaled * back - Matrix6::Identity()).norm(), 1e-12);
    EXPECT_EQ(inverse, inverse.transpose());
  }
}

TEST(Cholesky, FactorisesThreeRows) { expectThatItFactorises<3>(); }

TEST(Cholesky, FactorisesSixRows) { expectThatItFactorises<6>(); }

TEST(Cholesky, ReadsTheLowerHalfOnly) {
  test::Arbitrary arbitrary(4);
  Matrix6 A = arbitraryInertia<6>(arbitrary);
  const Matrix6 L = Cholesky<6>(A).lower();
  A(0, 5) = 1e9;
  EXPECT_EQ(Cholesky<6>(A).lower(), L);
}

TEST(Cholesky, IsNotPositiveOfOtherMatrices) {
  test::Arbitrary arbitrary(5);
  for (int i = 0; i < 6; ++i) {
    Matrix6 A = arbitraryInertia<6>(arbitrary);
    A(i, i) = -0.1;
    EXPECT_FALSE(Cholesky<6>(A).isPositive()) << i;
    A(i, i) = std::nan("");
    EXPECT_FALSE(Cholesky<6>(A).isPositive()) << i;
  }
  EXPECT_FALSE(Cholesky<3>(Matrix3::Zero()).isPositive());
  EXPECT_FALSE(Cholesky<6>().isPositive());
}

}  // namespace
}  // namespace ambient
