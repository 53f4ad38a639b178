#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

// Tethers as docs/thrusters.md describes them.
namespace ambient::test {
namespace {

constexpr double kStep = 1.0 / 60;
const Vector3 kVehicleAxes(0.2, 0.17, 0.0774);

/// A vehicle on a tether of 10 m: links as dense as the water, the vehicle the last of them, in one
/// btMultiBody with a fixed base, where it hangs straight down in a current.
class TetheredVehicle {
 public:
  /// `weight`: of the vehicle in the water [kg].
  TetheredVehicle(double current, double weight) {
    in_.world.getSolverInfo() = btContactSolverInfo();
    in_.world.setGravity({0, 0, bt(-9.81)});
    const Vector3 axes(0.005, 0.005, kHalf);
    const auto link = std::make_shared<FluidBody>(meshedEllipsoid(axes, 1));
    const auto vehicle = std::make_shared<FluidBody>(meshedEllipsoid(kVehicleAxes, 2));
    for (int i = 0; i < kLinks; ++i) setUp(i, axes, kDensity * link->volume);
    setUp(kLinks, kVehicleAxes, 11 + weight);
    body_.finalizeMultiDof();
    body_.setLinearDamping(0);
    body_.setAngularDamping(0);
    in_.world.addMultiBody(&body_);
    const Medium medium{kDensity, 0.001, {current, 0, 0}, {0, 0, 0}};
    for (int i = 0; i <= kLinks; ++i)
      in_.fluid.add(body_, i, {i < kLinks ? link : vehicle, medium});
  }
  ~TetheredVehicle() { in_.world.removeMultiBody(&body_); }

  void step(double step) { in_.step(step); }
  Vector3 place() { return toVector3(body_.localPosToWorld(kLinks, {0, 0, 0})); }
  /// Distance of the vehicle's eye from the end of the tether [m].
  double gap() {
    const btVector3 eye = body_.localPosToWorld(kLinks, {0, 0, bt(kVehicleAxes.z())});
    return static_cast<double>(
        (eye - body_.localPosToWorld(kLinks - 1, {0, 0, bt(-kHalf)})).length());
  }

 private:
  static constexpr int kLinks = 20;
  static constexpr double kHalf = 0.25, kDensity = 1000;

  void setUp(int link, const Vector3& axes, double mass) {
    const btVector3 below(0, 0, link == 0 ? 0 : bt(-kHalf)), above(0, 0, bt(-axes.z()));
    body_.setupSpherical(link, bt(mass), toBullet(ellipsoidMoments(axes, mass)), link - 1,
                         btQuaternion::getIdentity(), below, above, true);
  }

  RobotWorld in_;
  btMultiBody body_{kLinks + 1, 0, {0, 0, 0}, true, false};
};

/// The largest gap [m] and speed [m/s] of the vehicle within 20 s, and its place at the end [m].
struct TetherRun {
  double gap = 0, speed = 0;
  Vector3 place{0, 0, 0};
};

TetherRun hang(double current, double weight, double step) {
  TetheredVehicle in(current, weight);
  TetherRun run;
  run.place = in.place();
  for (int i = 0; i < 20 / step; ++i) {
    in.step(step);
    run.gap = std::max(run.gap, in.gap());
    run.speed = std::max(run.speed, (in.place() - run.place).norm() / step);
    run.place = in.place();
  }
  return run;
}

TEST(Drive, ATetherOfLinksHoldsAVehicle) {
  for (const auto& [current, weight] : {std::pair(1.5, 0.0), {0.5, 90.0}}) {
    const TetherRun run = hang(current, weight, kStep), fine = hang(current, weight, kStep / 4);
    EXPECT_LT(run.gap, byPrecision(1e-13, 1e-4));
    EXPECT_LT(run.speed, 1.3 * current);  // the current takes it along, the tether swings it round
    EXPECT_LT((run.place - fine.place).norm(), 0.03) << current << " m/s, " << weight << " kg";
  }
}

}  // namespace
}  // namespace ambient::test
