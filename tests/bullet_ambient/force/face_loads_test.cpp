#include "bullet_ambient/force/loads/face_loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/reference/loads/face_by_face_loads.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/round_barrel.h"

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

// Slip matrix U (3F x 6) of docs/theory.md eq. (12): U x stacks the slip velocities [m/s] of fully
// attached flow at all faces for the twist x. Padilla et al. 2025, appendix A.2.
Eigen::Matrix<double, Eigen::Dynamic, 6> computeSlipMatrix(const FaceTable& faces) {
  const auto face_count = static_cast<Eigen::Index>(faces.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> slip(3 * face_count, 6);
  for (Eigen::Index i = 0; i < face_count; ++i) {
    const Vector3 n = faces.normal(static_cast<std::size_t>(i));
    const Vector3 c = faces.centroid(static_cast<std::size_t>(i));
    const Matrix3 tangential = Matrix3::Identity() - n * n.transpose();
    slip.block<3, 3>(3 * i, 0) = tangential * crossMatrix(c);  // u_s = -P (v + w x c)
    slip.block<3, 3>(3 * i, 3) = -tangential;
  }
  return slip;
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

// Kernels of all instruction sets have the bits of the baseline, which other tests compare with
// closed forms.

using test::bitsOf;

/// Calls compare(kernel) with each kernel of a table that this processor has beside the baseline.
template <class Table, class Compare>
void compareKernels(const Table& table, const Compare& compare) {
  if (!table.of(InstructionSet::kAvx2)) GTEST_SKIP() << "this processor has the baseline only";
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (const auto kernel = table.of(set)) compare(kernel);
}

/// The first `count` of random faces. A third is flat and part of a long side, a third is round.
FaceTable randomFaces(std::size_t count) {
  test::Arbitrary arbitrary(11);
  const FaceTable all = arbitrary.body(3);
  FaceTable faces;
  for (std::size_t i = 0; i < count; ++i) {
    faces.add(all.normal(i), all.centroid(i), all.area[i]);
    faces.sharpness.push_back(i % 3 == 0 ? 1.25 : i % 3 == 1 ? 0 : arbitrary.between(0, 1));
  }
  return faces;
}

/// A slender body; `wing`: how much of a wing it is.
FormShape slenderShape(double wing) {
  test::Arbitrary arbitrary(16);
  FormShape shape;
  shape.wing = wing;
  shape.aspect = 2.5;
  shape.facing = arbitrary.vector().normalized();
  shape.span = shape.facing.cross(arbitrary.vector()).normalized();
  shape.slender = 0.7 * arbitrary.vector().normalized();
  shape.pitching = 0.5 * shape.span;
  shape.centre = arbitrary.vector(0.2);
  return shape;
}

/// Motions attached everywhere or not, with and without friction, deep and cut by a surface.
std::vector<SingleMotion> motions(const SingleMotion& law) {
  static const SingleCut cuts[] = {{{0.48f, 0.6f, 0.64f}, -0.5f, 0.3f},
                                   {{0.48f, 0.6f, 0.64f}, 0.1f, 0.3f},
                                   {{0.48f, 0.6f, 0.64f}, 0.9f, 0.3f}};
  std::vector<SingleMotion> all;
  for (const float cosine : {0.0f, -0.3f, -1.0f})
    for (const float friction : {0.0f, 0.01f})
      for (const SingleCut* cut :
           {static_cast<const SingleCut*>(nullptr), cuts, cuts + 1, cuts + 2}) {
        all.push_back({{0.75f, -0.5f, 0.3f},
                       {0.25f, 0.4f, -1.0f},
                       cosine * cosine,
                       1 - cosine * cosine,
                       friction,
                       cut,
                       law.law});
        all.back().wing = law.wing;
        all.back().pitching_rate = law.pitching_rate;
      }
  return all;
}

void compareFaceSums(const PackedFaces& packed, const SingleMotion& law) {
  compareKernels(kSumBlocks, [&](SumBlocks sums) {
    for (const SingleMotion& motion : motions(law))
      EXPECT_EQ(bitsOf(sums(packed.blocks(), motion)),
                bitsOf(sumBlocksBaseline(packed.blocks(), motion)));
  });
}

TEST(KernelBits, OfSumsOverFacesAreThoseOfTheBaseline) {
  for (const std::size_t count : {0, 1, 7, 15, 16, 17, 255, 256, 257, 1280}) {
    SCOPED_TRACE(count);
    const FaceTable faces = randomFaces(count);
    SingleMotion law{};
    law.law = PressureLaw::kPublished;
    compareFaceSums(PackedFaces(faces), law);
    law.law = PressureLaw::kForm;
    compareFaceSums(PackedFaces(faces, FormShape{}), law);
    for (const double wing : {0.0, 0.6}) {
      const FormShape shape = slenderShape(wing);
      const ShapeFactors factors(shape);
      law.wing = &factors.in_single;
      law.pitching_rate = 0.4f;
      compareFaceSums(PackedFaces(faces, shape), law);
    }
  }
}

TEST(KernelBits, OfSumsOverHullsAreThoseOfTheBaseline) {
  constexpr int kBarrel = -1, kMug = -2;
  for (const int level : {0, 1, 2, 4, kBarrel, kMug}) {
    const PackedHull hull(level >= 0 ? test::hullBody(test::geodesicEllipsoid({2, 1.3, 0.7}, level))
                                     : test::roundBarrel(1, level == kBarrel));
    compareKernels(kHullKernels, [&](const HullKernel* kernel) {
      for (int i = -12; i <= 12; ++i) {
        const HullPlane plane{{0.48, 0.6, 0.64}, {{0.8, -0.6, 0}, {0.384, 0.512, -0.768}}, 0.1 * i};
        EXPECT_EQ(bitsOf(kernel->sums(hull.blocks(), plane)),
                  bitsOf(kHullKernelBaseline.sums(hull.blocks(), plane)))
            << "level " << level << ", height " << plane.height;
        EXPECT_EQ(bitsOf(kernel->extent(hull.corners(), plane.normal)),
                  bitsOf(kHullKernelBaseline.extent(hull.corners(), plane.normal)));
      }
    });
  }
}

void comparePartSums(const PartBlocks& parts) {
  double products[PartBlock::kEntries];
  for (int i = 0; i < PartBlock::kEntries; ++i) products[i] = 0.1 * (i - 7);
  compareKernels(kPartKernels, [&](const PartKernel* kernel) {
    for (const double height : {-0.4, 0.1, 1.7}) {
      const PartPlane plane{{0.48, 0.6, 0.64}, height, 0.07};
      EXPECT_EQ(bitsOf(kernel->inertia(parts, plane)),
                bitsOf(kPartKernelBaseline.inertia(parts, plane)));
      EXPECT_EQ(bitsOf(kernel->gradient(parts, plane, products)),
                bitsOf(kPartKernelBaseline.gradient(parts, plane, products)));
    }
  });
}

TEST(KernelBits, OfSumsOverPartsAreThoseOfTheBaseline) {
  const AddedMassParts parts = test::floatingEllipsoid({1, 0.8, 0.6}, 3).added_mass_parts;
  PartBlocks blocks = parts.blocks();
  for (blocks.mirrors = 0; blocks.mirrors < 8; ++blocks.mirrors) comparePartSums(blocks);
}

// Kernels of the form law, docs/theory.md eq. (43) and (44).

namespace form_sums {

/// Random faces; every third one is flat and part of a long side, every third one round.
FaceTable facesOf(test::Arbitrary& arbitrary, int level) {
  FaceTable faces = arbitrary.body(level);
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces.sharpness.push_back(i % 3 == 0 ? 1.25 : i % 3 == 1 ? 0 : arbitrary.between(0, 1));
  return faces;
}

/// Sums the law of pressure over all faces one by one.
Wrench pressureOf(const FaceTable& faces, const Twist& x, double density) {
  Wrench sum;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 u = x.at(faces.centroid(i)), n = faces.normal(i);
    const double un = n.dot(u), flat = 1.05 + 0.12;
    const double s = std::min(faces.sharpness[i], 1.0), gain = std::max(faces.sharpness[i], 1.0);
    const double g = (1 - s) / flat + s;
    const double q =
        un > 0 ? 1.05 * g * un * un + 2 * flat * s * un * (u.norm() - un) : -0.12 * g * un * un;
    const double pressure = 0.5 * density * gain * q;
    sum += Wrench::ofForceAt(-pressure * faces.area[i] * n, faces.centroid(i));
  }
  return sum;
}

TEST(FormSums, AreThoseOfTheLaw) {
  test::Arbitrary arbitrary(12);
  for (int i = 0; i < 50; ++i) {
    const FaceTable faces = facesOf(arbitrary, i % 4);
    const Twist x = arbitrary.twist(2, 3);
    const LoadSettings settings{1.3, 0, 0, false, PressureLaw::kForm};
    const Vector6 expected = pressureOf(faces, x, 1.3).vector();
    const Vector6 in_double = computeFaceLoads(faces, 1, x, settings).pressure.vector();
    EXPECT_LE((in_double - expected).norm(), 1e-13 * expected.norm());
    const Vector6 in_single =
        computeFaceLoad(PackedFaces(faces, FormShape{}), 1, x, settings).vector();
    EXPECT_LE((in_single - expected).norm(), 3e-6 * expected.norm());
  }
}

TEST(FormSums, LeaveTheFrictionAsItIs) {
  test::Arbitrary arbitrary(14);
  const FaceTable faces = facesOf(arbitrary, 2);
  const Twist x = arbitrary.twist(2, 3);
  LoadSettings settings{1.3, 1e-3, -0.4, true, PressureLaw::kForm};
  const Vector6 form = computeFaceLoads(faces, 1, x, settings).friction.vector();
  settings.law = PressureLaw::kPublished;
  EXPECT_EQ(computeFaceLoads(faces, 1, x, settings).friction.vector(), form);
}

TEST(FormSums, OfABodyAtRestAreZero) {
  test::Arbitrary arbitrary(15);
  const FaceTable faces = facesOf(arbitrary, 1);
  const LoadSettings settings{1.3, 1e-3, 0, true, PressureLaw::kForm};
  EXPECT_EQ(computeFaceLoads(faces, 1, {}, settings).total().vector(), Vector6::Zero());
  EXPECT_EQ(computeFaceLoad(PackedFaces(faces, FormShape{}), 1, {}, settings).vector(),
            Vector6::Zero());
}

}  // namespace form_sums

}  // namespace
}  // namespace ambient
