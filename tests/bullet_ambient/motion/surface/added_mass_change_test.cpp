#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/floating_kernel.h"
#include "demos/integrators/integrators.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/floating_runs.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

constexpr double kHuge = 1e30;  // gravity; Froude number of any entry: 0

/// Change of inertia in a passage.
struct Change {
  Change(const Matrix6& from, const Matrix6& to)
      : before(from), after(to), inverse(Matrix6(test::inverse(to))) {}

  SymmetricMatrix before, after, inverse;
};

BoundedTwist passed(const AddedMassChangeOf<double>& passage, const Vector6& x) {
  const AfterChangeOf<double> end = applyAddedMassChange(passage, plain(x));
  return {asEigen(end.twist), end.energy_removed};
}

/// Speed of a falling body of 1 kg at depth 1, added mass d^2 along z at depth d. Steps are equal
/// in depth, so unequal in time.
double speedAfterEntry(double gravity, double start, int steps) {
  double speed = start;
  const double step = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const double from = i * step, to = from + step, duration = step / speed;
    const auto inertiaAt = [](double depth) {
      Matrix6 K = Matrix6::Identity();
      K(5, 5) += depth * depth;
      return K;
    };
    const Change K(inertiaAt(from), inertiaAt(to));
    Vector6 x = Vector6::Zero();
    x[5] = -speed;
    const double by_height = 0.5 * 2 * from * speed * speed;
    const AddedMassChangeOf<double> passage{
        K.before, K.after, K.inverse, {{0, 0, 0}, {0, 0, -by_height}}, {0, 0, 1}, {0, 0, 0}, to,
        to - 10,  gravity, duration};
    speed = -passed(passage, x).twist[5];
  }
  return speed;
}

TEST(SurfacePassage, KeepsMomentumWhereItIsFastAndEnergyWhereItIsSlow) {
  // (m + K) v = m v_0 with K = 1 at the end; without inertia forces (m + K) v^2 = m v_0^2.
  EXPECT_NEAR(speedAfterEntry(0, 2, 100), 1, 1e-12);
  EXPECT_NEAR(speedAfterEntry(kHuge, 2, 100), std::sqrt(2), 2e-2);
  EXPECT_NEAR(speedAfterEntry(kHuge, 2, 1000), std::sqrt(2), 2e-3);
}

// At a Froude number of infinity all momentum of a body that sinks goes into spray: the force that
// returns it acts at the centre of buoyancy, eq. (67).
TEST(SurfacePassage, SprayTakesMomentumAtTheCentreOfBuoyancy) {
  const Matrix6 before = Matrix6::Identity();
  Matrix6 after = before;
  after(5, 5) = 1.1;
  const Change K(before, after);
  Vector6 x = Vector6::Zero();
  x[5] = -2;
  const AddedMassChangeOf<double> passage{
      K.before, K.after, K.inverse, {{0, 0, 0}, {0, 0, -10}}, {0, 0, 1}, {0.3, 0, 0}, 1,
      -9,       0,       0.01};
  Vector6 change = Vector6::Zero();  // c x n dt 10 N
  change[1] = -0.03;
  EXPECT_LT((after * passed(passage, x).twist - before * x - change).norm(), 1e-15);
}

TEST(SurfacePassage, NeverAddsEnergyWhateverChanges) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 300; ++i) {
    const Matrix6 before = arbitrary.positiveDefinite(), after = arbitrary.positiveDefinite();
    const Change K(before, after);
    const Vector6 x = arbitrary.twist().vector();
    const AddedMassChangeOf<double> passage{K.before,
                                            K.after,
                                            K.inverse,
                                            plain(arbitrary.twist(10, 10).vector()),
                                            plain(Vector3(arbitrary.vector().normalized())),
                                            plain(arbitrary.vector()),
                                            arbitrary.between(-1, 1),
                                            arbitrary.between(-1, 1),
                                            arbitrary.between(0, 10),
                                            arbitrary.between(0, 1)};
    const Vector6 end = passed(passage, x).twist;
    EXPECT_LE(end.dot(after * end), x.dot(before * x) * (1 + 1e-12));
  }
}

