#include "bullet_ambient/bullet/members/attach_body.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/immersed/region_following.h"

AMBIENT_BEGIN
namespace {

// Reports mass and shape that can be computed with, but were hardly meant.
void warnOfSuspiciousMass(const AmbientBody& ambient, Complaints& complaints) {
  constexpr double kRounding = 1e-3;
  const FluidBody& shape = *ambient.def->fluid_body;
  const std::string who = "bullet_ambient: " + nameOf(*ambient.def) + ' ';
  const Vector3 moments = ambient.models->inverse_mass.moments();
  const double largest = moments.maxCoeff(), others = moments.sum() - largest;
  if (largest > (1 + kRounding) * others) {
    const std::string text = who + "has a principal moment of inertia of " +
                             std::to_string(largest) + " kg m^2, but no rigid body has one above " +
                             std::to_string(others) + " kg m^2, the sum of the other two";
    complaints.say(Complaint::kInertia, text.c_str());
  }
  if (ambient.isInFluid() && !ambient.model().loads && !(shape.volume > 0) &&
      shape.added_mass.isZero(0)) {
    const std::string text =
        who + "feels no fluid: without faces, volume and added mass its shape is empty";
    complaints.say(Complaint::kEmpty, text.c_str());
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

template <class Choice, class Names>
void checkChoice(const std::string& who, const char* what, Choice choice, const Names& names) {
  if (wordOf(names, choice)) return;
  throw std::invalid_argument(who + " has " + what + " number " +
                              std::to_string(static_cast<int>(choice)) + "; there are 0 to " +
                              std::to_string(names.size() - 1));
}

}  // namespace

void checkDef(const std::string& who, const AttachDef& def) {
  checkFlight(who, def.flight);
  checkChoice(who, "the pressure law", def.flow.law, kPressureLawNames);
  checkChoice(who, "the load precision", def.flow.precision, kLoadPrecisionNames);
}

void refresh(AmbientBody& ambient, const InverseMass& mass, const MotionView& now,
             AmbientBodies& bodies) {
  refreshModels(ambient, mass, bodies.regions, bodies.load_tables);
  if (mayBeInRegion(ambient, bodies.regions)) {
    followRegions(ambient, now, bodies.regions, 0, bodies.complaints);
  } else {
    stayInOwnMedium(ambient, bodies.regions, 0);
  }
}

DisplacedMass displacedMass(const AmbientBody& ambient) {
  double density = ambient.medium.density;
  if (ambient.place.region != RegionId::kNone)
    for (const SurfaceMedia& surface : ambient.models->surfaces)
      density = std::min(density, surface.kind.mediumAbove(ambient.def->medium).density);
  return {1 / ambient.models->inverse_mass.mass, ambient.def->fluid_body->volume * density};
}

AmbientBody& attachBody(AmbientBodies& bodies, btRigidBody& body, AttachDef def) {
  if (!def.fluid_body) {
    throw std::invalid_argument("add: the fluid body is null; load one with loadFluidBody()");
  }
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
  if (bodies.find(&body)) {
    throw std::invalid_argument(
        who + " was added already; use Immersed::setMedium(), or remove it first");
  }
  checkDef(who, def);
  AmbientBody ambient;
  ambient.body = &body;
  ambient.def = shareDef(std::move(def), bodies.load_tables);
  refresh(ambient, inverseMassOf(body), motionOf(body), bodies);
  if (ambient.isInFluid()) body.activate();
  warnOfSuspiciousMass(ambient, bodies.complaints);
  return bodies.insert(std::move(ambient));
}

void warnOfLightBody(Complaints& complaints, const AttachDef& def, const DisplacedMass& mass,
                     int count) {
  std::ostringstream text;
  text.precision(3);
  text << "bullet_ambient: " << nameOf(def) << " has a mass of " << mass.body
       << " kg and displaces " << mass.medium << " kg of its medium, so that it rises";
  if (count > 1) text << ", and so do " << count - 1 << " more of less than half that mass";
  text << "; if they are no balls, floats or balloons, give them the mass of their volume";
  complaints.say(Complaint::kLight, text.str().c_str());
}

AMBIENT_END
