#include "preprocess/polar/polar.h"

#include <cmath>
#include <stdexcept>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/polar/frontal_area.h"

namespace ambient {
namespace {

double extentAlong(const Vector3& axis, const FluidBody& body) {
  if (body.sphere_radius > 0) return 2 * body.sphere_radius;
  return axis.cwiseAbs().dot(extentsOf(body));
}

}  // namespace

Vector3 axisNamed(const std::string& name) {
  const bool has_sign = name.size() == 2 && (name[0] == '-' || name[0] == '+');
  const char letter = name.empty() ? ' ' : name.back();
  if ((name.size() != 1 && !has_sign) || letter < 'x' || letter > 'z')
    throw std::invalid_argument("\"" + name + "\" is none of x, y, z, -x, -y, -z");
  Vector3 axis = Vector3::Zero();
  axis[letter - 'x'] = name[0] == '-' ? -1 : 1;
  return axis;
}

Matrix3 flightAxes(const Vector3& forward, const Vector3& up) {
  Matrix3 axes;
  axes.col(0) = forward;
  axes.col(1) = up.cross(forward);
  axes.col(2) = up;
  AMBIENT_ASSERT(isRotation(axes));
  return axes;
}

PolarReference usualReference(const FluidBody& body, const Matrix3& axes) {
  return {frontalArea(body, axes.col(2)), extentAlong(axes.col(0), body)};
}

PolarCoefficients polarCoefficients(const BodyLoads& loads, const PolarFlight& flight,
                                    double attack, double side_slip) {
  AMBIENT_ASSERT(isRotation(flight.axes));
  const double ca = portable::cos(attack), sa = portable::sin(attack);
  const double cb = portable::cos(side_slip), sb = portable::sin(side_slip);
  const Vector3 motion(ca * cb, -sb, -sa * cb), lift(sa, 0, ca);
  const Vector3 side = motion.cross(lift);  // to the right
  const Twist twist{Vector3::Zero(), flight.axes * motion * flight.speed};
  Wrench load = loads.at(twist).total();
  const Vector3 momentum = flight.density * (flight.added_mass * twist.linear);
  load.torque -= twist.linear.cross(momentum);
  const PolarReference& reference = flight.reference;
  const double scale = 0.5 * flight.density * flight.speed * flight.speed * reference.area;
  const Vector3 force = flight.axes.transpose() * load.force / scale;
  const Vector3 moment = flight.axes.transpose() * load.torque / (scale * reference.length);
  return {force.dot(lift), -force.dot(motion), force.dot(side),
          moment.x(),      -moment.y(),        -moment.z()};
}

BodyLoads::BodyLoads(const std::shared_ptr<const FluidBody>& body, const Medium& medium,
                     const FlowSettings& flow) {
  FlowSettings in_double = flow;
  in_double.precision = LoadPrecision::kDouble;
  loads_ = makeSurfaceLoads(body, medium, in_double);
  if (loads_) frame_ = loads_->frame({});
}

FaceLoads BodyLoads::at(const Twist& x) const {
  if (!loads_) return {};
  const FaceLoads loads = loads_->parts(frame_.toF(x));
  return {frame_.toB(loads.pressure), frame_.toB(loads.friction)};
}

}  // namespace ambient
