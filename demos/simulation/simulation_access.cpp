#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <cmath>
#include <limits>
#include <utility>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/force/medium/profiles.h"
#include "demos/scene/scene_water.h"
#include "demos/simulation/simulation.h"
#include "preprocess/mesh/input_error.h"

// Functions of Simulation for programs that change and read many worlds.

namespace ambient {
namespace {

/// Priority of the region that a further flow fills, below all of scenes.
constexpr int kLast = -1001;

bool isSameFluid(const Medium& a, const Medium& b) {
  return a.density == b.density && a.viscosity == b.viscosity;
}

/// Keeps the lines that Bullet asks it to draw.
class LineKeeper : public btIDebugDraw {
 public:
  WorldLines lines;

  void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override {
    for (const btVector3& end : {from, to})
      for (int k = 0; k < 3; ++k) lines.points.push_back(static_cast<float>(end[k]));
    for (int k = 0; k < 3; ++k) lines.colours.push_back(static_cast<float>(colour[k]));
  }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                        const btVector3&) override {}
  void reportErrorWarning(const char*) override {}
  void draw3dText(const btVector3&, const char*) override {}
  void setDebugMode(int) override {}
  int getDebugMode() const override { return DBG_DrawWireframe | DBG_DrawConstraints; }
};

void scale(btScalar& mass, btVector3& inertia, double by_mass, double by_moments) {
  mass *= static_cast<btScalar>(by_mass);
  inertia *= static_cast<btScalar>(by_moments);
}

}  // namespace

std::vector<FluidRegion> Simulation::regionsOf(const Scene& scene) const {
  std::vector<FluidRegion> regions = makeRegions(scene);
  if (!flow_) return regions;
  for (FluidRegion& region : regions) {
    region.flow = region.flow + flow_;
    if (flow_above_) region.flow_above = region.flow_above + flow_above_;
  }
  for (const BodyDef& body : scene.bodies)
    if (body.mass > 0 && !isSameFluid(body.attach.medium, scene.medium))
      raiseInputError(file_, "body \"", body.name,
                      "\" has a medium of its own, which a current of each world or the wash of a "
                      "propeller cannot reach; must be that of the scene");
  FluidRegion everywhere;
  everywhere.below = scene.medium;
  everywhere.flow = flow_;
  everywhere.priority = kLast;
  regions.insert(regions.begin(), std::move(everywhere));
  return regions;
}

const FluidRegion* Simulation::regionAt(const Vector3& point) const {
  const FluidRegion* found = nullptr;
  for (const FluidRegion& region : fluids_)
    if ((!region.bounds || region.bounds->hold(point)) &&
        (!found || region.priority >= found->priority))
      found = &region;
  return found;
}

Medium Simulation::mediumAround(std::size_t body) const {
  const WorldBody& of = bodies_.at(body);
  if (!of.immersed) return {};
  return fluidAround(body, sample(of).position).here();
}

RegionSample Simulation::fluidAround(std::size_t body, const Vector3& point) const {
  const auto& immersed = bodies_[body].immersed;
  if (const FluidRegion* region = regionAt(point))
    return sampleRegion(*region, point, fluid_.time());
  RegionSample everywhere;
  if (immersed) everywhere.below = everywhere.above = immersed->medium();
  everywhere.height = std::numeric_limits<double>::infinity();
  return everywhere;
}

double Simulation::surfaceOver(const Vector3& point) const {
  for (const FluidRegion& region : fluids_)
    if (region.surface) return sampleRegion(region, point, fluid_.time()).height;
  return std::numeric_limits<double>::infinity();
}

WorldLines Simulation::lines(const FluidDrawing& drawing) {
  LineKeeper keeper;
  fluid_.drawing = drawing;
  bullet_.world->setDebugDrawer(&keeper);
  bullet_.world->debugDrawWorld();
  bullet_.world->setDebugDrawer(nullptr);
  fluid_.drawing = {};
  return std::move(keeper.lines);
}

btCollisionObject* Simulation::objectOf(std::size_t body) const {
  const WorldBody& of = bodies_.at(body);
  if (!of.link) return of.body.get();
  btMultiBody& multi_body = multiBodyOf(of);
  const int number = of.linkNumber();
  return number < 0 ? multi_body.getBaseCollider() : multi_body.getLinkCollider(number);
}

