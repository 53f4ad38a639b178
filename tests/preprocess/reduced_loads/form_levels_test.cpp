#include "preprocess/reduced_loads/form_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

/// An ellipsoid between round and flat shapes, off the origin.
/// A block, without added mass; `is_wing`: a wing, with that of an ellipsoid.
FluidBody ellipsoid(bool is_wing = false) {
  FluidBody body = test::meshedEllipsoid({0.5, 0.3, 0.1}, 3);
  if (!is_wing) body.added_mass.setZero();
  for (std::size_t i = 0; i < body.faces.size(); ++i) {
    body.faces.sharpness.push_back(std::abs(body.faces.normal_z[i]));
    body.faces.centroid_x[i] += 2;
  }
  return body;
}

Twist someTwist(test::Arbitrary& arbitrary, double length) {
  const double angle = arbitrary.between(0, std::acos(0.0));
  const Vector3 w = std::sin(angle) / length * arbitrary.vector().normalized();
  const Vector3 v = std::cos(angle) * arbitrary.vector().normalized();
  return {w, v - w.cross(Vector3(2, 0, 0))};  // twist of the middle of the body
}

/// Loads including friction at a Reynolds number of 1000 at 1 m/s.
Vector6 loadOn(const FaceTable& faces, const Twist& x, const ShapeFactors* shape = nullptr) {
  const LoadSettings settings{1.2, 1.2e-3, 0, true, PressureLaw::kForm, shape};
  return computeFaceLoads(faces, 1, x, settings).total().vector();
}

/// Error of a level that ten of 1000 motions exceed, relative to the scale of FormLevel.
double measuredError(const FormLevel& level, const FluidBody& body) {
  constexpr double kLength = 0.35;  // root mean square distance from the middle
  const ShapeFactors shape(formShapeOf(body));
  const FaceTable all = formLawFaces(body, shape.shape);
  test::Arbitrary arbitrary(5);
  std::vector<double> errors;
  for (int i = 0; i < 1000; ++i) {
    const Twist x = someTwist(arbitrary, kLength);
    double scale = 0;
    for (std::size_t face = 0; face < all.size(); ++face)
      scale += 0.6 * all.area[face] * x.at(all.centroid(face)).squaredNorm();
    Vector6 error = loadOn(level.faces, x, &shape) - loadOn(all, x, &shape);
    const Vector3 torque = error.head<3>() - Vector3(2, 0, 0).cross(error.tail<3>());
    error.head<3>() = torque / kLength;
    errors.push_back(error.norm() / scale);
  }
  std::sort(errors.begin(), errors.end());
  return errors[990];
}

TEST(FormLevels, HaveTheErrorThatTheyState) {
  for (const bool is_wing : {false, true}) {
    const FluidBody body = ellipsoid(is_wing);
    double before = 1;
    for (const FormLevel& level : buildFormLevels(body, {48, 96, 200})) {
      EXPECT_LT(level.p99_error, 0.7 * before) << level.faces.size();
      EXPECT_EQ(level.law_revision, kFormLawRevision);
      before = level.p99_error;
      EXPECT_NEAR(measuredError(level, body), level.p99_error, 0.3 * level.p99_error);
    }
    EXPECT_LT(before, is_wing ? 0.006 : 0.004);
  }
}

/// Three mirrors of the ellipsoid: motion along an axis gives no side force and no torque.
TEST(FormLevels, KeepTheMirrorsOfTheBody) {
  const FaceTable faces = buildFormLevels(ellipsoid(), {48}).front().faces;
  for (int axis = 0; axis < 3; ++axis) {
    const Twist x{Vector3::Zero(), Vector3::Unit(axis)};
    Vector6 load = loadOn(faces, x);
    load.head<3>() -= Vector3(2, 0, 0).cross(load.tail<3>());
    const double drag = load[3 + axis];
    load[3 + axis] = 0;
    EXPECT_LT(load.cwiseAbs().maxCoeff(), 1e-6 * std::abs(drag)) << axis;
  }
}

