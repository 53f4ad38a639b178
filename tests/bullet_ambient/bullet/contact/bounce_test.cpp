#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/robot_dynamics.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {
namespace {

// Bodies that bounce in ideal fluid on a floor at z = 0, whose energy would stay without the
// bounces.

constexpr double kRadius = 0.1, kHeight = 0.6;  // [m]
constexpr double kRates[] = {30, 60, 75, 120, 240};
constexpr double kMedia[] = {1.2, 998};  // [kg/m^3]
const Vector3 kBalls = Vector3::Constant(kRadius);

double volume() { return 4.0 / 3 * kPi * kRadius * kRadius * kRadius; }
double massOf(double density) { return std::max(3 * density, 100.0) * volume(); }

BodyDef bodyOf(double mass, double z, btCollisionShape& shape) {
  btVector3 moments(0, 0, 0);
  if (mass > 0) shape.calculateLocalInertia(bt(mass), moments);
  return {mass, toVector3(moments), startAt({0, 0, z}), &shape};
}

FluidBody ballOf(double radius) {
  FluidBody ball = facelessEllipsoid(Vector3::Constant(radius));
  ball.sphere_radius = radius;
  return ball;
}

// A world with a floor, whose bodies have a restitution.
struct BouncingWorld : FluidWorld {
  BouncingWorld(double of_floor) {
    world.setGravity({0, 0, bt(-kGravity)});
    add(bodyOf(0, -1, floor)).setRestitution(bt(of_floor));
  }
  // Adds a body in a fluid without friction.
  btRigidBody& bouncer(double mass, double z, btCollisionShape& shape, double density,
                       double restitution, const Vector3& axes = kBalls) {
    btRigidBody& body =
        FluidWorld::add(bodyOf(mass, z, shape), facelessEllipsoid(axes), idealFluid(density));
    body.setRestitution(bt(restitution));
    body.setFriction(0);
    return body;
  }
  btBoxShape floor{{5, 5, 1}};
};

double levelOf(const btRigidBody& body) {
  return static_cast<double>(body.getWorldTransform().getOrigin().z());
}
double riseOf(const btRigidBody& body) { return static_cast<double>(body.getLinearVelocity().z()); }

// Time until the body has come to rest [s].
template <class Step>
double timeToRest(const btRigidBody& body, double dt, const Step& step) {
  double last = 0;
  for (int i = 0; i * dt < 15; ++i) {
    step();
    if (std::abs(riseOf(body)) > 0.02) last = i * dt;
  }
  return last;
}

TEST(Bounce, KeepsNoMoreThanTheSquareOfTheRestitution) {
  btSphereShape ball{bt(kRadius)};
  for (const double density : kMedia)
    for (const double rate : kRates)
      for (const double restitution : {0.7, 0.8, 1.0}) {
        SCOPED_TRACE(testing::Message() << density << " " << rate << " " << restitution);
        BouncingWorld scene(1);
        const double mass = massOf(density);
        const btRigidBody& body =
            scene.bouncer(mass, kRadius + kHeight, ball, density, restitution);
        const double weight = (mass - density * volume()) * kGravity;
        // Where Bullet pushes it out of the floor, the way in the floor does not count.
        const auto energy = [&] {
          return scene.of(body).kineticEnergy() + weight * std::max(0.0, levelOf(body) - kRadius);
        };
        double before = energy(), rise = 0;
        const double rounding = byPrecision(1e-12, 1e-5) * before;
        int bounces = 0;
        for (int i = 0; i < 5 * rate; ++i) {
          scene.step(1 / rate);
          const double now = energy();
          if (rise < 0 && riseOf(body) > 0) {
            ASSERT_LE(now, restitution * restitution * before + rounding) << i;
            ++bounces;
          }
          before = now;
          rise = riseOf(body);
        }
        EXPECT_GT(bounces, 1);
      }
}

TEST(Bounce, EndsWhenItDoesInStockBullet) {
  btSphereShape ball{bt(kRadius)};
  for (const double density : kMedia)
    for (const double rate : kRates)
      for (const double restitution : {0.5, 0.8}) {
        SCOPED_TRACE(testing::Message() << density << " " << rate << " " << restitution);
        BouncingWorld scene(1), stock(1);
        const double mass = massOf(density), displaced = density * volume();
        const btRigidBody& body =
            scene.bouncer(mass, kRadius + kHeight, ball, density, restitution);
        btRigidBody& dry = stock.add(bodyOf(mass, kRadius + kHeight, ball));
        dry.setRestitution(bt(restitution));
        dry.setGravity({0, 0, bt(-kGravity * (mass - displaced) / (mass + displaced / 2))});
        const double ours = timeToRest(body, 1 / rate, [&] { scene.step(1 / rate); });
        const double theirs = timeToRest(dry, 1 / rate, [&] { stock.step(1 / rate); });
        EXPECT_LT(ours, 1.2 * theirs + 0.2);
        EXPECT_GT(ours, 0.4 * theirs);  // by chance, Bullet closes gaps at the cost of bounces
        EXPECT_NEAR(levelOf(body), kRadius, 0.01);
      }
}

// A box below a ball, held by the floor, has no weight to give away.
TEST(Bounce, OnWhatIsHeldEndsToo) {
  btSphereShape ball{bt(kRadius)};
  btBoxShape box{{bt(0.5), bt(0.5), bt(kRadius)}};
  for (const double density : kMedia)
    for (const double rate : kRates) {
      SCOPED_TRACE(testing::Message() << density << " " << rate);
      BouncingWorld scene(0);
      btRigidBody& lower = scene.bouncer(20 * massOf(density), kRadius, box, density, 1);
      const btRigidBody& body =
          scene.bouncer(massOf(density), 3 * kRadius + kHeight, ball, density, 0.8);
      EXPECT_LT(timeToRest(body, 1 / rate, [&] { scene.step(1 / rate); }), 7);
      EXPECT_NEAR(levelOf(body), 3 * kRadius, 0.02);
      EXPECT_LT(std::abs(riseOf(lower)), 0.02);
    }
}

// Boxes and long bodies that turn, of an added mass that differs by direction.
TEST(Bounce, OfBodiesThatTurnNeverGainsEnergy) {
  btBoxShape box{{bt(0.2), bt(0.1), bt(0.1)}};
  btCapsuleShape capsule{bt(0.08), bt(0.3)};
  for (btCollisionShape* shape :
       {static_cast<btCollisionShape*>(&box), static_cast<btCollisionShape*>(&capsule)})
    for (const double rate : kRates)
      for (const double restitution : {0.8, 1.0}) {
        SCOPED_TRACE(testing::Message() << shape->getName() << " " << rate << " " << restitution);
        BouncingWorld scene(1);
        const Vector3 axes(0.25, 0.1, 0.12);
        const double displaced = 998 * 4.0 / 3 * kPi * axes.prod(), mass = 3 * displaced;
        btRigidBody& body = scene.bouncer(mass, 0.8, *shape, 998, restitution, axes);
        body.setAngularVelocity({bt(0.5), bt(1), bt(0.3)});
        const double weight = (mass - displaced) * kGravity;
        const auto energy = [&] { return scene.of(body).kineticEnergy() + weight * levelOf(body); };
        const double first = energy();
        double lowest = first, most = 0;
        for (int i = 0; i < 10 * rate; ++i) {
          scene.step(1 / rate);
          const double now = energy();
          most = std::max(most, now - lowest);
          lowest = std::min(lowest, now);
        }
        // Bullet pushes corners out of the floor.
        EXPECT_LE(most, 0.03 * first);
        if (restitution < 1) {
          EXPECT_LT(body.getLinearVelocity().length(), bt(0.05));
        }
      }
}

bool bounceBy08(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                const btCollisionObjectWrapper*, int, int) {
  point.m_combinedRestitution = bt(0.8);
  return true;
}

TEST(Bounce, ByACallbackIsThatByTheBody) {
  btSphereShape ball{bt(kRadius)};
  const auto rises = [&](double restitution) {
    BouncingWorld scene(1);
    btRigidBody& body =
        scene.add(bodyOf(massOf(998), 0.3, ball), ballOf(kRadius), {998, 1, Vector3::Zero()});
    body.setRestitution(bt(restitution));
    body.setCollisionFlags(btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
    std::vector<double> speeds;
    for (int i = 0; i < 120; ++i) {
      scene.step(1.0 / 60);
      speeds.push_back(riseOf(body));
    }
    return speeds;
  };
  const std::vector<double> expected = rises(0.8);
  EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0.5);
  gContactAddedCallback = &bounceBy08;
  const std::vector<double> speeds = rises(0);
  gContactAddedCallback = nullptr;
  EXPECT_EQ(speeds, expected);
}

// A multibody of up to two balls on a hinge.
std::unique_ptr<btMultiBody> ballsOnAHinge(int links, double mass) {
  const btScalar inertia = bt(0.4 * mass * kRadius * kRadius);
  const btVector3 moments(inertia, inertia, inertia);
  auto robot = std::make_unique<btMultiBody>(links, bt(mass), moments, false, true);
  const btVector3 half(bt(1.2 * kRadius), 0, 0);
  if (links > 0)
    robot->setupRevolute(0, bt(mass), moments, -1, btQuaternion::getIdentity(), {0, 1, 0}, half,
                         half);
  robot->setHasSelfCollision(false);
  robot->setBasePos({0, 0, bt(kRadius + kHeight)});
  robot->setWorldToBaseRot(btQuaternion(btVector3(0, 1, 0), bt(0.3)));
  robot->finalizeMultiDof();
  return robot;
}

// A multibody in a fluid above a floor, both with restitution 0.8.
struct BouncingRobot {
  BouncingRobot(int link_count, double density, double viscosity = 0)
      : links(link_count), mass(massOf(density)), weight((mass - density * volume()) * kGravity) {
    scene.world.setGravity({0, 0, bt(-kGravity)});
    scene.world.getSolverInfo().m_restitutionVelocityThreshold = bt(0.2);
    scene.world.getSolverInfo().m_numIterations = 20;
    Medium medium = idealFluid(density);
    medium.viscosity = viscosity;
    const auto body =
        std::make_shared<FluidBody>(viscosity > 0 ? ballOf(kRadius) : facelessEllipsoid(kBalls));
    for (int i = -1; i < links; ++i) scene.fluid.add(robot, i, {body, medium});
    const btTransform place(btQuaternion::getIdentity(), {0, 0, -1});
    scene.addFixed(std::make_unique<btBoxShape>(btVector3(50, 50, 1)), place)
        .setRestitution(bt(0.8));
  }
  double level(int i) const {
    const auto* link = i < 0 ? robot.getBaseCollider() : robot.getLinkCollider(i);
    return static_cast<double>(link->getWorldTransform().getOrigin().z());
  }
  // A ball that has bounced alone has no energy on its way in the floor.
  double energy() const {
    double sum = kineticEnergy(scene.fluid, robot);
    for (int i = -1; i < links; ++i)
      sum += weight * std::max(links > 0 ? -kHeight : 0, level(i) - kRadius);
    return sum;
  }

