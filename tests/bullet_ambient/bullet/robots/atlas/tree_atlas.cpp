#include "tests/bullet_ambient/bullet/robots/atlas/tree_atlas.h"

#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/robot_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/convergence.h"

namespace ambient::test {
namespace {

constexpr double kHertz[] = {30, 60, 120, 240};
constexpr double kColliderRadius = 0.05;  // collider of a link [m]
constexpr double kLongSteps = 6;          // times those of other settings
constexpr double kGap = 0.05;             // walls of a box to its content [m]

RobotDef treeOf(Arbitrary& arbitrary) {
  RobotDef def;
  def.links = 1 + static_cast<int>(arbitrary.between(0, 12));
  def.joints = static_cast<Joints>(static_cast<int>(arbitrary.between(0, 3)));
  def.has_fixed_base = arbitrary.between(0, 1) < 0.25;
  def.speed = std::pow(10, arbitrary.between(-1, 1)) / 2;
  def.collider_radius = kColliderRadius;
  return def;
}

const Vector3 kLinkAxes(0.15, 0.08, 0.05);  // ellipsoid of a link [m]

void attachFluid(Arbitrary& arbitrary, RobotWorld& world, btMultiBody& body, TreeFluid fluid,
                 bool has_surface) {
  const double ratio = std::pow(10, arbitrary.between(-2, 2));
  if (fluid == TreeFluid::kIdeal) putIntoFluid(arbitrary, world, body, ratio);
  if (fluid != TreeFluid::kWater) return;
  AttachDef def;
  def.medium = water();
  def.wave_damping = 0;
  // Drag from the start on, so that what rises is not the error of a swing in air.
  if (has_surface) def.flow.law = PressureLaw::kPublished;
  def.fluid_body = std::make_shared<FluidBody>(has_surface ? floatingEllipsoid(kLinkAxes, 1)
                                                           : meshedEllipsoid(kLinkAxes, 1));
  for (int link = body.hasFixedBase() ? 0 : -1; link < body.getNumLinks(); ++link)
    world.fluid.add(body, link, def);
}

// Gives each revolute and prismatic joint a motor that stops it with 0.01 to 10 N m or N.
void brake(Arbitrary& arbitrary, RobotWorld& world, btMultiBody& body, double hertz) {
  const double effort = std::pow(10, arbitrary.between(-2, 1));
  for (int link = 0; link < body.getNumLinks(); ++link)
    if (body.getLink(link).m_dofCount == 1)
      world.take(std::make_unique<btMultiBodyJointMotor>(&body, link, bt(0), bt(effort / hertz)));
}

// Adds walls around the initial places of all links.
void addBox(RobotWorld& world, btMultiBody& body) {
  for (int i = 0; i < 6; ++i) {
    btVector3 normal(0, 0, 0);
    normal[i / 2] = bt(i % 2 == 0 ? 1 : -1);
    btScalar nearest = normal.dot(body.getBasePos());
    for (int link = 0; link < body.getNumLinks(); ++link)
      nearest =
          std::min(nearest, normal.dot(body.getLink(link).m_cachedWorldTransform.getOrigin()));
    world.addFixed(
        std::make_unique<btStaticPlaneShape>(normal, nearest - bt(kColliderRadius + kGap)),
        btTransform::getIdentity());
  }
}

// Weight of a tree, and energy of the still fluids displaced by its links in water.
class TreeWeight {
 public:
  TreeWeight(const btMultiBody& body, TreeFluid fluid)
      : body_(body),
        shape_(floatingEllipsoid(kLinkAxes, 1)),
        hull_(shape_),
        below_(fluid == TreeFluid::kWater ? water().density : 0),
        above_(fluid == TreeFluid::kWater ? air().density : 0) {}

  double energy() const {
    double sum = 0;
    for (int link = first(); link < body_.getNumLinks(); ++link) sum += energyOf(link);
    return sum;
  }
  /// Returns the energy of a fall by a link's length.
  double scale() const {
    double mass = 0;
    for (int link = first(); link < body_.getNumLinks(); ++link)
      mass += massOf(link) + below_ * shape_.volume;
    return mass * kGravity * 2 * kLinkAxes.x();
  }