/// A wedge has one mirror, across its length; the fit must not impose further mirrors.
/// A float of two cylinders: rings of 40 quads, each turned against the last by an angle that is no
/// part of a corner, each quad divided along either diagonal. No mirror maps the mesh on itself.
FluidBody crookedFloat() {
  struct Ring {
    double radius, height;
  };
  constexpr Ring kRings[] = {{0, -2}, {0.4, -2}, {0.4, -1}, {0.4, 0},
                             {1, 0},  {1, 0.5},  {1, 1},    {0, 1}};
  constexpr int kCorners = 40;
  const auto corner = [&](std::size_t ring, int i) {
    const double angle = 2 * kPi * (i + 0.37 * static_cast<double>(ring % 3)) / kCorners;
    return Vector3(kRings[ring].radius * std::cos(angle), kRings[ring].radius * std::sin(angle),
                   kRings[ring].height);
  };
  FluidBody body;
  body.area = 1;
  for (std::size_t ring = 0; ring + 1 < std::size(kRings); ++ring)
    for (int i = 0; i < kCorners; ++i) {
      const Vector3 a = corner(ring, i), b = corner(ring, i + 1), c = corner(ring + 1, i + 1),
                    d = corner(ring + 1, i);
      const bool other = (7 * i + static_cast<int>(ring)) % 3 == 0;
      const Vector3 triangles[2][3] = {{a, b, other ? d : c}, {other ? b : a, c, d}};
      for (const auto& t : triangles) {
        const Vector3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
        if (normal.norm() < 1e-9) continue;  // at the axis
        body.faces.add(normal.normalized(), (t[0] + t[1] + t[2]) / 3, normal.norm() / 2);
        body.faces.sharpness.push_back(std::abs(normal.normalized().z()));
      }
    }
  return body;
}

TEST(FormLevels, OfBodiesOfRevolutionHaveNoMomentAboutTheirAxis) {
  const FluidBody body = crookedFloat();
  const LoadSettings smooth{1.2, 0, 0, false, PressureLaw::kForm};
  double largest = 0;
  for (const FormLevel& level : buildFormLevels(body, {48, 96})) {
    EXPECT_LT(level.p99_error, 0.05);
    for (int i = 0; i < 32; ++i) {
      const double angle = 2 * kPi * i / 32;
      const Twist along{Vector3::Zero(), {std::cos(angle), std::sin(angle), 0.3}};
      const Wrench load = computeFaceLoads(level.faces, 1, along, smooth).pressure;
      EXPECT_GT(load.force.norm(), 0.5);
      largest = std::max(largest, std::abs(load.torque.z()) / load.force.norm());
    }
  }
  EXPECT_LT(largest, 1e-5);  // [m]; the body is 2 m wide, its centroid 2e-6 m beside the axis
}

TEST(FormLevels, AddNoMirrors) {
  FluidBody body;
  body.name = "wedge";
  for (const Vector3& n : {Vector3(0, 0, -1), Vector3(0.6, 0, 0.8), Vector3(-1, 0, 0)})
    for (int i = 0; i < 400; ++i) {
      const Vector3 across = n.cross(Vector3::UnitY());
      body.faces.add(
          n, 0.5 * n + (i % 20 - 9.5) / 20 * across + (i / 20 - 9.5) / 10 * Vector3::UnitY(),
          0.005);
      body.faces.sharpness.push_back(1);
    }
  const FormLevel level = *smallestFormLevel(body, 0.01);
  EXPECT_LT(level.faces.size(), 100u);
  for (int axis = 0; axis < 3; ++axis) {
    const Twist x{Vector3::Zero(), Vector3::Unit(axis)};
    const Vector6 all = loadOn(body.faces, x);
    EXPECT_LE((loadOn(level.faces, x) - all).norm(), 0.02 * all.norm()) << axis;
    EXPECT_NEAR(loadOn(level.faces, x)[4], all[4], 1e-6) << axis;
  }
}

/// A box of 1 : a : b with 4 x 4 Gauss points per side.
FluidBody box(const Vector3& edges) {
  constexpr double kPlaces[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                0.8611363115940526};
  constexpr double kWeights[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                 0.17392742256872693};
  FluidBody body;
  body.name = "box";
  for (int side = 0; side < 6; ++side) {
    const Vector3 n = (side < 3 ? 1 : -1) * Vector3::Unit(side % 3);
    const int a = (side + 1) % 3, b = (side + 2) % 3;
    for (int i = 0; i < 16; ++i) {
      const Vector3 place =
          n + kPlaces[i / 4] * Vector3::Unit(a) + kPlaces[i % 4] * Vector3::Unit(b);
      body.faces.add(n, 0.5 * edges.cwiseProduct(place),
                     kWeights[i / 4] * kWeights[i % 4] * edges[a] * edges[b]);
      body.faces.sharpness.push_back(1);
    }
  }
  return body;
}

