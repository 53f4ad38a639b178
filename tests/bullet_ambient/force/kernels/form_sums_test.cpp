// Kernels of the form law, docs/theory.md eq. (43) and (44).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::form_sums {
namespace {

/// Random faces; every third one is flat and part of a long side, every third one round.
FaceTable facesOf(test::Arbitrary& arbitrary, int level) {
  FaceTable faces = arbitrary.body(level);
  for (std::size_t i = 0; i < faces.size(); ++i)
    faces.sharpness.push_back(i % 3 == 0 ? 1.25 : i % 3 == 1 ? 0 : arbitrary.between(0, 1));
  return faces;
}

/// Copies the first `count` faces.
FaceTable firstOf(const FaceTable& faces, std::size_t count) {
  FaceTable first;
  for (std::size_t i = 0; i < count; ++i) {
    first.add(faces.normal(i), faces.centroid(i), faces.area[i]);
    first.sharpness.push_back(faces.sharpness[i]);
  }
  return first;
}

SingleMotion singleMotionFor(float cosine, float friction) {
  return {{0.75f, -0.5f, 0.3f},
          {0.25f, 0.4f, -1.0f},
          -cosine * std::abs(cosine),
          1 - cosine * cosine,
          friction,
          nullptr,
          PressureLaw::kForm};
}

TEST(FormSums, HaveTheSameBitsWithEveryInstructionSet) {
  test::Arbitrary arbitrary(11);
  const FaceTable all = facesOf(arbitrary, 3);
  int compared = 0;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    const SumBlocks in_single = kSumBlocks.of(set);
    if (!in_single) continue;
    for (const std::size_t count : {1, 7, 16, 17, 257, 1280})
      for (const double cosine : {0.0, -0.3, -1.0})
        for (const bool friction : {false, true}) {
          const FaceTable faces = firstOf(all, count);
          const PackedFaces packed(faces, FormShape{});
          const SingleMotion motion =
              singleMotionFor(static_cast<float>(cosine), friction ? 0.01f : 0);
          EXPECT_EQ(test::bitsOf(in_single(packed.blocks(), motion)),
                    test::bitsOf(sumBlocksBaseline(packed.blocks(), motion)));
          ++compared;
        }
  }
  if (compared == 0) GTEST_SKIP() << "this processor has the baseline only";
}

TEST(FormSums, OfWingsAndHullsHaveTheSameBitsWithEveryInstructionSet) {
  test::Arbitrary arbitrary(16);
  const FaceTable all = facesOf(arbitrary, 3);
  FormShape shape;
  shape.aspect = 2.5;
  shape.facing = arbitrary.vector().normalized();
  shape.span = shape.facing.cross(arbitrary.vector()).normalized();
  shape.slender = 0.7 * arbitrary.vector().normalized();
  shape.pitching = 0.5 * shape.span;
  shape.centre = arbitrary.vector(0.2);
  int compared = 0;
  for (const double wing : {0.0, 0.6}) {
    shape.wing = wing;
    const ShapeFactors factors(shape);
    for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      const SumBlocks in_single = kSumBlocks.of(set);
      if (!in_single) continue;
      for (const std::size_t count : {1, 17, 257, 1280})
        for (const double cosine : {0.0, -0.3}) {
          const FaceTable faces = firstOf(all, count);
          SingleMotion single = singleMotionFor(static_cast<float>(cosine), 0.01f);
          single.wing = &factors.in_single;
          single.pitching_rate = 0.4f;
          single.slip_share = 0.25f;
          const PackedFaces packed(faces, shape);
          EXPECT_EQ(test::bitsOf(in_single(packed.blocks(), single)),
                    test::bitsOf(sumBlocksBaseline(packed.blocks(), single)));
          ++compared;
        }
    }
  }
  if (compared == 0) GTEST_SKIP() << "this processor has the baseline only";
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

}  // namespace
}  // namespace ambient::form_sums
