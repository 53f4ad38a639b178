#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/worlds/vacuum_scene.h"
#include "tests/support/bodies/ellipsoid_body.h"

// A fluid without inertia or volume, through the full 6x6 path. Each step from a state of stock
// Bullet must end like stock Bullet, to rounding.
namespace ambient::test {
namespace {

constexpr int kSteps = 300;
constexpr double kVacuumTolerance = kDouble ? 3e-15 : 3e-7;
// In float Bullet turns a body with eight roundings, this library in double with one.
constexpr double kPoseTolerance = kDouble ? 3e-15 : 1e-6;
// A ball that hits a stack: rows amplify rounding. Measured: 1.5e-14, 3e-7.
constexpr double kStackTolerance = kDouble ? 3e-14 : 1e-6;

// Tells if the moments are equal. Other bodies turn differently from Bullet and stay dry here.
bool isRound(const btRigidBody& body) {
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  return inverse.x() == inverse.y() && inverse.y() == inverse.z();
}

AttachDef nothingButThePath() {
  AttachDef def;
  auto fluid_body = std::make_shared<FluidBody>();
  fluid_body->name = "nothing";
  fluid_body->area = 1;
  def.fluid_body = fluid_body;
  def.medium.density = 1;
  return def;
}

double speed(const btRigidBody& body) {
  return static_cast<double>(
      std::max(body.getLinearVelocity().length(), body.getAngularVelocity().length()));
}

double velocityDifference(const btRigidBody& a, const btRigidBody& b) {
  return static_cast<double>(std::max((a.getLinearVelocity() - b.getLinearVelocity()).length(),
                                      (a.getAngularVelocity() - b.getAngularVelocity()).length()));
}

// Difference of place. A body without contacts flies along a parabola; Bullet moves it by the
// velocity of the step's end.
double placeDifference(const btRigidBody& stock, const btRigidBody& ambient) {
  const Vector3 place = toVector3(stock.getWorldTransform().getOrigin());
  const Vector3 difference = toVector3(ambient.getWorldTransform().getOrigin()) - place;
  const Vector3 parabola(0, 0, 9.81 / 2 * kWorldStep * kWorldStep);
  return std::min(difference.norm(), (difference - parabola).norm()) / std::max(1.0, place.norm());
}

double turnDifference(const btRigidBody& a, const btRigidBody& b) {
  double sum = 0;
  for (int row = 0; row < 3; ++row)
    sum += static_cast<double>(
        (a.getWorldTransform().getBasis()[row] - b.getWorldTransform().getBasis()[row]).length2());
  return std::sqrt(sum);
}

class VacuumStep : public testing::TestWithParam<WorldSetup> {
 protected:
  VacuumStep() {
    for (VacuumScene* scene : {&stock_, &ambient_}) {
      if (isPivoting()) scene->host().world().getSolverInfo().m_minimumSolverBatchSize = 1;
      for (btRigidBody* body : scene->bodies()) {
        // Explicit form of Bullet's gyroscopic torque, equal to the one in the rows' velocity.
        body->setFlags(BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT);
        if (scene == &ambient_ && isRound(*body))
          ambient_.host().fluid().add(*body, nothingButThePath());
      }
    }
  }
  // Tells if the solver pivots. Impulses of a box on four contacts are not unique: pivoting solvers
  // find others after a rounding, also without fluid.
  static bool isPivoting() {
    return usesSolver(GetParam(), "Dantzig") || usesSolver(GetParam(), "Lemke");
  }
  void compare() {
    if (!isPivoting()) compare(stock_.bodies(), ambient_.bodies(), velocity_error_);
    compare(stock_.jointed(), ambient_.jointed(), jointed_velocity_error_);
  }
  void compare(const std::vector<btRigidBody*>& stock, const std::vector<btRigidBody*>& ambient,
               double& velocity_error) {
    double fastest = 1;
    for (const btRigidBody* body : stock) fastest = std::max(fastest, speed(*body));
    for (std::size_t i = 0; i < stock.size(); ++i) {
      velocity_error =
          std::max(velocity_error, velocityDifference(*stock[i], *ambient[i]) / fastest);
      pose_error_ = std::max({pose_error_, placeDifference(*stock[i], *ambient[i]),
                              turnDifference(*stock[i], *ambient[i])});
    }
  }

  VacuumScene stock_{GetParam().make(false)};
  VacuumScene ambient_{GetParam().make(true)};
  double velocity_error_ = 0, jointed_velocity_error_ = 0, pose_error_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Of, VacuumStep, testing::ValuesIn(allWorlds()), nameOf);

TEST_P(VacuumStep, EndsAsInStockBullet) {
  for (int step = 0; step < kSteps; ++step) {
    stock_.step(1);
    ambient_.step(1);
    compare();
    ambient_.takeStateOf(stock_);
  }
  // Lemke's solver may throw the stack apart in stock Bullet; joints remain.
  const int rows_per_step = usesSolver(GetParam(), "Lemke") ? 1 : 10;
  EXPECT_GT(ambient_.host().fluid().counters().rows, rows_per_step * kSteps);
  EXPECT_LT(velocity_error_, kStackTolerance);
  EXPECT_LT(jointed_velocity_error_, kVacuumTolerance);
  EXPECT_LT(pose_error_, kPoseTolerance);
}

}  // namespace
}  // namespace ambient::test
