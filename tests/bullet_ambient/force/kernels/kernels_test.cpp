#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/kernels/hull_sums.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/round_barrel.h"

// Kernels of all instruction sets have the bits of the baseline, which other tests compare with
// closed forms.

namespace ambient {
namespace {

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
