#include "bullet_ambient/bullet/ambient_registry.h"

#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/bullet/body_instance.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

const char* sentence(AmbientRegistry::Complaint complaint) {
  using Complaint = AmbientRegistry::Complaint;
  switch (complaint) {
    case Complaint::kNoAction:
      return "bullet_ambient: bodies in fluid moved without their AmbientAction; call "
             "world->addAction(&action)";
    case Complaint::kNoSolver:
      return "bullet_ambient: bodies in fluid are awake but their AmbientSolver was not called; "
             "construct the world with it or call world->setConstraintSolver(&solver)";
    case Complaint::kNotFinite:
      return "bullet_ambient: a velocity, force or result of a body in fluid is not finite; the "
             "body kept its velocity or, where that is not finite, stopped";
    case Complaint::kNotPhysical:
      return "bullet_ambient: the mass properties of a body in fluid were changed to values that "
             "are not physical; it moves as in a vacuum until they are valid again";
    case Complaint::kCoarse:
      return "bullet_ambient: a step was too long for the motion of a body in fluid: its error "
             "stayed above the tolerance at the largest number of substeps; raise "
             "FlightSettings::max_substeps, or take shorter steps of the world";
    case Complaint::kInertia:  // these name the body: complainOfOddities()
    case Complaint::kEmpty:
    case Complaint::kCount:
      break;
  }
  return "";
}

void checkWorld(const btDynamicsWorld& world) {
  switch (world.getWorldType()) {
    case BT_SIMPLE_DYNAMICS_WORLD:
      throw std::invalid_argument(
          "attach: btSimpleDynamicsWorld hands no bodies to its solver, so that no fluid can act; "
          "use btDiscreteDynamicsWorld");
    case BT_DEFORMABLE_MULTIBODY_DYNAMICS_WORLD:
      throw std::invalid_argument(
          "attach: btDeformableMultiBodyDynamicsWorld solves rigid bodies together with deformable "
          "ones in a way that cannot be rewritten; use btSoftRigidDynamicsWorld or "
          "btMultiBodyDynamicsWorld");
    default:
      return;
  }
}

void checkFlight(const std::string& who, const FlightSettings& flight) {
  if (!(flight.tolerance > 0) || !std::isfinite(flight.tolerance)) {
    throw std::invalid_argument(who + " has a flight tolerance of " +
                                std::to_string(flight.tolerance) +
                                ", which must be positive and finite");
  }
  if (flight.max_substeps < 0) {
    throw std::invalid_argument(who + " has max_substeps of " +
                                std::to_string(flight.max_substeps) +
                                ", which must be zero or positive");
  }
}

}  // namespace

AmbientRegistry::AmbientRegistry()
    : report_([](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }) {}

void AmbientRegistry::attach(const btDynamicsWorld& world, btRigidBody& body, AttachDef def) {
  checkWorld(world);
  attach(body, std::move(def));
}

void AmbientRegistry::attach(btRigidBody& body, AttachDef def) {
  if (!def.fluid_body) {
    throw std::invalid_argument("attach: the fluid body is null; load one with readFluidBody()");
  }
  const std::string who = "attach: body with fluid body '" + def.fluid_body->name + "'";
  if (body.isStaticOrKinematicObject()) {
    throw std::invalid_argument(
        who + " is static or kinematic (mass 0); only dynamic bodies feel a fluid");
  }
  if (!(body.getInvMass() > 0)) {
    throw std::invalid_argument(who + " has an inverse mass of " +
                                std::to_string(body.getInvMass()) +
                                "; must be positive and finite");
  }
  if (isAttached(body)) {
    throw std::invalid_argument(who + " is attached already; use setMedium() or detach it first");
  }
  checkFlight(who, def.flight);
  auto ambient = std::make_unique<AmbientBody>();
  ambient->body = &body;
  ambient->def = std::move(def);
  refreshModel(*ambient, load_tables_);
  if (ambient->isInFluid()) body.activate();
  complainOfOddities(*ambient);
  insert(std::move(ambient));
}

// Of what can be computed, but hardly was meant.
void AmbientRegistry::complainOfOddities(const AmbientBody& ambient) {
  constexpr double kRounding = 1e-3;
  const FluidBody& shape = *ambient.def.fluid_body;
  const std::string who = "bullet_ambient: body with fluid body '" + shape.name + "' ";
  const Vector3 moments = toVector3(ambient.body->getInvInertiaDiagLocal()).cwiseInverse();
  const double largest = moments.maxCoeff(), others = moments.sum() - largest;
  if (largest > (1 + kRounding) * others) {
    const std::string text = who + "has a principal moment of inertia of " +
                             std::to_string(largest) + " kg m^2, but no rigid body has one above " +
                             std::to_string(others) + " kg m^2, the sum of the other two";
    complain(Complaint::kInertia, text.c_str());
  }
  if (ambient.isInFluid() && !ambient.model.loads && !(shape.volume > 0) &&
      shape.added_mass.isZero(0)) {
    const std::string text =
        who + "feels no fluid: without faces, volume and added mass its shape is empty";
    complain(Complaint::kEmpty, text.c_str());
  }
}

