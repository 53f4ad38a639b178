#include <gtest/gtest.h>

#include "bullet_ambient/motion/body_model.h"
#include "tests/support/ellipsoid_body.h"
#include "tests/support/random_bodies.h"

// What a body's model keeps of its loads, decided once when it is made.
namespace ambient::test {
namespace {

constexpr double kRadius = 0.3;
const double kRightAngle = FlowSettings{}.separation_angle;

FluidBody ball(double sphere_radius = kRadius) {
  FluidBody body = meshedEllipsoid(Vector3::Constant(kRadius), 4);
  body.sphere_radius = sphere_radius;
  return body;
}

BodyModel modelOf(const FluidBody& body, const Medium& medium, const FlowSettings& flow = {},
                  const FrameOffset& frame = {}) {
  return makeBodyModel(body, frame, {2, 0.07 * Matrix3::Identity()}, medium, flow);
}

FlowSettings withAngle(double angle, bool friction = true) {
  FlowSettings flow;
  flow.separation_angle = angle;
  flow.skin_friction = friction;
  return flow;
}

TEST(LoadPlan, WithoutDensityNothingIsKept) {
  const FluidBody body = ball(0);
  const BodyModel model = modelOf(body, Medium{});
  EXPECT_FALSE(model.has_surface_loads);
  EXPECT_EQ(model.packed_faces, nullptr);
  const FluidBody sphere = ball();
  EXPECT_EQ(modelOf(sphere, Medium{}).sphere_table, nullptr);
}

TEST(LoadPlan, ASphereKeepsNoFacesAndATableOnlyWhereItNeedsOne) {
  const FluidBody body = ball();
  Medium inviscid = air();
  inviscid.viscosity = 0;
  for (const BodyModel& model :
       {modelOf(body, inviscid), modelOf(body, air(), withAngle(kRightAngle, false))}) {
    EXPECT_TRUE(model.has_surface_loads);
    EXPECT_EQ(model.packed_faces, nullptr);
    EXPECT_EQ(model.sphere_table, nullptr);
  }
  const BodyModel in_air = modelOf(body, air()), wetted = modelOf(body, inviscid, withAngle(2));
  EXPECT_EQ(in_air.packed_faces, nullptr);
  EXPECT_NE(in_air.sphere_table, nullptr);
  EXPECT_NE(wetted.sphere_table, nullptr);
  EXPECT_EQ(modelOf(body, water()).sphere_table, in_air.sphere_table) << "one for all";
}

TEST(LoadPlan, FacesAreKeptInOnePrecision) {
  const FluidBody body = ball(0);
  EXPECT_NE(modelOf(body, air()).packed_faces, nullptr);
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  EXPECT_EQ(modelOf(body, air(), flow).packed_faces, nullptr);
}

TEST(LoadPlan, ASphereAwayFromTheCentreOfMassIsLoadedAsItsMesh) {
  FrameOffset frame;
  Arbitrary arbitrary(5);
  frame.rotation = arbitrary.rotation();
  frame.translation = {0.1, -0.2, 0.05};
  FluidBody faces = ball(0), sphere = ball();
  for (FluidBody* body : {&faces, &sphere}) {
    const Vector3 centre(0.04, 0.02, -0.03);
    body->centre_of_volume = centre;
    for (std::size_t i = 0; i < body->faces.size(); ++i) {
      body->faces.centroid_x[i] += centre.x();
      body->faces.centroid_y[i] += centre.y();
      body->faces.centroid_z[i] += centre.z();
    }
  }
  for (const double angle : {kRightAngle, 1.5 * kRightAngle}) {
    const BodyModel of_faces = modelOf(faces, air(), withAngle(angle), frame);
    const BodyModel of_sphere = modelOf(sphere, air(), withAngle(angle), frame);
    for (int i = 0; i < 20; ++i) {
      const Twist twist = arbitrary.twist(1 / kRadius);
      const Wrench expected = computeSurfaceLoad(of_faces, twist).wrench;
      const Wrench found = computeSurfaceLoad(of_sphere, twist).wrench;
      const double scale = 1.2 * kRadius * kRadius *
                           (twist.linear.squaredNorm() + twist.angular.squaredNorm() * 0.09);
      EXPECT_LT((found.force - expected.force).norm(), 0.02 * scale);  // of the mesh
      EXPECT_LT((found.torque - expected.torque).norm(), 0.02 * kRadius * scale);
    }
  }
}

TEST(LoadPlan, RefusesARadiusThatIsNotPossible) {
  EXPECT_THROW(modelOf(ball(-1), air()), std::invalid_argument);
}

}  // namespace
}  // namespace ambient::test