// Without gradient the momentum is conserved: K_1^-1 K_0 x, except for the bound.
TEST(SurfacePassage, TellsTheEnergyThatItRemoves) {
  test::Arbitrary arbitrary(3);
  for (int i = 0; i < 100; ++i) {
    const Matrix6 before = arbitrary.positiveDefinite();
    const Matrix6 after = (i % 2 == 0 ? 0.5 : 1.5) * before;
    const Matrix6 inverse = test::inverse(after);
    const Vector6 x = arbitrary.twist().vector(), end = inverse * (before * x);
    const double had = x.dot(before * x) / 2, gain = end.dot(after * end) / 2 - had;
    EXPECT_EQ(gain > 0, i % 2 == 0);
    const Change K(before, after);
    const AddedMassChangeOf<double> passage{K.before,  K.after,   K.inverse, {{0, 0, 0}, {0, 0, 0}},
                                            {0, 0, 1}, {0, 0, 0}, 1,         1,
                                            9.81,      0.01};
    EXPECT_NEAR(passed(passage, x).energy_removed, std::max(0.0, gain), 1e-11 * had) << i;
  }
}

TEST(SurfacePassage, LeavesABodyAloneWhoseInertiaStays) {
  test::Arbitrary arbitrary(2);
  const Matrix6 inertia = arbitrary.positiveDefinite();
  const Change K(inertia, inertia);
  const Vector6 x = arbitrary.twist().vector();
  const AddedMassChangeOf<double> passage{
      K.before, K.after, K.inverse, {{1, 2, 3}, {4, 5, 6}}, {0, 0, 1}, {0, 0, 0}, 1, 1, 9.81, 0.01};
  EXPECT_EQ(passed(passage, x).twist, x);
  EXPECT_EQ(passed(passage, x).energy_removed, 0);
}

// Light bodies that leave the water or fall into it, at steps of games, beside the limit of short
// steps.

using test::FloatingDef;
using test::FloatingRun;

constexpr double kShort = 1 / 4000.0;  // [s]
constexpr double kSteps[] = {1 / 30.0, 1 / 60.0, 1 / 75.0, 1 / 144.0, 1 / 240.0};

struct Leap {
  double apex = 0;      ///< height of the centre of mass [m]
  int substeps = 0;     ///< from the start on
  int largest = 0;      ///< number of substeps of one step
  bool gained = false;  ///< the energy has grown in a step
};

/// Lets a body go at a depth and follows it to its highest point. A parabola through the last three
/// heights has the apex.
Leap leapFrom(const FloatingDef& def, double depth, double step, const FlightSettings& settings) {
  FloatingRun body(def);
  body.settings = settings;
  body.state.position = {0, 0, -depth};
  Leap leap;
  double before = -depth, now = -depth, energy = body.energy();
  for (double time = 0; time < 3; time += step) {
    body.step(step);
    leap.substeps += body.count.substeps;
    leap.largest = std::max(leap.largest, body.count.substeps);
    const double left = body.energy(), scale = body.mass() * def.gravity * depth;
    leap.gained = leap.gained || left > energy + 1e-9 * scale;
    energy = left;
    const double next = body.state.position.z(), bend = before - 2 * now + next;
    if (next < now && now > 0) {
      leap.apex = now - (next - before) * (next - before) / (8 * bend);
      return leap;
    }
    before = now;
    now = next;
  }
  ADD_FAILURE() << "does not leap";
  return leap;
}

struct Leaper {
  const char* name;
  FluidBody shape;
};

std::vector<Leaper> leapers() {
  return {{"ball", test::floatingBall(0.5)},
          {"box", test::floatingBox({0.8, 0.8, 0.8})},
          {"ellipsoid", test::floatingEllipsoid({0.3, 0.3, 0.5}, 2)}};
}

FloatingDef leaperDef(const Leaper& leaper, double specific_gravity, bool has_loads) {
  FloatingDef def{leaper.shape, specific_gravity};
  def.gyration = Vector3::Constant(0.3);
  def.has_loads = has_loads;
  return def;
}

