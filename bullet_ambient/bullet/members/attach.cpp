#include "bullet_ambient/bullet/members/attach.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/immersed/region_following.h"

AMBIENT_BEGIN
namespace {

btScalar massOf(const btMultiBody& body, int link) {
  return link < 0 ? body.getBaseMass() : body.getLinkMass(link);
}
const btVector3& inertiaOf(const btMultiBody& body, int link) {
  return link < 0 ? body.getBaseInertia() : body.getLinkInertia(link);
}

double inverseNumber(btScalar a) { return static_cast<double>(a != 0 ? 1 / a : btScalar(0)); }

// Refuses a number of a definition that is not finite or negative, or 0 unless it may be that.
void checkNumber(const std::string& who, const std::string& what, double number,
                 bool may_be_zero = false, const char* unit = "") {
  if ((number > 0 || (may_be_zero && number == 0)) && std::isfinite(number)) return;
  throw std::invalid_argument(who + " has " + what + " of " + std::to_string(number) + unit +
                              ", which must be " + (may_be_zero ? "zero or positive" : "positive") +
                              " and finite");
}

template <class Choice, class Names>
void checkChoice(const std::string& who, const char* what, Choice choice, const Names& names) {
  if (wordOf(names, choice)) return;
  throw std::invalid_argument(who + " has " + what + " number " +
                              std::to_string(static_cast<int>(choice)) + "; there are 0 to " +
                              std::to_string(names.size() - 1));
}

void checkHoldSettings(const std::string& who, const AttachDef& def) {
  const std::vector<double>& water = def.holds.water;
  const std::vector<Hold>& holds = def.fluid_body->holds;
  checkNumber(who, "air at the surface", def.holds.atmosphere, false, " Pa");
  checkNumber(who, "a damping of sloshing", def.holds.sloshing_damping, true);
  if (water.empty()) return;
  if (water.size() != holds.size())
    throw std::invalid_argument(who + " has water for " + std::to_string(water.size()) +
                                " holds, but its fluid body has " + std::to_string(holds.size()));
  for (std::size_t i = 0; i < water.size(); ++i)
    checkWater(who, static_cast<int>(i), water[i], holds[i].volume);
}

}  // namespace

void checkWater(const std::string& who, int hold, double volume, double capacity) {
  if (volume >= 0 && volume <= capacity) return;
  throw std::invalid_argument(who + " has " + std::to_string(volume) + " m^3 of water in hold " +
                              std::to_string(hold) + ", which must be zero to " +
                              std::to_string(capacity));
}

void checkDef(const std::string& who, const AttachDef& def) {
  checkNumber(who, "a added_mass_factor", def.added_mass_factor);
  checkNumber(who, "a load_factor", def.load_factor);
  checkNumber(who, "a flight tolerance", def.flight.tolerance);
  if (def.flight.max_substeps < 0)
    throw std::invalid_argument(who + " has max_substeps of " +
                                std::to_string(def.flight.max_substeps) +
                                ", which must be zero or positive");
  checkHoldSettings(who, def);
  checkChoice(who, "the pressure law", def.flow.law, kPressureLawNames);
  checkChoice(who, "the load precision", def.flow.precision, kLoadPrecisionNames);
}

void refresh(AmbientBody& ambient, const InverseMass& mass, const MotionView& now,
             AmbientBodies& bodies) {
  refreshModels(ambient, mass, bodies.regions, bodies.load_tables);
  bodies.has_vessels = bodies.has_vessels || ambient.vessel;
  if (mayBeInRegion(ambient, bodies.regions)) {
    followRegions(ambient, now, bodies.regions, 0, bodies.warnings);
  } else {
    stayInOwnMedium(ambient, bodies.regions, 0);
  }
}

InverseMass inverseOf(btScalar mass, const btVector3& inertia) noexcept {
  return {inverseNumber(mass),
          {inverseNumber(inertia.x()), inverseNumber(inertia.y()), inverseNumber(inertia.z())}};
}

