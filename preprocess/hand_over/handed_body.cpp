#include "preprocess/hand_over/handed_body.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/surface/make_wetted_inertia.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

void requirePositive(const FluidBody& body, const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value)) reject(body, what, value, "positive and finite");
}

void checkAxes(const FluidBody& body, const ExportSettings& settings) {
  constexpr double kRounding = 1e-9;
  for (const Vector3& axis : {settings.forward, settings.up})
    if (!(std::abs(axis.norm() - 1) <= kRounding))
      reject(body, "length of a forward or upward axis", axis.norm(), "1");
  const double along = settings.forward.dot(settings.up);
  if (!(std::abs(along) <= kRounding)) reject(body, "forward axis times upward axis", along, "0");
}

void checkSettings(const FluidBody& body, const ExportSettings& settings) {
  requirePositive(body, "density of the fluid [kg/m^3]", settings.medium.density);
  requirePositive(body, "gravity [m/s^2]", settings.gravity);
  if (!(settings.medium.viscosity >= 0) || !std::isfinite(settings.medium.viscosity))
    reject(body, "viscosity [Pa s]", settings.medium.viscosity, "finite and not negative");
  if (settings.mass) requirePositive(body, "mass [kg]", *settings.mass);
  if (settings.draught) requirePositive(body, "draught [m]", *settings.draught);
  if (settings.speed) requirePositive(body, "speed [m/s]", *settings.speed);
  if (settings.centre_of_mass && !settings.centre_of_mass->allFinite())
    reject(body, "distance of the centre of mass [m]", settings.centre_of_mass->norm(), "finite");
  checkAxes(body, settings);
  if (settings.draught && body.added_mass_parts.empty() && !(body.sphere_radius > 0))
    reject(body, "number of added-mass parts, which a draught needs,", 0,
           "above 0: build the body anew from its mesh or shape");
}

// Returns the wet volume of a body that is all in the fluid.
WetVolume allWet(const FluidBody& shape) {
  WetVolume wet;
  wet.volume = shape.volume;
  wet.moment = shape.volume * shape.centre_of_volume;
  return wet;
}

Immersion immersionOf(const FluidBody& shape, const SurfacePlane& deep, double draught) {
  Immersion at{deep, 0, 0, {}};
  const double radius = shape.sphere_radius, middle = deep.normal.dot(shape.centre_of_volume);
  const PackedHull hull(shape);
  std::tie(at.low, at.high) =
      radius > 0 ? std::pair(middle - radius, middle + radius) : computeExtent(hull, deep.normal);
  at.plane.height = at.low + draught;
  if (draught >= at.size())
    at.wet = allWet(shape);
  else
    at.wet = radius > 0 ? computeWetSphere(radius, shape.centre_of_volume, at.plane)
                        : computeWetVolume(hull, at.plane);
  return at;
}

// Sets the surface, what of the body is below it, and the added mass there.
void putAtSurface(HandedBody& body) {
  const Immersion at = immersionOf(*body.shape, body.plane, *body.settings.draught);
  const Matrix6 wet = makeWettedInertia(body.shape)->unraisedInertia(at);
  body.plane = at.plane;
  body.wet = at.wet;
  body.added_mass = body.settings.medium.density * wet;
}

// Sets mass and inertia.
void putMass(HandedBody& body) {
  const FluidBody& shape = *body.shape;
  const MassDistribution& spread = shape.volume > 0 ? shape.uniform_mass : shape.surface_mass;
  const double displaced = body.settings.medium.density * body.wet.volume;
  if (!body.settings.mass && !(displaced > 0))
    reject(shape, "displaced mass [kg]", displaced, "positive, or the mass must be given");
  body.weight.mass = body.settings.mass.value_or(displaced);
  body.weight.centre = body.settings.centre_of_mass.value_or(spread.centre);
  body.inertia = body.weight.mass * spread.inertia;
}

void checkFinite(const HandedBody& body) {
  const Matrix6 stiffness = restoringStiffness(body.wet, body.plane, body.weight, Vector3::Zero());
  for (const Matrix6& matrix : {body.added_mass, body.ownInertia(), stiffness})
    if (!matrix.allFinite())
      reject(*body.shape, "largest entry of inertia and stiffness", HUGE_VAL,
             "finite: density, gravity, mass or the distance of its centre is too large");
}

std::string plainName(const std::string& name) {
  std::string plain = name.empty() ? "body" : name;
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
           c == '-';
  };
  std::replace_if(
      plain.begin(), plain.end(), [&](char c) { return !is_plain(c); }, '_');
  return plain;
}

}  // namespace

Matrix3 HandedBody::axes() const { return flightAxes(settings.forward, settings.up); }

Vector3 HandedBody::middle() const {
  return wet.volume > 0 ? Vector3(wet.moment / wet.volume) : shape->surface_mass.centre;
}

Matrix6 HandedBody::ownInertia() const {
  return FrameOffset{Matrix3::Identity(), weight.centre}.inertiaToB(
      rigidBodyInertia(weight.mass, inertia));
}

HandedBody handedBody(const std::shared_ptr<const FluidBody>& shape,
                      const ExportSettings& settings) {
  checkSettings(*shape, settings);
  HandedBody body;
  body.shape = shape;
  body.settings = settings;
  body.name = plainName(shape->name);
  body.plane = {settings.up, 0, settings.medium.density, settings.gravity};
  if (settings.draught) {
    putAtSurface(body);
  } else {
    body.wet = allWet(*shape);
    body.added_mass = settings.medium.density * shape->added_mass;
  }
  putMass(body);
  checkFinite(body);
  AMBIENT_ASSERT(isSymmetric(body.added_mass, 1e-9) && isSymmetric(body.inertia, 1e-9));
  return body;
}

}  // namespace ambient
