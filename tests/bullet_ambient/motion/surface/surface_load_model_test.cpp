#include <gtest/gtest.h>

#include <cmath>

#include "demos/integrators/integrators.h"
#include "tests/support/bodies/free_body.h"

namespace ambient {
namespace {

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
