#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/convergence.h"
#include "tests/support/world.h"

namespace ambient::test {
namespace {

/// Added mass and buoyancy of the boxes of a pile.
struct PileFluid {
  double added_mass = 0.5;  ///< largest added mass over the mass of a box
  double buoyancy = 0;      ///< displaced mass over the mass of a box
};

/// Initial arrangement of a pile.
struct PileDef {
  int edge = 8;         ///< boxes along each edge of the cube
  double tilt = 0.002;  ///< root mean square of the boxes' angles about each axis [rad]
  double height = 0;    ///< gap between floor and lowest boxes [m]
  double gap = 0;       ///< gap between neighbours [m]
  unsigned seed = 1;
};

/// A cube of equal boxes, slightly apart and turned, dropped onto a plane between four walls. All
/// solvers get the same boxes; restitution 0.
class Pile {
 public:
  static constexpr double kHalfEdge = 0.1;  ///< box [m]
  static constexpr double kMass = 1;        ///< box [kg]

  /// A pile without fluid.
  explicit Pile(const PileDef& def = {});
  /// Takes part of the boxes, spread over the pile, into a fluid. A part of 0 leaves the fluid
  /// empty.
  Pile(double ambient_part, PileFluid fluid, const PileDef& def = {});

  btDiscreteDynamicsWorld& world() { return host_.world; }
  const std::vector<std::unique_ptr<btRigidBody>>& boxes() const { return boxes_.bodies(); }
  void step(double duration) { host_.step(duration); }
  void keepAwake();
  bool isAsleep() const;
  /// Of boxes and fluid, kinetic and potential [J].
  double energy() const;

 private:
  void addWalls(int edge);
  void addBoxes(const PileDef& def);
  btRigidBody& add(WorldContents& group, double mass, btCollisionShape& shape,
                   const btTransform& start);