/// Measured 0.21 %; 0.93 % if the fit has no weight on translations. Motion along the diagonal has
/// closed-form drag and is the first one checked.
TEST(FormLevels, KeepTheLoadsOnBoxesInTranslation) {
  test::Arbitrary arbitrary(8);
  for (const Vector3& edges :
       {Vector3(1, 1, 1), Vector3(1.25, 1.25, 1), Vector3(2, 1.5, 1), Vector3(4, 2, 1)}) {
    const FluidBody body = box(edges);
    const FaceTable faces = buildFormLevels(body, {64}).front().faces;
    for (int i = 0; i < 100; ++i) {
      const Vector3 v = i == 0 ? edges : arbitrary.vector();
      const Vector6 all = loadOn(body.faces, {Vector3::Zero(), v.normalized()});
      const Vector6 few = loadOn(faces, {Vector3::Zero(), v.normalized()});
      EXPECT_LT((few - all).norm(), 3e-3 * all.norm()) << edges.transpose() << ", " << i;
    }
  }
}

TEST(FormLevels, AreAsSmallAsAnErrorAllows) {
  const FluidBody body = ellipsoid();
  std::size_t before = 0;
  for (const double error : {0.05, 0.01, 0.003}) {
    const auto level = smallestFormLevel(body, error);
    ASSERT_TRUE(level);
    EXPECT_LE(level->p99_error, error);
    EXPECT_GT(level->faces.size(), before);
    before = level->faces.size();
  }
  EXPECT_LT(before, 300u);
  EXPECT_FALSE(smallestFormLevel(body, 1e-9));
}

TEST(FormLevels, TakeEnergyInEveryMotion) {
  const FluidBody body = ellipsoid();
  test::Arbitrary arbitrary(6);
  for (const FormLevel& level : buildFormLevels(body, {48, 96, 200})) {
    for (int i = 0; i < 40000; ++i) {
      const Twist x = someTwist(arbitrary, 0.35);
      EXPECT_LT(loadOn(level.faces, x).dot(x.vector()), 0) << level.faces.size();
    }
  }
}

TEST(FormLevels, AreUsedWhereTheirErrorIsAllowed) {
  FluidBody body = ellipsoid();
  body.form_levels = buildFormLevels(body, {48, 96, 200, 100000});
  ASSERT_EQ(body.form_levels.size(), 3u) << "no level has more faces than the body";
  const auto shared = std::make_shared<FluidBody>(body);
  FlowSettings flow;
  flow.law = PressureLaw::kForm;
  const auto facesAt = [&](double error) {
    flow.maximum_load_error = error;
    return makeSurfaceLoads(shared, air(), flow)->faces();
  };
  EXPECT_EQ(facesAt(0), static_cast<int>(body.faces.size()));
  EXPECT_EQ(facesAt(body.form_levels[2].p99_error),
            static_cast<int>(body.form_levels[2].faces.size()));
  EXPECT_EQ(facesAt(1), static_cast<int>(body.form_levels[0].faces.size()));
  flow.law = PressureLaw::kPublished;
  EXPECT_EQ(facesAt(1), static_cast<int>(body.faces.size()));
}

TEST(FormLevels, AreKeptInFilesAndScaled) {
  FluidBody body = ellipsoid();
  body.form_levels = buildFormLevels(body, {16});
  const FluidBody back = decodeFluidBody(encodeFluidBody(body, "a"), "a");
  ASSERT_EQ(back.form_levels.size(), 1u);
  const FormLevel &here = body.form_levels[0], &there = back.form_levels[0];
  EXPECT_EQ(there.p99_error, here.p99_error);
  EXPECT_EQ(there.faces.centroid_x, here.faces.centroid_x);
  EXPECT_EQ(there.faces.sharpness, here.faces.sharpness);
  const FormLevel large = scaled(body, 2).form_levels[0];
  for (std::size_t i = 0; i < large.faces.size(); ++i) {
    EXPECT_EQ(large.faces.centroid(i), 2 * here.faces.centroid(i));
    EXPECT_EQ(large.faces.area[i], 4 * here.faces.area[i]);
  }
}

TEST(FormLevels, NeedFacesThatAreApart) {
  FluidBody body;
  body.name = "point";
  body.faces.add({0, 0, 1}, {1, 2, 3}, 1);
  body.faces.sharpness = {1};
  EXPECT_THROW(buildFormLevels(body, {16}), std::invalid_argument);
}

}  // namespace
}  // namespace ambient