void AmbientRegistry::insert(std::unique_ptr<AmbientBody> ambient) {
  detach(*ambient->body);  // or what is left of one that was destroyed at this address
  ambient->instance = instanceNumber(*ambient->body);
  bodies_.reserve(bodies_.size() + 1);
  by_object_.emplace(ambient->body, ambient.get());
  bodies_.push_back(std::move(ambient));
}

bool AmbientRegistry::detach(const btRigidBody& body) {
  const auto found = by_object_.find(&body);
  if (found == by_object_.end()) return false;
  const auto owner =
      std::find_if(bodies_.begin(), bodies_.end(),
                   [&](const std::unique_ptr<AmbientBody>& b) { return b.get() == found->second; });
  bodies_.erase(owner);
  by_object_.erase(found);
  return true;
}

void AmbientRegistry::setMedium(const btRigidBody& body, const Medium& medium) {
  AmbientBody& ambient = require(body);
  checkMedium(*ambient.def.fluid_body, medium);
  const Medium before = ambient.def.medium;
  if (medium.density != before.density || medium.viscosity != before.viscosity) {
    AttachDef def = ambient.def;
    def.medium = medium;
    replaceDef(ambient, std::move(def));
  } else if (medium.velocity != before.velocity || medium.acceleration != before.acceleration) {
    ambient.def.medium = medium;
    ambient.body->activate();
  }
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body) {
  setFluidBody(body, std::move(fluid_body), require(body).def.fluid_frame);
}

void AmbientRegistry::setFluidBody(const btRigidBody& body,
                                   std::shared_ptr<const FluidBody> fluid_body,
                                   const FrameOffset& fluid_frame) {
  AmbientBody& ambient = require(body);
  if (!fluid_body) throw std::invalid_argument("setFluidBody: the fluid body is null");
  AttachDef def = ambient.def;
  def.fluid_body = std::move(fluid_body);
  def.fluid_frame = fluid_frame;
  replaceDef(ambient, std::move(def));
}

void AmbientRegistry::replaceDef(AmbientBody& ambient, AttachDef def) {
  std::swap(ambient.def, def);
  try {
    refreshModel(ambient, load_tables_);
  } catch (...) {
    std::swap(ambient.def, def);
    throw;
  }
  ambient.body->activate();
}

const Medium& AmbientRegistry::medium(const btRigidBody& body) const {
  return require(body).def.medium;
}

const Matrix6& AmbientRegistry::inertia(const btRigidBody& body) const {
  return require(body).model.inertia;
}

AmbientCounters AmbientRegistry::counters(const btRigidBody& body) const {
  return require(body).counters;
}

AmbientCounters AmbientRegistry::counters() const {
  AmbientCounters sum;
  for (const auto& ambient : bodies_) sum += ambient->counters;
  return sum;
}

void AmbientRegistry::setReport(std::function<void(const std::string&)> report) {
  report_ = std::move(report);
}

AmbientBody* AmbientRegistry::find(const btCollisionObject* body) {
  const auto found = by_object_.find(body);
  if (found == by_object_.end()) return nullptr;
  const btRigidBody* rigid = btRigidBody::upcast(body);
  return rigid && instanceNumber(*rigid) == found->second->instance ? found->second : nullptr;
}

const AmbientBody* AmbientRegistry::find(const btCollisionObject* body) const {
  return const_cast<AmbientRegistry*>(this)->find(body);
}

AmbientBody& AmbientRegistry::require(const btRigidBody& body) const {
  AmbientBody* ambient = const_cast<AmbientRegistry*>(this)->find(&body);
  if (!ambient) throw std::invalid_argument("this body is not attached to the ambient registry");
  return *ambient;
}

void AmbientRegistry::complain(Complaint complaint) noexcept {
  complain(complaint, sentence(complaint));
}

void AmbientRegistry::complain(Complaint complaint, const char* text) noexcept {
  bool& done = complained_[static_cast<int>(complaint)];
  if (done) return;
  done = true;
  try {
    if (report_) report_(text);
  } catch (...) {
    // A user's callback that throws must not unwind through Bullet's solver.
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