  std::vector<std::unique_ptr<btCollisionShape>> wall_shapes_;
  btBoxShape box_shape_;
  WholeWorld<> host_;  // its contents: walls
  WorldContents boxes_{host_.world};
  PileFluid fluid_def_;
  std::optional<Fluid> fluid_;
};

btVector3 cubeVector(double x) { return {btScalar(x), btScalar(x), btScalar(x)}; }

// Added mass for a box, coupling rotation and translation; no faces.
FluidBody pileFluidBody(PileFluid fluid) {
  const double density = 1;
  const double largest = fluid.added_mass * Pile::kMass / density;
  const double size = Pile::kHalfEdge;
  Vector6 diagonal;
  diagonal << 0.1 * largest * size * size * Vector3(1, 0.6, 0.8), largest * Vector3(1, 0.5, 0.7);
  // A fluid frame off the centre of mass couples the blocks of K.
  FluidBody shape;
  shape.name = "box of the pile";
  shape.added_mass = shiftOrigin(diagonal.asDiagonal(), {0.3 * size, -0.2 * size, 0.1 * size});
  shape.volume = std::max(fluid.buoyancy, 1e-9) * Pile::kMass / density;
  shape.area = 6 * 4 * size * size;
  return shape;
}

Pile::Pile(const PileDef& pile) : box_shape_(cubeVector(kHalfEdge)) {
  host_.world.setGravity({0, 0, btScalar(-9.81)});
  addWalls(pile.edge);
  addBoxes(pile);
}

Pile::Pile(double ambient_part, PileFluid fluid, const PileDef& pile) : Pile(pile) {
  fluid_def_ = fluid;
  fluid_.emplace(host_.world);
  AttachDef def{std::make_shared<FluidBody>(pileFluidBody(fluid))};
  def.medium.density = 1;
  def.medium.viscosity = 0;
  for (std::size_t i = 0; i < boxes().size(); ++i) {
    const bool is_ambient = std::floor(ambient_part * static_cast<double>(i + 1)) >
                            std::floor(ambient_part * static_cast<double>(i));
    if (is_ambient) fluid_->add(*boxes()[i], def);
  }
}

btRigidBody& Pile::add(WorldContents& group, double mass, btCollisionShape& shape,
                       const btTransform& start) {
  btRigidBody& body = group.add(mass, shape, start);
  body.setRestitution(0);
  body.setFriction(btScalar(0.5));
  return body;
}

void Pile::addWalls(int edge) {
  const auto room = static_cast<btScalar>((1.5 * edge + 2) * kHalfEdge);
  for (const btVector3& normal : {btVector3(0, 0, 1), btVector3(1, 0, 0), btVector3(-1, 0, 0),
                                  btVector3(0, 1, 0), btVector3(0, -1, 0)}) {
    const btScalar distance = normal.z() > 0 ? btScalar(0) : -room;
    wall_shapes_.push_back(std::make_unique<btStaticPlaneShape>(normal, distance));
    add(host_.contents, 0, *wall_shapes_.back(), btTransform::getIdentity());
  }
}

void Pile::addBoxes(const PileDef& def) {
  Arbitrary arbitrary(def.seed);
  const double pitch = 2 * kHalfEdge + def.gap;
  for (int k = 0; k < def.edge; ++k) {
    for (int j = 0; j < def.edge; ++j) {
      for (int i = 0; i < def.edge; ++i) {
        const double middle = (def.edge - 1) / 2.0;
        const Vector3 turn = arbitrary.vector(def.tilt / 2);
        const btVector3 origin(btScalar((i - middle) * pitch), btScalar((j - middle) * pitch),
                               btScalar(def.height + (k + 0.5) * pitch));
        const btQuaternion rotation(btScalar(turn.x()), btScalar(turn.y()), btScalar(turn.z()), 1);
        add(boxes_, kMass, box_shape_, btTransform(rotation.normalized(), origin));
      }
    }
  }
}

void Pile::keepAwake() {
  for (const auto& box : boxes()) box->setActivationState(DISABLE_DEACTIVATION);
}

bool Pile::isAsleep() const {
  for (const auto& box : boxes())
    if (box->isActive()) return false;
  return true;
}

double Pile::energy() const {
  double sum = 0;
  for (const auto& box : boxes()) {
    const RigidState state = readState(*box);
    const bool is_ambient = fluid_ && fluid_->find(*box);
    const double weight = 9.81 * kMass * (is_ambient ? 1 - fluid_def_.buoyancy : 1);
    sum += weight * state.position.z();
    Matrix6 inertia = Matrix6::Zero();
    if (is_ambient) {
      inertia = fluid_->find(*box)->inertia();
    } else {
      inertia.diagonal() << toVector3(box->getInvInertiaDiagLocal()).cwiseInverse(),
          Vector3::Constant(kMass);
    }
    const Vector6 x = state.twist.vector();
    sum += x.dot(inertia * x) / 2;
  }
  return sum;
}

constexpr int kMinute = 60 * 120;  // steps

// Limit of slip: every box keeps its place. Slip is random: 0.016 to 0.05 m in stock piles of
// different seeds.
constexpr double kPlace = 2 * Pile::kHalfEdge;

// Results of one pile after a minute.
struct Minute {
  double first_energy = 0, last_energy = 0;
  double highest_energy = 0;
  double largest_rise = 0;   ///< rise of energy above any earlier value
  double asleep_after = -1;  ///< [s]; -1: never
  double largest_shift = 0;  ///< box to its place in the cube [m]
  bool has_stirred = false;  ///< true: a box moved after all slept
};

std::vector<btVector3> places(const Pile& pile) {
  std::vector<btVector3> origins;
  for (const auto& box : pile.boxes()) origins.push_back(box->getWorldTransform().getOrigin());
  return origins;
}

double largestShift(const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
  btScalar largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).length());
  return static_cast<double>(largest);
}