// A sample takes five times as long. The motion of a link is sound if its own and that of the links
// before it are, which are bodies before it.
bool Simulation::isSound(std::size_t body) const {
  const btCollisionObject* object = objectOf(body);
  if (!object) return false;
  const auto size = [](const btVector3& x) {
    return btFabs(x.x()) + btFabs(x.y()) + btFabs(x.z());
  };
  const btTransform& pose = object->getWorldTransform();
  btScalar sum = size(pose.getOrigin());
  for (int i = 0; i < 3; ++i) sum += size(pose.getBasis()[i]);
  const WorldBody& of = bodies_[body];
  if (!of.link) {
    sum += size(of.body->getAngularVelocity()) + size(of.body->getLinearVelocity());
  } else {
    const btMultiBody& robot = multiBodyOf(of);
    const bool is_base = of.linkNumber() < 0;
    const int first = is_base ? 0 : 6 + robot.getLink(of.linkNumber()).m_dofOffset;
    const int count = is_base ? 6 : robot.getLink(of.linkNumber()).m_dofCount;
    for (int i = 0; i < count; ++i) sum += btFabs(robot.getVelocityVector()[first + i]);
  }
  return sum < std::sqrt(std::numeric_limits<btScalar>::max());
}

double Simulation::contactImpulse(std::size_t body) const {
  const btCollisionObject* object = objectOf(body);
  btDispatcher& contacts = *bullet_.world->getDispatcher();
  double sum = 0;
  for (int i = 0; i < contacts.getNumManifolds(); ++i) {
    const btPersistentManifold& pair = *contacts.getManifoldByIndexInternal(i);
    if (pair.getBody0() != object && pair.getBody1() != object) continue;
    for (int k = 0; k < pair.getNumContacts(); ++k)
      sum += static_cast<double>(pair.getContactPoint(k).getAppliedImpulse());
  }
  return sum;
}

void Simulation::scaleMass(std::size_t body, double mass, double moments) {
  const WorldBody& of = bodies_.at(body);
  btScalar own = 0;
  if (!of.link) {
    btRigidBody& scaled = *of.body;
    own = 1 / scaled.getInvMass();
    btVector3 inertia = toBullet(toVector3(scaled.getInvInertiaDiagLocal()).cwiseInverse());
    scale(own, inertia, mass, moments);
    scaled.setMassProps(own, inertia);
    scaled.setGravity(scaled.getGravity());  // as a restored state has it, to the last bit
    scaled.updateInertiaTensor();
    return;
  }
  btMultiBody& scaled = multiBodyOf(of);
  if (of.linkNumber() >= 0) {
    btMultibodyLink& link = scaled.getLink(of.linkNumber());
    scale(link.m_mass, link.m_inertiaLocal, mass, moments);
    return;
  }
  own = scaled.getBaseMass();
  btVector3 inertia = scaled.getBaseInertia();
  scale(own, inertia, mass, moments);
  scaled.setBaseMass(own);
  scaled.setBaseInertia(inertia);
}

void Simulation::scaleFriction(std::size_t body, double factor) {
  if (btCollisionObject* object = objectOf(body))
    object->setFriction(object->getFriction() * static_cast<btScalar>(factor));
}

void Simulation::moveCentre(std::size_t body, const PreparedBody& prepared, const Vector3& offset) {
  const MotionSample start = sample(body);
  const Vector3 way = start.orientation * offset;
  setCentre(body, prepared, offset);
  btRigidBody& moved = rigidBody(body);
  btTransform pose = moved.getWorldTransform();
  pose.setOrigin(toBullet(Vector3(start.position + way)));
  moved.setCenterOfMassTransform(pose);
  moved.setLinearVelocity(toBullet(start.twist.at(way)));
  const WorldBody& of = bodies_[body];
  if (!of.immersed) return;
  FrameOffset frame;
  frame.rotation = of.R_SB.transpose();
  frame.translation =
      of.R_SB.transpose() * (prepared.fluid_origin - (prepared.centre_of_mass + offset));
  of.immersed->setFluidBody(prepared.fluid_body, frame);
}

void Simulation::setCentre(std::size_t body, const PreparedBody& prepared, const Vector3& offset) {
  thrusters_.setCentre(body, prepared.centre_of_mass + offset);
  foils_.setCentre(body, prepared.centre_of_mass + offset);
  WorldBody& of = bodies_.at(body);
  // Shapes of bodies that move are compounds.
  auto& shape = static_cast<btCompoundShape&>(*of.shape.root());
  if (of.children.empty())
    for (int i = 0; i < shape.getNumChildShapes(); ++i)
      of.children.push_back(shape.getChildTransform(i));
  const btVector3 way = toBullet(Vector3(of.R_SB.transpose() * offset));
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    btTransform place = of.children[static_cast<std::size_t>(i)];
    place.setOrigin(place.getOrigin() - way);
    shape.updateChildTransform(i, place, false);
  }
  shape.recalculateLocalAabb();
}

void Simulation::setFactors(std::size_t body, double added_mass, double loads) {
  if (const auto& immersed = bodies_.at(body).immersed) immersed->setFactors(added_mass, loads);
}

}  // namespace ambient