InverseMass inverseMassOf(const btMultiBody& body, int link) noexcept {
  return inverseOf(massOf(body, link), inertiaOf(body, link));
}

void readLinkPose(const btMultiBody& body, AmbientLink& link) noexcept {
  setMotion(linkTransform(body, link.link), link.now.twist_W, link.now);
}

void wake(btMultiBody& body) noexcept {
  body.wakeUp();
  for (int link = -1; link < body.getNumLinks(); ++link)
    if (btCollisionObject* collider = colliderOf(body, link)) collider->activate();
}

void wake(const AmbientBody& ambient) noexcept {
  if (ambient.body) {
    ambient.body->activate();
  } else {
    wake(*ambient.multi_body);
  }
}

namespace {

bool isFixed(const btMultiBody& body, int link) {
  return link >= 0 && body.getLink(link).m_jointType == btMultibodyLink::eFixed;
}

// Pose of a link at a fixed joint in its parent's frame; does not depend on the tree's motion.
btTransform poseInParent(const btMultibodyLink& link) {
  const btQuaternion turn = link.m_cachedRotParentToThis.inverse();
  return btTransform(turn, quatRotate(turn, link.m_cachedRVector));
}

}  // namespace

std::optional<FixedLink> carrierOf(const btMultiBody& body, int link) {
  std::vector<FixedLink> reached{{link, btTransform::getIdentity()}};
  const auto reach = [&](int next, const btTransform& pose) {
    const auto is_next = [next](const FixedLink& known) { return known.link == next; };
    if (std::none_of(reached.begin(), reached.end(), is_next)) reached.push_back({next, pose});
  };
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const FixedLink here = reached[i];
    if (massOf(body, here.link) > 0 || (here.link < 0 && body.hasFixedBase())) return here;
    if (isFixed(body, here.link)) {
      const btMultibodyLink& joint = body.getLink(here.link);
      reach(joint.m_parent, poseInParent(joint) * here.pose);
    }
    for (int child = here.link + 1; child < body.getNumLinks(); ++child)
      if (isFixed(body, child) && body.getParent(child) == here.link)
        reach(child, poseInParent(body.getLink(child)).inverse() * here.pose);
  }
  return std::nullopt;
}

std::vector<FixedLink> carriedBy(const btMultiBody& body, int carrier) {
  std::vector<FixedLink> carried;
  for (int link = -1; link < body.getNumLinks(); ++link) {
    if (link == carrier) continue;
    const auto found = carrierOf(body, link);
    if (found && found->link == carrier) carried.push_back({link, found->pose});
  }
  return carried;
}

namespace {

// Reports mass, shape and settings that can be computed with, but were hardly meant.
void warnOfDoubts(const AmbientBody& ambient, Warnings& warnings) {
  constexpr double kRounding = 1e-3;
  const FluidBody& shape = *ambient.def->fluid_body;
  const FlowSettings& flow = ambient.def->flow;
  const auto warn = [&](Warning warning, const std::string& what) {
    const std::string text = "bullet_ambient: " + nameOf(*ambient.def) + ' ' + what;
    warnings.warnOnce(warning, text.c_str());
  };
  const Vector3 moments = ambient.models->inverse_mass.moments();
  const double largest = moments.maxCoeff(), others = moments.sum() - largest;
  if (largest > (1 + kRounding) * others)
    warn(Warning::kInertia, "has a principal moment of inertia of " + std::to_string(largest) +
                                " kg m^2, but no rigid body has one above " +
                                std::to_string(others) + " kg m^2, the sum of the other two");
  const bool has_form_law = flow.law == PressureLaw::kForm && !flow.own_law;
  if (has_form_law && flow.separation_angle != FlowSettings{}.separation_angle)
    warn(Warning::kAngle,
         "has a separation angle, which the form law does not read: where the "
         "flow leaves a body follows from its shape and its roughness");
  if (ambient.isInFluid() && has_form_law && ambient.medium.viscosity > 0 &&
      ambient.model().loads && !(shape.sphere_radius > 0) && !shape.viscous.isKnown())
    warn(Warning::kNoResistance,
         "moves as without viscosity: its fluid body has no resistance, which "
         "prepare() of preprocess/build.h and ambient_preprocess upgrade make");
  if (ambient.isInFluid() && !ambient.model().loads && !(shape.volume > 0) &&
      shape.added_mass.isZero(0))
    warn(Warning::kEmpty,
         "feels no fluid: without faces, volume and added mass its shape is empty");
}

// Refuses a definition without a shape.
void requireShape(const AttachDef& def) {
  if (!def.fluid_body)
    throw std::invalid_argument("add: the fluid body is null; load one with loadFluidBody()");
}

[[noreturn]] void refuseTwice(const std::string& who) {
  throw std::invalid_argument(who +
                              " was added already; use Immersed::setMedium(), or remove it first");
}

// Gives a new body or link its definition and models.
void immerse(AmbientBody& ambient, const std::string& who, AttachDef def, const InverseMass& mass,
             const MotionView& now, AmbientBodies& bodies) {
  checkDef(who, def);
  ambient.def = internDef(std::move(def), bodies.load_tables);
  refresh(ambient, mass, now, bodies);
}

}  // namespace