Minute observe(Pile& pile) {
  Minute minute;
  minute.first_energy = minute.highest_energy = pile.energy();
  EnergyRise rise(minute.first_energy);
  const std::vector<btVector3> start = places(pile);
  std::vector<btVector3> at_rest;
  for (int i = 0; i < kMinute; ++i) {
    pile.step(kWorldStep);
    if (minute.asleep_after < 0) {
      const double energy = pile.energy();
      minute.highest_energy = std::max(minute.highest_energy, energy);
      rise.see(energy);
      if (pile.isAsleep()) {
        minute.asleep_after = i * kWorldStep;
        at_rest = places(pile);
      }
    }
  }
  minute.largest_rise = rise.overEarlier();
  minute.last_energy = pile.energy();
  minute.largest_shift = largestShift(places(pile), start);
  minute.has_stirred = at_rest.empty() || largestShift(places(pile), at_rest) > 0;
  return minute;
}

Minute stockMinute() {
  Pile pile;
  return observe(pile);
}

Minute ambientMinute(PileFluid fluid) {
  Pile pile(1, fluid);
  return observe(pile);
}

class PileOfCoupledBoxes : public ::testing::TestWithParam<PileFluid> {};

// Bullet pushes overlapping bodies apart, which lifts a landing pile slightly. So the test compares
// the rise of energy with stock Bullet's.
TEST_P(PileOfCoupledBoxes, RestsAndSleepsAsStillAsInStockBullet) {
  const Minute stock = stockMinute();
  const Minute ambient = ambientMinute(GetParam());
  ASSERT_GT(stock.asleep_after, 0);
  EXPECT_FALSE(stock.has_stirred);

  EXPECT_GT(ambient.asleep_after, 0);
  EXPECT_LT(ambient.asleep_after, 1.05 * stock.asleep_after);
  EXPECT_FALSE(ambient.has_stirred);
  EXPECT_LT(stock.largest_shift, kPlace);
  EXPECT_LT(ambient.largest_shift, kPlace);
  EXPECT_LE(ambient.highest_energy, ambient.first_energy);
  EXPECT_LT(ambient.last_energy, ambient.first_energy);
  EXPECT_LE(ambient.largest_rise, 1.05 * stock.largest_rise);
}

INSTANTIATE_TEST_SUITE_P(Fluids, PileOfCoupledBoxes,
                         ::testing::Values(PileFluid{0.01, 0}, PileFluid{0.5, 0.2},
                                           PileFluid{10, 0.5}));

// Tells if friction remains on an open contact. Bullet's iterations keep friction of contacts that
// have opened, and may push a body by it.
bool hasFrictionWithoutContact(btDiscreteDynamicsWorld& world) {
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      const btManifoldPoint& point = manifold.getContactPoint(c);
      if (point.m_appliedImpulse == 0 && point.m_appliedImpulseLateral1 != 0) return true;
    }
  }
  return false;
}

// Largest relative rise of energy above any earlier value. Boxes tumble on a plane until they rest;
// no position correction.
double largestRiseOfTumblingBoxes(double step) {
  const PileFluid fluid{2, 0.3};
  double largest = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    PileDef def;
    def.edge = 1;
    def.tilt = 1.5;
    def.height = 0.3;
    def.seed = seed;
    Pile pile(1, fluid, def);
    btContactSolverInfo& settings = pile.world().getSolverInfo();
    settings.m_erp = settings.m_erp2 = 0;
    settings.m_numIterations = 200;
    pile.keepAwake();
    const double first = pile.energy();
    EnergyRise rise(first);
    for (double time = 0; time < 5; time += step) {
      pile.step(step);
      const double energy = pile.energy();
      if (hasFrictionWithoutContact(pile.world())) rise.beginAt(energy);
      rise.see(energy);
    }
    EXPECT_LT(rise.lowest(), 0.7 * first) << "seed " << seed << " has not fallen";
    largest = std::max(largest, rise.overEarlier() / first);
  }
  return largest;
}

// Rows fix the velocity while the pose turns, and K in world axes with it: energy may rise at
// second order in the step.
TEST(TumblingCoupledBox, GainsNoMoreEnergyThanTheStepErrorOfSecondOrder) {
  const double coarse = largestRiseOfTumblingBoxes(1.0 / 120);
  const double fine = largestRiseOfTumblingBoxes(1.0 / 480);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(fine, coarse / 12);
}

}  // namespace
}  // namespace ambient::test
