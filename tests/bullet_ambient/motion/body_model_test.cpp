#include "bullet_ambient/motion/body/body_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Input {
  FluidBody shape = test::facelessEllipsoid({0.3, 0.2, 0.1});
  FrameOffset frame;
  MassProperties mass{2.0, Vector3(0.1, 0.2, 0.25).asDiagonal()};
  Medium medium = water();
  FlowSettings flow;

  BodyModel make() const { return test::modelOf({shape, mass, medium, flow, frame}); }
};

TEST(BodyModel, AddsTheFluidsInertiaToTheBodys) {
  Input input;
  test::Arbitrary arbitrary(1);
  input.frame = {arbitrary.rotation(), arbitrary.vector(0.1)};
  const BodyModel model = input.make();
  Matrix6 expected = Matrix6::Zero();
  expected.diagonal() << 0.1, 0.2, 0.25, 2, 2, 2;
  expected += 998.0 * input.frame.inertiaToB(input.shape.added_mass);
  EXPECT_LT((model.inertia - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(model.inertia, Matrix6(model.inertia.transpose()));
  EXPECT_LT((model.inertia * model.inverse_inertia - Matrix6::Identity()).cwiseAbs().maxCoeff(),
            1e-12);
  EXPECT_DOUBLE_EQ(model.displaced_mass, 998.0 * input.shape.volume);
}

TEST(BodyModel, PutsTheCentreOfVolumeIntoBodyAxes) {
  Input input;
  input.shape.centre_of_volume = {0.1, 0, 0};
  input.frame.rotation = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()).matrix();
  input.frame.translation = {0, 0, 0.5};
  EXPECT_LT((input.make().centre_of_volume - Vector3(0, 0.1, 0.5)).norm(), 1e-15);
}

// Closed forms of docs/theory.md eq. (134): the moments of a room that turns with its fluid.
TEST(BodyModel, FullHoldsMoveWithTheBodyAndDisplaceNothing) {
  Input input;
  const BodyModel closed = input.make();
  Hold hold;
  hold.volume = 0.4 * input.shape.volume;
  hold.centre = {0, 0, 0.05};
  hold.turning_inertia = Vector3(1e-5, 2e-5, 3e-5).asDiagonal();
  input.shape.holds = {hold};
  const BodyModel full = input.make();
  EXPECT_DOUBLE_EQ(full.displaced_mass, 0.6 * closed.displaced_mass);
  EXPECT_NEAR(full.centre_of_volume.z(), -0.4 * 0.05 / 0.6, 1e-15);
  const Matrix6 inside = full.inertia - closed.inertia;
  const double mass = 998 * hold.volume;
  EXPECT_NEAR(inside(3, 3), mass, 1e-12 * mass);
  EXPECT_NEAR(inside(0, 0), 998 * 1e-5 + mass * 0.05 * 0.05, 1e-12);
  EXPECT_NEAR(inside(2, 2), 998 * 3e-5, 1e-12);
  // A force in x at the origin meets a mass that lies above it: momentum of turning about y.
  EXPECT_NEAR(inside(1, 3), mass * 0.05, 1e-12 * mass);
  const BodyModel sealed = makeBodyModel(input.shape, input.frame, input.mass, input.medium,
                                         full.loads, {HoldContent::kSealed});
  EXPECT_EQ(sealed.inertia, closed.inertia);
  EXPECT_EQ(sealed.displaced_mass, closed.displaced_mass);
}

struct BadInput {
  std::function<void(Input&)> spoil;
  std::string what, limit;  // message must contain both
};

TEST(BodyModel, RejectsInputThatIsNotPhysicalInOneSentence) {
  const BadInput cases[] = {
      {[](Input& i) { i.mass.mass = 0; }, "mass [kg] is 0", "positive"},
      {[](Input& i) { i.mass.mass = -3; }, "mass [kg] is -3", "positive"},
      {[](Input& i) { i.mass.mass = kNan; }, "mass [kg] is nan", "finite"},
      {[](Input& i) { i.mass.mass = kInfinity; }, "mass [kg] is inf", "finite"},
      {[](Input& i) { i.mass.inertia(1, 1) = kInfinity; }, "moment of inertia [kg m^2] is inf",
       "finite"},
      {[](Input& i) { i.mass.inertia(1, 1) = kNan; }, "moment of inertia [kg m^2] is nan",
       "finite"},
      {[](Input& i) { i.mass.inertia(1, 1) = 0; }, "moment of inertia [kg m^2] is 0", "positive"},
      {[](Input& i) { i.mass.inertia(1, 1) = -0.5; }, "moment of inertia [kg m^2] is -0.5",
       "positive"},
      {[](Input& i) { i.medium.density = -1; }, "density of the medium [kg/m^3] is -1",
       "zero or positive"},
      {[](Input& i) { i.medium.density = kNan; }, "density of the medium [kg/m^3] is nan",
       "finite"},
      {[](Input& i) { i.medium.viscosity = -1e-3; }, "viscosity of the medium [Pa s] is -0.001",
       "from 0 to 1e24"},
      {[](Input& i) { i.medium.velocity.y() = kNan; }, "speed of the medium [m/s] is nan",
       "finite"},
      {[](Input& i) { i.medium.acceleration.z() = kInfinity; },
       "acceleration of the medium [m/s^2] is inf", "finite"},
      {[](Input& i) { i.flow.separation_angle = 1.5; }, "separation angle [rad] is 1.5", "pi/2"},
      {[](Input& i) { i.flow.separation_angle = 3.2; }, "separation angle [rad] is 3.2", "pi"},
      {[](Input& i) { i.flow.separation_angle = kNan; }, "separation angle [rad] is nan", "pi"},
      {[](Input& i) { i.shape.volume = -1; }, "volume [m^3] is -1", "zero or positive"},
      {[](Input& i) { i.shape.area = kNan; }, "wetted area [m^2] is nan", "finite"},
      {[](Input& i) { i.shape.centre_of_volume.x() = kNan; }, "centre of volume [m] is nan",
       "finite"},
      {[](Input& i) { i.shape.centre_of_volume.y() = 1e60; },
       "centre of volume from the centre of mass [m] is 1e+60", "2^23 times its size"},
      {[](Input& i) { i.frame.translation.z() = 1e7; }, "centre of mass [m] is 1e+07",
       "2^23 times its size"},
      {[](Input& i) { i.shape.added_mass(3, 3) = kNan; }, "added inertia is nan", "finite"},
      {[](Input& i) { i.shape.added_mass(3, 3) = -1; }, "added inertia is", "positive definite"},
      {[](Input& i) { i.frame.translation.x() = kInfinity; }, "centre of mass [m] is inf",
       "finite"},
      {[](Input& i) { i.frame.rotation *= 2; }, "rotation matrix is 3", "1e-6"},
      {[](Input& i) { i.frame.rotation(2, 2) = -1; },
       "determinant of its frame's rotation matrix is -1", "1: a rotation, not a mirror"},
  };
  for (const BadInput& bad : cases) {
    Input input;
    bad.spoil(input);
    const std::string text = test::refusalOf<std::invalid_argument>([&] { input.make(); });
    EXPECT_NE(text.find("fluid body 'ellipsoid'"), std::string::npos) << bad.what << text;
    EXPECT_NE(text.find(bad.what), std::string::npos) << text;
    EXPECT_NE(text.find(bad.limit), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST(BodyModel, TakesARightAngleThatWasWrittenByHand) {
  for (const double angle : {1.570796327, 1.57079632679, std::acos(-1.0) / 2}) {
    Input input;
    input.flow.separation_angle = angle;
    EXPECT_NO_THROW(input.make()) << angle;
  }
}

TEST(BodyModel, WithoutFluidIsTheRigidBody) {
  Input input;
  input.medium.density = 0;
  const BodyModel model = input.make();
  EXPECT_EQ(model.displaced_mass, 0);
  EXPECT_EQ(model.inertia, rigidBodyInertia(2.0, input.mass.inertia));
}

TEST(SurfaceLoad, OnAConeMovingBaseFirstHasNoPositivePower) {
  // Above pi/2 the flanks of a tapered body push forward: the guard acts.
  Input input;
  input.shape.faces = {};
  input.shape.faces.add({0, 0, 1}, {0, 0, 0.1}, 0.01);
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::acos(-1.0) / 4;
    const Vector3 normal = Vector3(std::cos(angle), std::sin(angle), -0.3).normalized();
    input.shape.faces.add(normal, {0.05 * std::cos(angle), 0.05 * std::sin(angle), 0}, 0.01);
  }
  input.flow.law = PressureLaw::kPublished;
  input.flow.separation_angle = 2.5;
  const BodyModel model = input.make();
  const Twist x{{0, 0, 0}, {0, 0, 1}};
  const SurfaceLoad load = computeSurfaceLoad(model, x);
  EXPECT_TRUE(load.guarded);
  EXPECT_LE(power(load.wrench, x), 1e-15);
}

}  // namespace
}  // namespace ambient