AmbientBody& attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def) {
  requireShape(def);
  if (def.name.empty() && bodies.naming) def.name = bodies.naming(body);
  const std::string who = "add: " + nameOf(def);
  if (body.isStaticOrKinematicObject()) {
    throw std::invalid_argument(
        who + " is static or kinematic (mass 0); only dynamic bodies feel a fluid");
  }
  if (!(body.getInvMass() > 0)) {
    throw std::invalid_argument(who + " has an inverse mass of " +
                                std::to_string(body.getInvMass()) +
                                "; must be positive and finite");
  }
  if (bodies.find(&body)) refuseTwice(who);
  AmbientBody ambient;
  ambient.body = &body;
  immerse(ambient, who, std::move(def), inverseMassOf(body), motionOf(body), bodies);
  if (ambient.isInFluid()) body.activate();
  warnOfDoubts(ambient, bodies.warnings);
  return bodies.insert(std::move(ambient));
}

namespace {

void checkTreeOf(const std::string& who, const btMultiBody& body, int link) {
  if (link < -1 || link >= body.getNumLinks()) {
    throw std::invalid_argument(who + ": the btMultiBody has links 0 to " +
                                std::to_string(body.getNumLinks() - 1) +
                                ", and its base is link -1");
  }
  if (body.isUsingRK4Integration()) {
    throw std::invalid_argument(
        who + ": useRK4Integration moves a btMultiBody by its dry mass; switch it off");
  }
}

void checkLinkMass(const std::string& who, const btMultiBody& body, int link) {
  if (link < 0 && body.isBaseStaticOrKinematic()) {
    throw std::invalid_argument(who + " is static or kinematic; only what moves feels a fluid");
  }
  const btScalar mass = massOf(body, link);
  if (!(mass > 0)) {
    throw std::invalid_argument(who + " has a mass of " + std::to_string(mass) +
                                " kg; must be positive, or that of a link at a fixed joint");
  }
}

// Moves a definition to the link that carries the given one. Returns that link.
int moveToCarrier(const btMultiBody& body, int link, AttachDef& def) {
  const auto carrier = carrierOf(body, link);
  if (!carrier || carrier->link == link) return link;
  const Matrix3 turn = toQuaternion(carrier->pose.getRotation()).toRotationMatrix();
  def.fluid_frame.translation =
      turn * def.fluid_frame.translation + toVector3(carrier->pose.getOrigin());
  def.fluid_frame.rotation = turn * def.fluid_frame.rotation;
  return carrier->link;
}

}  // namespace

