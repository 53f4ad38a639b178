#include "preprocess/polar/polar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/viscous_law.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

namespace {

using Point = Eigen::Vector2d;
using Corners = std::array<Point, 3>;
using Interval = std::pair<double, double>;  // begin and end along x

/// Projects the triangles of a surface along an axis.
std::vector<Corners> projected(const Surface& surface, const Vector3& axis) {
  int aside = 0;
  axis.cwiseAbs().minCoeff(&aside);
  const Vector3 x = axis.cross(Vector3(Vector3::Unit(aside))).normalized();
  const Vector3 y = axis.cross(x).normalized();
  std::vector<Corners> triangles(surface.triangles.size() / 3);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const double* vertex = &surface.vertices[3 * static_cast<std::size_t>(surface.triangles[i])];
    const Vector3 corner(vertex[0], vertex[1], vertex[2]);
    triangles[i / 3][i % 3] = {x.dot(corner), y.dot(corner)};
  }
  return triangles;
}

/// The part of a line at a height y that lies in a triangle; empty: begin > end.
Interval cut(const Corners& corners, double y) {
  Interval inside(1, 0);
  bool is_cut = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = corners[k], &b = corners[(k + 1) % 3];
    if ((a.y() < y) == (b.y() < y)) continue;
    const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    inside = is_cut ? Interval(std::minmax(inside.first, x)) : Interval(x, x);
    is_cut = true;
  }
  return inside;
}

double lengthOfUnion(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end());
  double sum = 0, covered = -HUGE_VAL;
  for (const auto& [begin, end] : intervals) {
    sum += std::max(0.0, end - std::max(begin, covered));
    covered = std::max(covered, end);
  }
  return sum;
}

double silhouette(const std::vector<Corners>& triangles) {
  constexpr int kLines = 8192;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Corners& corners : triangles)
    for (const Point& corner : corners) {
      low = std::min(low, corner.y());
      high = std::max(high, corner.y());
    }
  const double height = (high - low) / kLines;  // of the strip of a line
  if (!(height > 0)) return 0;
  std::vector<std::vector<Interval>> lines(kLines);
  for (const Corners& corners : triangles) {
    const auto [first, last] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const int end = std::min(kLines, static_cast<int>((last - low) / height) + 1);
    for (int i = static_cast<int>((first - low) / height); i < end; ++i) {
      const Interval inside = cut(corners, low + (i + 0.5) * height);
      if (inside.first < inside.second) lines[static_cast<std::size_t>(i)].push_back(inside);
    }
  }
  double length = 0;
  for (std::vector<Interval>& line : lines) length += lengthOfUnion(line);
  return length * height;
}

/// Half the projected area of all faces, [m^2]: the frontal area of a convex body.
double halfOfFaces(const FaceTable& faces, const Vector3& axis) {
  double sum = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    sum += faces.area[i] * std::abs(faces.normal(i).dot(axis));
  return sum / 2;
}

}  // namespace

double frontalArea(const FluidBody& body, const Vector3& axis) {
  if (body.sphere_radius > 0) return kPi * body.sphere_radius * body.sphere_radius;
  if (body.surface.triangles.empty()) return halfOfFaces(body.faces, axis);
  return silhouette(projected(body.surface, axis));
}

void setMeasuredDrag(const Vector3& coefficients, FluidBody& body) {
  for (int k = 0; k < 3; ++k) {
    const double half = halfOfFaces(facesOf(body), Vector3::Unit(k));
    const double share = half > 0 ? frontalArea(body, Vector3::Unit(k)) / half : 1;
    body.drag[k] = std::min(kLargestDrag, share * coefficients[k]);
  }
}

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
  density_ = medium.density;
  diameter_ = std::sqrt(body->area / kPi);
  if (flow.law == PressureLaw::kForm && !flow.own_law) viscosity_ = medium.viscosity;
}

// Laws drop or bound what is beyond, as a world wants it.
bool BodyLoads::isKnownAt(const Twist& x) const {
  const double turning = diameter_ * x.angular.norm();
  const double speed = std::sqrt(x.linear.squaredNorm() + turning * turning);
  const double size = std::max(1.0, diameter_);
  if (!std::isfinite(density_ * speed * speed * speed * size * size)) return false;
  return !(viscosity_ > 0) || density_ * diameter_ * speed <= kMostReynolds * viscosity_;
}

FaceLoads BodyLoads::at(const Twist& x) const {
  if (!loads_) return {};
  const FaceLoads loads = loads_->parts(frame_.toF(x));
  const FaceLoads in_F{frame_.toB(loads.pressure), frame_.toB(loads.friction)};
  if (isKnownAt(x) && in_F.total().vector().allFinite()) return in_F;
  const Vector3 unknown = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {{unknown, unknown}, {unknown, unknown}};
}

Matrix6 BodyLoads::dampingAt(const Twist& x) const {
  constexpr double kStep = 1e-4;
  const double speed = x.linear.norm(), size = std::sqrt(kPi) * diameter_;  // root of the area
  Matrix6 damping;
  for (int k = 0; k < 6; ++k) {
    const double step = kStep * (k < 3 ? speed / size : speed);
    const auto loadAt = [&](double change) {
      return at(Twist::fromVector(x.vector() + change * Vector6::Unit(k))).total().vector();
    };
    damping.col(k) = (loadAt(-step) - loadAt(step)) / (2 * step);
  }
  return damping;
}

}  // namespace ambient
