#include <algorithm>

#include "bullet_ambient/reading.h"
#include "tests/bullet_ambient/bullet/robots/robot_fixture.h"
#include "tests/support/bodies/part_bodies.h"

// Wrenches that are read of links.
namespace ambient::test {
namespace {

constexpr double kLinkStep = 1.0 / 240;

class LinkReading : public Robots {
 protected:
  void readAll(const btMultiBody& body) {
    for (int link = -1; link < body.getNumLinks(); ++link)
      world.fluid.find(body, link)->readWrench(true);
  }
  // Forces on all links, and the largest of them.
  struct Sum {
    Vector3 force = Vector3::Zero();
    double largest = 0;
  };
  Sum constraintsOf(const btMultiBody& body) {
    Sum sum;
    for (int link = -1; link < body.getNumLinks(); ++link) {
      const Vector3 force = world.fluid.find(body, link)->wrench().constraints.force;
      sum.force += force;
      sum.largest = std::max(sum.largest, force.norm());
    }
    return sum;
  }
};

// Joint forces cancel over a tree that nothing else holds: the fluid has all the rest of
// the change of the momentum.
TEST_F(LinkReading, ForcesInJointsCancelOverAFreeTree) {
  world.world.setGravity({0, 0, bt(-9.81)});
  for (int i = 0; i < 100; ++i) {
    btMultiBody& body = add({1 + i % 5, i % 2 ? Joints::kSmooth : Joints::kRevolute});
    putIntoFluid(arbitrary, world, body, 2);
    readAll(body);
    world.step(kLinkStep, 1 + i % 3);
    const Sum sum = constraintsOf(body);
    EXPECT_GT(sum.largest, 0) << i;
    EXPECT_LT(sum.force.norm(), byPrecision(1e-9, 2e-3) * sum.largest) << i;
    world.remove(body);
  }
}

// A multibody without joints is a body: the same wrenches.
TEST_F(LinkReading, ABaseAloneReadsAsABody) {
  world.world.setGravity({0, 0, bt(-9.81)});
  world.fluid.addRegion(waterBelow(0));
  const auto shape = std::make_shared<const FluidBody>(floatingEllipsoid(kUnequalAxes, 2));
  AttachDef def;
  def.fluid_body = shape;
  const double mass = 500 * shape->volume;
  const Vector3 moments = ellipsoidMoments(kUnequalAxes, mass);
  for (const double height : {-2.0, 0.05}) {
    const btTransform place(btQuaternion(btVector3(1, bt(0.5), 0), bt(0.3)), {0, 0, bt(height)});
    btMultiBody multi(0, bt(mass), toBullet(moments), false, false);
    multi.setLinearDamping(0);
    multi.setAngularDamping(0);
    multi.finalizeMultiDof();
    multi.setBasePos(place.getOrigin());
    multi.setWorldToBaseRot(place.getRotation().inverse());
    multi.setBaseVel({bt(0.5), bt(0.2), bt(-0.4)});
    btEmptyShape none;
    btRigidBody rigid(bt(mass), nullptr, &none, toBullet(moments));
    rigid.setWorldTransform(place);
    rigid.setLinearVelocity(multi.getBaseVel());
    world.world.addMultiBody(&multi);
    world.world.addRigidBody(&rigid);
    const Immersed link = world.fluid.add(multi, -1, def), body = world.fluid.add(rigid, def);
    link.readWrench(true);
    body.readWrench(true);
    world.step(kLinkStep);
    const FluidWrench of_link = link.wrench(), of_body = body.wrench();
    const double size = of_body.buoyancy.force.norm();
    const auto expectNear = [&](const Wrench& a, const Wrench& b) {
      EXPECT_LT((a.vector() - b.vector()).norm(), 2e-3 * size) << height;  // two means of one way
    };
    expectNear(of_link.pressure, of_body.pressure);
    expectNear(of_link.friction, of_body.friction);
    expectNear(of_link.buoyancy, of_body.buoyancy);
    expectNear(of_link.waves, of_body.waves);
    expectNear(of_link.added_mass, of_body.added_mass);
    EXPECT_EQ(of_link.constraints.vector().norm(), 0);
    world.world.removeMultiBody(&multi);
    world.world.removeRigidBody(&rigid);
  }
}

}  // namespace
}  // namespace ambient::test