TEST(SurfaceLeap, IsAsHighAtLongStepsAsAtShortOnes) {
  for (const Leaper& leaper : leapers()) {
    for (const double specific_gravity : {0.1146, 0.4}) {
      for (const bool has_loads : {false, true}) {
        const FloatingDef def = leaperDef(leaper, specific_gravity, has_loads);
        const double limit = leapFrom(def, 1.5, kShort, {}).apex;
        for (const double step : kSteps) {
          const Leap leap = leapFrom(def, 1.5, step, {});
          EXPECT_NEAR(leap.apex, limit, 0.03 * limit)
              << leaper.name << ", " << specific_gravity << ", loads " << has_loads << ", " << step;
          EXPECT_FALSE(leap.gained) << leaper.name << ", " << step;
        }
      }
    }
  }
}

// In a fluid without loads nothing but the change of the added mass asks for substeps.
TEST(SurfaceLeap, ToleranceSeesTheWayOut) {
  const FloatingDef def = leaperDef(leapers()[0], 0.1146, false);
  FlightSettings fine;
  fine.tolerance = 1e-5;
  fine.max_substeps = 256;
  const double limit = leapFrom(def, 1.5, kShort, {}).apex;
  const Leap usual = leapFrom(def, 1.5, 1 / 60.0, {}), exact = leapFrom(def, 1.5, 1 / 60.0, fine);
  EXPECT_GT(usual.largest, 1);
  EXPECT_GT(exact.substeps, 3 * usual.substeps);
  EXPECT_NEAR(exact.apex, limit, 0.001 * limit);
}

using test::FreeBody;
using test::FreeBodyDef;

// Drag c |v| v against the velocity of a sphere's centre.
class QuadraticDrag : public SurfaceLoads {
 public:
  explicit QuadraticDrag(double coefficient) : coefficient_(coefficient) {}
  Wrench load(const Twist& twist) const noexcept override {
    return {Vector3::Zero(), -coefficient_ * twist.linear.norm() * twist.linear};
  }

 private:
  double coefficient_;
};

class Thrust : public SurfaceLoads {
 public:
  Wrench load(const Twist& twist) const noexcept override {
    return {Vector3::Zero(), 3 * twist.linear};
  }
};

FreeBody ballUnder(std::shared_ptr<const SurfaceLoads> loads, OwnFlight integrator) {
  FreeBodyDef def;
  Matrix6 added = Matrix6::Zero();
  added.bottomRightCorner<3, 3>() = 0.5 * Matrix3::Identity();
  def.shape = test::shapeWithoutFaces(added);
  def.flow.own_law = [loads = std::move(loads)](const auto&, const LoadSettings&) { return loads; };
  FreeBody ball(def);
  ball.settings.own_flight = integrator;
  ball.state.twist.linear = {3, 0, 4};
  return ball;
}

TEST(LoadLaw, SlowsABodyByItsOwnLaw) {
  const double c = 0.2, m = 1.5, speed = 5, time = 2;
  for (const OwnFlight integrator : std::initializer_list<OwnFlight>{nullptr, flyRungeKutta}) {
    FreeBody ball = ballUnder(std::make_shared<QuadraticDrag>(c), integrator);
    ball.advance(time / 240, 240);
    const double exact = speed / (1 + c / m * speed * time);
    EXPECT_NEAR(ball.state.twist.linear.norm(), exact, 1e-9);
    EXPECT_NEAR(ball.state.position.norm(), m / c * std::log1p(c / m * speed * time), 1e-4);
  }
}

TEST(LoadLaw, CannotFeedTheBody) {
  FreeBody ball = ballUnder(std::make_shared<Thrust>(), nullptr);
  const double before = ball.kineticEnergy();
  ball.advance(1.0 / 60, 60);
  EXPECT_NEAR(ball.kineticEnergy(), before, 1e-12 * before);
  EXPECT_GT(ball.count.guarded, 0);
}

}  // namespace
}  // namespace ambient
