#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "tests/support/bodies/body_models.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/random_bodies.h"

// Choice of the evaluation of a body's loads, made once with the loads.

namespace ambient::test {
namespace {

constexpr double kRadius = 0.3;
const double kRightAngle = FlowSettings{}.separation_angle;

FluidBody ball(double sphere_radius = kRadius) {
  FluidBody body = meshedEllipsoid(Vector3::Constant(kRadius), 4);
  body.sphere_radius = sphere_radius;
  return body;
}

std::shared_ptr<const SurfaceLoads> loadsOn(const FluidBody& body, const Medium& medium,
                                            const FlowSettings& flow = {}) {
  return makeSurfaceLoads(std::make_shared<const FluidBody>(body), medium, flow);
}

const Twist kTwist{{3, -2, 5}, {4, 1, -2}};

FlowSettings withAngle(double angle) {
  FlowSettings flow = publishedFlow();
  flow.separation_angle = angle;
  return flow;
}

TEST(LoadPlan, WithoutDensityOrSurfaceThereAreNone) {
  EXPECT_EQ(loadsOn(ball(0), Medium{}), nullptr);
  EXPECT_EQ(loadsOn(ball(), Medium{}), nullptr);
  EXPECT_EQ(loadsOn(facelessEllipsoid(Vector3::Constant(kRadius)), air()), nullptr);
}

TEST(LoadPlan, ABallSumsNoFacesByTheFormLawAndFeedsNoBody) {
  const auto loads = loadsOn(ball(), air());
  EXPECT_EQ(loads->faces(), 0);
  EXPECT_FALSE(loads->needsGuard());
  EXPECT_EQ(loadsOn(ball(), air(), publishedFlow())->faces(), 1152);
}

TEST(LoadPlan, FacesAreSummedInThePrecisionOfTheSettings) {
  const FluidBody body = ball(0);
  const double length = std::sqrt(body.area);
  FlowSettings flow;
  flow.law = PressureLaw::kPublished;
  const auto single = loadsOn(body, air(), flow);
  flow.precision = LoadPrecision::kDouble;
  const auto both = loadsOn(body, air(), flow);
  const LoadSettings settings = loadSettings(air(), flow);
  EXPECT_EQ(single->load(kTwist).vector(),
            computeFaceLoad(PackedFaces(body.faces), length, kTwist, settings).vector());
  const FaceLoads parts = computeFaceLoads(body.faces, length, kTwist, settings);
  EXPECT_EQ(both->load(kTwist).vector(), parts.total().vector());
  EXPECT_EQ(both->parts(kTwist).friction.vector(), parts.friction.vector());
  for (const auto& loads : {single, both}) EXPECT_EQ(loads->faces(), 5120);
}

TEST(LoadPlan, FacesNeedTheGuardBeyondARightAngle) {
  EXPECT_FALSE(loadsOn(ball(0), air())->needsGuard());
  EXPECT_TRUE(loadsOn(ball(0), air(), withAngle(2))->needsGuard());
}

TEST(LoadPlan, LoadsOutliveWhatTheyWereMadeOf) {
  for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble}) {
    auto body = std::make_shared<const FluidBody>(ball(0));
    FlowSettings flow;
    flow.precision = precision;
    const auto loads = makeSurfaceLoads(body, air(), flow);
    const Vector6 before = loads->load(kTwist).vector();
    body.reset();
    EXPECT_EQ(loads->load(kTwist).vector(), before);
  }
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
  Medium ideal = air();
  ideal.viscosity = 0;
  const MassProperties mass{2, 0.07 * Matrix3::Identity()};
  const BodyModel of_faces = modelOf({faces, mass, ideal, publishedFlow(), frame});
  const BodyModel of_sphere = modelOf({sphere, mass, ideal, publishedFlow(), frame});
  for (int i = 0; i < 20; ++i) {
    const Twist twist{{0, 0, 0}, arbitrary.vector()};
    const Wrench expected = computeSurfaceLoad(of_faces, twist).wrench;
    const Wrench found = computeSurfaceLoad(of_sphere, twist).wrench;
    const double scale =
        1.2 * kRadius * kRadius * (twist.linear.squaredNorm() + twist.angular.squaredNorm() * 0.09);
    EXPECT_LT((found.force - expected.force).norm(), 0.03 * scale);  // error of 1152 faces
    EXPECT_LT((found.torque - expected.torque).norm(), 0.03 * kRadius * scale);
  }
}

TEST(LoadPlan, RefusesARadiusThatIsNotPossible) {
  EXPECT_THROW(modelOf({ball(-1)}), std::invalid_argument);
}

struct Launch {
  Vector3 semi_axes;
  double mass;
  double separation_angle;
  RigidState start;
  double duration;
};

Vector3 endOf(const Launch& launch, int mesh_level, LoadPrecision precision) {
  const FluidBody shape = test::meshedEllipsoid(launch.semi_axes, mesh_level);
  FlowSettings flow;
  flow.separation_angle = launch.separation_angle;
  flow.precision = precision;
  const MassProperties mass{launch.mass,
                            test::ellipsoidMoments(launch.semi_axes, launch.mass).asDiagonal()};
  const BodyModel model = test::modelOf({shape, mass, air(), flow});
  Surroundings surroundings;
  surroundings.gravity = {0, 0, -9.81};
  surroundings.applied.force = launch.mass * surroundings.gravity;
  const FlightSettings settings;
  RigidState state = launch.start;
  FlightMemory memory;
  const double step = 1.0 / 240;
  for (double t = 0; t < launch.duration; t += step) {
    const FlightResult flight = fly({model, surroundings, settings, step}, state, memory);
    state = flight.state;
    memory = flight.memory;
  }
  return state.position;
}

void expectLessThanTheMesh(const Launch& launch, double part) {
  const Vector3 exact = endOf(launch, 3, LoadPrecision::kDouble);
  const double by_mesh = (endOf(launch, 4, LoadPrecision::kDouble) - exact).norm();
  const double by_precision = (endOf(launch, 3, LoadPrecision::kSingle) - exact).norm();
  EXPECT_LT(by_precision, part * by_mesh);
}

// Plate released nearly edge-on: flutters. Measured: 0.8 mm by mesh, 4 um by precision.
TEST(LoadPrecision, MovesAPlateByFarLessThanItsMeshDoes) {
  Launch plate{{0.05, 0.05, 0.01}, 2e-4, kPi / 2, {}, 1};
  plate.start.orientation = Quaternion(Eigen::AngleAxisd(85 * kPi / 180, Vector3::UnitY()));
  expectLessThanTheMesh(plate, 0.02);
}

// Measured: 0.34 m by mesh, 0.2 mm by precision.
TEST(LoadPrecision, MovesAGolfBallByFarLessThanItsMeshDoes) {
  Launch golf{Vector3::Constant(0.02135), 0.045, 1.5 * kPi / 2, {}, 3};
  const double angle = 10 * kPi / 180;
  golf.start.twist.linear = 53 * Vector3(std::cos(angle), 0, std::sin(angle));
  golf.start.twist.angular = {0, -2 * kPi * 42, 0};
  expectLessThanTheMesh(golf, 0.02);
}

}  // namespace
}  // namespace ambient::test
