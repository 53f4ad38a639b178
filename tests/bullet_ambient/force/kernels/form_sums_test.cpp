// Kernels of the form law, docs/theory.md eq. (43) and (44).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
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