 private:
  int first() const { return body_.hasFixedBase() ? 0 : -1; }
  double massOf(int link) const {
    return static_cast<double>(link < 0 ? body_.getBaseMass() : body_.getLinkMass(link));
  }
  double energyOf(int link) const {
    const btCollisionObject* collider =
        link < 0 ? body_.getBaseCollider() : body_.getLinkCollider(link);
    const btTransform& place = collider->getWorldTransform();
    const Vector3 position = toVector3(place.getOrigin());
    const Matrix3 axes = toQuaternion(place.getRotation()).toRotationMatrix();
    const SurfacePlane still{{0, 0, 1}, 0, below_ - above_, kGravity};
    const SurfacePlane plane = seenFrom(still, axes, position);
    return (massOf(link) - above_ * shape_.volume) * kGravity * position.z() +
           hydrostaticEnergy(computeWetVolume(hull_, plane), plane);
  }

  const btMultiBody& body_;
  FluidBody shape_;
  PackedHull hull_;
  double below_, above_;  ///< densities of the fluids [kg/m^3]
};

TreeResult watch(RobotWorld& world, const btMultiBody& body, double hertz,
                 const TreeWeight* weight) {
  const Fluid& fluid = world.fluid;
  const auto energy_now = [&] {
    return kineticEnergy(fluid, body) + (weight ? weight->energy() : 0);
  };
  const double scale = kineticEnergy(fluid, body) + (weight ? weight->scale() : 0);
  EnergyRise rise(energy_now());
  for (int i = 0; i < std::lround(hertz); ++i) {
    world.step(1 / hertz);
    const double energy = energy_now();
    if (!std::isfinite(energy)) return {false, 0, 0};
    rise.see(energy);
  }
  return {true, rise.overEarlier() / scale, rise.overStart() / scale};
}

}  // namespace

const char* nameOf(TreeSetting setting) {
  constexpr const char* kNames[] = {"free",
                                    "on a tether",
                                    "in a box",
                                    "on a tether in a box",
                                    "free, of 100 links",
                                    "through a surface",
                                    "through a surface, with brakes",
                                    "through a surface, long steps"};
  return kNames[static_cast<std::size_t>(setting)];
}

TreeResult runTree(const TreeCase& tree_case) {
  Arbitrary arbitrary(tree_case.seed);
  RobotWorld world;
  world.world.getSolverInfo().m_erp = bt(0.2);  // Bullet's default
  world.world.getSolverInfo().m_numIterations = 50;
  const TreeSetting setting = tree_case.setting;
  const double hertz = kHertz[static_cast<int>(arbitrary.between(0, 4))] /
                       (setting == TreeSetting::kInLongSteps ? kLongSteps : 1);
  RobotDef def = treeOf(arbitrary);
  if (setting == TreeSetting::kLong) def.links = 100;
  btMultiBody& body = world.add(arbitrary, def);
  const bool has_surface = setting >= TreeSetting::kThroughSurface;
  attachFluid(arbitrary, world, body, tree_case.fluid, has_surface);
  if (setting == TreeSetting::kTethered || setting == TreeSetting::kTetheredInBox)
    holdTip(world, body);
  if (setting == TreeSetting::kInBox || setting == TreeSetting::kTetheredInBox) addBox(world, body);
  if (setting == TreeSetting::kBraked) brake(arbitrary, world, body, hertz);
  if (!has_surface) return watch(world, body, hertz, nullptr);
  world.world.setGravity({0, 0, bt(-kGravity)});
  if (tree_case.fluid == TreeFluid::kWater) world.fluid.addRegion(seaUnderAir());
  const TreeWeight weight(body, tree_case.fluid);
  return watch(world, body, hertz, &weight);
}

void TreeTally::add(const TreeResult& result) {
  ++runs;
  not_finite += !result.is_finite;
  rose += result.over_earlier > 1e-6;
  rose_much += result.over_earlier > 0.01;
  largest_rise = std::max(largest_rise, result.over_earlier);
  over_start = std::max(over_start, result.over_start);
}

TreeTable runTrees(int runs, unsigned seed) {
  TreeTable table;
  for (int s = 0; s < kTreeSettings; ++s)
    for (int f = 0; f < 3; ++f) {
      const TreeCase kind{static_cast<TreeSetting>(s), static_cast<TreeFluid>(f), seed};
      if (kind.setting >= TreeSetting::kThroughSurface && kind.fluid == TreeFluid::kIdeal) continue;
      for (int i = 0; i < runs; ++i)
        table[s][f].add(runTree({kind.setting, kind.fluid, seed + static_cast<unsigned>(i)}));
    }
  return table;
}

}  // namespace ambient::test
