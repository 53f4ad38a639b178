#include "preprocess/hand_over/glide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "preprocess/polar/polar.h"
#include "tests/support/bodies/named_parts.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

constexpr double kAirDensity = 1.2, kFreeFall = 9.81, kPitchInertia = 0.03;  // about left [kg m^2]

std::shared_ptr<const FluidBody> builtPlateAeroplane() {
  static const auto body =
      std::make_shared<const FluidBody>(built(PlateAeroplane().parts(), "auto"));
  return body;
}

/// With its centre of mass ahead of the wing's quarter chord [m].
HandedBody planeOf(double mass, double ahead) {
  ExportSettings settings;
  settings.medium = {kAirDensity, 1.8e-5, Vector3::Zero(), Vector3::Zero()};
  settings.gravity = kFreeFall;
  settings.mass = mass;
  settings.centre_of_mass = Vector3(ahead, 0, 0);
  HandedBody body = handedBody(builtPlateAeroplane(), settings);
  body.inertia = Vector3(0.02, kPitchInertia, 0.05).asDiagonal();
  return body;
}

/// Slope of the lift of a wing by Helmbold.
double helmbold(double aspect) { return 2 * kPi * aspect / (2 + std::sqrt(4 + aspect * aspect)); }

/// Numbers of the aeroplane by hand: slopes of wing and tail (Helmbold), downwash of an elliptic
/// wing at the tail. Per area of the wing.
struct ByHand {
  PlateAeroplane plane;
  double wing = helmbold(plane.span / plane.chord);
  double downwash = wing / (kPi * plane.span / plane.chord) *
                    (1 + plane.tail_arm / std::hypot(plane.tail_arm, plane.span / 2));
  double tail_alone = helmbold(plane.tail_span / plane.tail_chord) * plane.tail_span *
                      plane.tail_chord / (plane.span * plane.chord);
  double tail = tail_alone * (1 - downwash);
  double neutral() const { return -plane.tail_arm * tail / (wing + tail); }
  /// What the tail adds to the static margin while the aeroplane turns about it [m].
  double turning(double mass) const {
    const double area = plane.span * plane.chord;
    return kAirDensity * area * tail_alone * plane.tail_arm * plane.tail_arm / (2 * mass);
  }
};

TEST(Glide, OfATrimLeavesNeitherForceNorMoment) {
  const HandedBody body = planeOf(0.45, 0);
  const GlidePlan plan = planGlide(body);
  ASSERT_TRUE(plan.trim);
  const Glide& trim = *plan.trim;
  PolarFlight flight;
  flight.density = kAirDensity;
  flight.speed = trim.speed;
  flight.reference = {1, 1};
  flight.added_mass = body.shape->added_mass.bottomRightCorner<3, 3>();
  const BodyLoads loads(body.shape, body.settings.medium, {});
  const auto [lift, drag, side, roll, pitch, yaw] =
      polarCoefficients(loads, flight, trim.incidence, 0);
  const double weight = (0.45 - kAirDensity * body.shape->volume) * kFreeFall;
  const double pressure = kAirDensity / 2 * trim.speed * trim.speed;
  EXPECT_NEAR(pressure * std::hypot(lift, drag), weight, 1e-9 * weight);
  EXPECT_NEAR(trim.ratio, lift / drag, 1e-9 * trim.ratio);
  EXPECT_NEAR(std::tan(trim.angle), drag / lift, 1e-9);
  // Buoyancy at the centre of volume turns a little, which the polar has not.
  const Vector3 buoyancy = -kAirDensity * body.shape->volume * trim.gravity;
  const double turned = -body.shape->centre_of_volume.cross(buoyancy).y();
  EXPECT_NEAR(pressure * pitch + turned, 0, 1e-9 * weight);
}

// The hull and what stands between the halves of a wing are not in the numbers by hand: some 3 %.
TEST(Glide, OfFlatPlatesIsNeutralWhereSlopesAndTailVolumeSay) {
  const ByHand hand;
  for (const double mass : {0.45, 4.5}) {
    const GlidePlan plan = planGlide(planeOf(mass, 0.01));
    ASSERT_TRUE(plan.trim);
    EXPECT_NEAR(plan.stability.neutral_point.x(), hand.neutral(), 0.03 * hand.plane.chord) << mass;
    EXPECT_NEAR(plan.stability.static_margin, 0.01 - plan.stability.neutral_point.x(), 1e-12);
  }
}

// Lanchester: sqrt(2) g/V. An aeroplane that turns on its way up and down feels its tail too, which
// is much of a light one: times the root of static over manoeuvre margin.
TEST(Glide, OfFlatPlatesHasLanchestersPhugoid) {
  const ByHand hand;
  for (const double mass : {0.45, 4.5, 45.0}) {
    const HandedBody body = planeOf(mass, 0.02);
    const GlidePlan plan = planGlide(body);
    ASSERT_TRUE(plan.trim);
    ASSERT_EQ(plan.stability.pitching.swings.size(), 2u);
    const Swing &quick = plan.stability.pitching.swings[0],
                &slow = plan.stability.pitching.swings[1];
    const double margin = plan.stability.static_margin, manoeuvre = margin + hand.turning(mass);
    const double lanchester = std::sqrt(2) * kFreeFall / plan.trim->speed;
    EXPECT_NEAR(slow.frequency / (lanchester * std::sqrt(margin / manoeuvre)), 1, 0.05) << mass;
    const double lift = kAirDensity / 2 * plan.trim->speed * plan.trim->speed * hand.plane.span *
                        hand.plane.chord * (hand.wing + hand.tail);
    const double inertia = kPitchInertia + body.added_mass(1, 1);
    EXPECT_NEAR(quick.frequency / std::sqrt(lift * manoeuvre / inertia), 1, 0.1) << mass;
  }
}

TEST(Glide, FindsNoTrimWhereTheMassIsTooFarBack) {
  const GlidePlan plan = planGlide(planeOf(0.45, -0.3));
  EXPECT_FALSE(plan.trim);
  EXPECT_TRUE(plan.goes_nose_up);
  ASSERT_TRUE(plan.best) << "whatever the moment";
  EXPECT_GT(plan.best->ratio, 4);
}

// Turned upside down in place of gravity: as much lighter than the fluid as it is heavier here.
TEST(Glide, OfWhatRisesIsThatOfWhatSinksUpsideDown) {
  const auto plate = std::make_shared<FluidBody>(
      built({{"wing", box({-0.2, -1, -0.02}, {0.2, 1, 0.02})}}, "auto"));
  ExportSettings settings;
  settings.centre_of_mass = Vector3(0.09, 0, 0);
  settings.medium.density = 1000;
  settings.mass = 1.5 * 1000 * plate->volume;
  const GlidePlan sinks = planGlide(handedBody(plate, settings));
  settings.mass = 0.5 * 1000 * plate->volume;
  const GlidePlan rises = planGlide(handedBody(plate, settings));
  ASSERT_TRUE(sinks.best && rises.best);
  EXPECT_NEAR(rises.best->incidence, -sinks.best->incidence, 1e-9);
  EXPECT_NEAR(rises.best->ratio, sinks.best->ratio, 1e-6);
  EXPECT_NEAR(rises.best->angle, -sinks.best->angle, 1e-6);
  settings.mass = 1000 * plate->volume;
  EXPECT_EQ(refusalOf<std::invalid_argument>([&] { planGlide(handedBody(plate, settings)); }),
            "fluid body 'body': mass [kg] is 32, must be other than that of the displaced fluid");
}

}  // namespace
}  // namespace ambient::test