AmbientBody& attachLink(AmbientBodies& bodies, btMultiBodyDynamicsWorld& world, btMultiBody& body,
                        int given, AttachDef def) {
  requireShape(def);
  const std::string link_name = "add: link " + std::to_string(given);
  checkTreeOf(link_name + " with fluid body '" + def.fluid_body->name + "'", body, given);
  const btCollisionObject* collider = colliderOf(body, given);
  if (def.name.empty() && collider && bodies.naming) def.name = bodies.naming(*collider);
  const std::string who = def.name.empty()
                              ? link_name + " with fluid body '" + def.fluid_body->name + "'"
                              : link_name + ", '" + def.name + "',";
  const int at = moveToCarrier(body, given, def);
  checkLinkMass(who, body, at);
  const AmbientTree* known = bodies.trees.at(&body);
  if (known && !(known->isSame() && hasLinksOf(body, known->tree))) {
    bodies.trees.erase(body);  // of another one that was destroyed at this address
    known = nullptr;
  }
  if (known && known->find(at)) {
    if (at != given)
      throw std::invalid_argument(who + " has no mass, and link " + std::to_string(at) +
                                  ", which carries it, was added already");
    refuseTwice(who);
  }
  auto link = std::make_unique<AmbientLink>(at);
  link->mass = inverseMassOf(body, at);
  link->now.gravity = toVector3(world.getGravity());
  readLinkPose(body, *link);
  AmbientBody& attached = link->ambient;
  immerse(attached, who, std::move(def), link->mass, link->now, bodies);
  warnOfDoubts(attached, bodies.warnings);
  bodies.trees.insert(world, body, std::move(link));
  wake(body);
  return attached;
}

DisplacedMass displacedMass(const AmbientBody& ambient) {
  double density = ambient.medium.density;
  if (ambient.location.region != RegionId::kNone)
    for (const SurfaceMedia& surface : ambient.models->surfaces)
      density = std::min(density, surface.kind.mediumAbove(ambient.def->medium).density);
  return {1 / ambient.models->inverse_mass.mass, ambient.def->fluid_body->volume * density};
}

namespace {

double wholeMass(const btMultiBody& body) {
  if (body.hasFixedBase()) return std::numeric_limits<double>::infinity();
  double mass = static_cast<double>(body.getBaseMass());
  for (int i = 0; i < body.getNumLinks(); ++i) mass += static_cast<double>(body.getLinkMass(i));
  return mass;
}

DisplacedMass displacedMassOf(const AmbientTree& tree) {
  DisplacedMass all{wholeMass(*tree.multi_body), 0};
  for (const auto& link : tree.links) all.medium += displacedMass(link->ambient).medium;
  return all;
}

}  // namespace

std::optional<DisplacedMass> risingMass(const AmbientBody& ambient, const AmbientTrees& trees,
                                        const btVector3& gravity) {
  const btRigidBody* body = ambient.body;
  const AmbientTree* tree = body ? nullptr : &trees.treeOf(ambient);
  const bool falls =
      (body && !body->getGravity().isZero()) || (!(body && body->isInWorld()) && !gravity.isZero());
  if (!falls) return std::nullopt;
  const DisplacedMass own = displacedMass(ambient);
  const DisplacedMass all = tree ? displacedMassOf(*tree) : own;
  const DisplacedMass before{all.body, all.medium - own.medium};
  if (!all.isMuchLighter() || (tree && before.isMuchLighter())) return std::nullopt;
  return all;
}

void warnOfLightBody(Warnings& warnings, const AttachDef& def, const DisplacedMass& mass,
                     int count) {
  std::ostringstream text;
  text.precision(3);
  text << "bullet_ambient: " << nameOf(def) << " has a mass of " << mass.body
       << " kg and displaces " << mass.medium << " kg of its medium, so that it rises";
  if (count > 1) text << ", and so do " << count - 1 << " more of less than half that mass";
  text << "; if they are no balls, floats or balloons, give them the mass of their volume";
  warnings.warnOnce(Warning::kLight, text.str().c_str());
}

AMBIENT_END