  int links;
  double mass, weight;
  RobotWorld scene;
  btMultiBody& robot = scene.takeUndamped(ballsOnAHinge(links, mass), kRadius);
};

void expectToRest(BouncingRobot& robot, double rate) {
  const double part = robot.links == 0 ? 0.64 : 1;  // of the energy
  const double rounding = byPrecision(1e-9, 1e-5) * robot.energy();
  double before = robot.energy(), last = 0;
  double levels[] = {robot.level(-1), robot.level(robot.links - 1)};
  bool fell[] = {false, false};
  for (int i = 0; i < 12 * rate; ++i) {
    robot.scene.step(1 / rate);
    bool bounces = false;
    for (int k : {0, 1}) {
      const double level = robot.level(k == 0 ? -1 : robot.links - 1);
      bounces = bounces || (fell[k] && (level - levels[k]) * rate > 0.02);
      fell[k] = level < levels[k];
      levels[k] = level;
    }
    const double now = robot.energy();
    if (bounces) {
      EXPECT_LE(now, part * before + rounding) << i;
      last = i / rate;
    }
    before = now;
  }
  EXPECT_GT(last, 0);
  EXPECT_LT(last, 9);
  for (const double level : levels) EXPECT_NEAR(level, kRadius, 0.005);
}

TEST(Bounce, OfLinksKeepsNoMoreEither) {
  for (const int links : {0, 1})
    for (const double density : kMedia)
      for (const double rate : kRates) {
        SCOPED_TRACE(testing::Message() << links << " " << density << " " << rate);
        BouncingRobot robot(links, density);
        expectToRest(robot, rate);
      }
}

TEST(Bounce, OfLinksInAViscousFluidKeepsNoMoreEither) {
  for (const int links : {0, 1})
    for (const double rate : {60.0, 240.0}) {
      SCOPED_TRACE(testing::Message() << links << " " << rate);
      BouncingRobot robot(links, 998, 20);
      expectToRest(robot, rate);
    }
}

}  // namespace
}  // namespace ambient::test
