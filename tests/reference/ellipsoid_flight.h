#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/reference/loads/face_by_face_loads.h"

namespace ambient::reference {

/// An ellipsoid, its centre of mass in its centre, in a fluid at rest; SI units.
struct EllipsoidInFluid {
  Eigen::Vector3d semi_axes, moments;  ///< moments of inertia about these axes, body only
  double mass = 0;
  double density = 0, viscosity = 0;  ///< density, viscosity of the fluid; 0: no friction
  double separation_angle = 0;
  Eigen::Vector3d gravity;

  double volume() const { return 4.0 / 3 * std::acos(-1.0) * semi_axes.prod(); }
};

/// Flight by Kirchhoff's equations with the published law of pressure and friction, by the classic
/// Runge-Kutta scheme. Sums loads over points of a smooth ellipsoid. Shares no code with the
/// library: neither points nor added mass nor scheme.
class EllipsoidFlight {
 public:
  /// Starts at the origin; velocity and spin in world axes.
  EllipsoidFlight(const EllipsoidInFluid& body, const Eigen::Quaterniond& orientation,
                  const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin)
      : body_(body) {
    placePoints();
    inertia_ = body.density * ellipsoidAddedMass(body.semi_axes);
    inertia_.head<3>() += body.moments;
    inertia_.tail<3>().array() += body.mass;
    const auto momentum = [&](const Eigen::Vector3d& inertia, const Eigen::Vector3d& rate) {
      return orientation * inertia.cwiseProduct(orientation.conjugate() * rate);
    };
    state_.head<4>() = orientation.coeffs();
    state_.segment<3>(4).setZero();
    state_.segment<3>(7) = momentum(inertia_.head<3>(), spin);
    state_.tail<3>() = momentum(inertia_.tail<3>(), velocity);
  }

  Eigen::Vector3d position() const { return state_.segment<3>(4); }

  void advance(double step) {
    const State a = rate(state_), b = rate(state_ + step / 2 * a), c = rate(state_ + step / 2 * b),
                d = rate(state_ + step * c);
    state_ += step / 6 * (a + 2 * b + 2 * c + d);
    state_.head<4>().normalize();
    time_ += step;
  }

  /// Returns the position where the body falls through a height, interpolated linearly between two
  /// steps; time() becomes the time of the passage.
  Eigen::Vector3d passageThrough(double height, double step) {
    for (;;) {
      const Eigen::Vector3d before = position();
      advance(step);
      const Eigen::Vector3d after = position();
      if (after.z() > height || after.z() > before.z()) continue;
      const double missing = (after.z() - height) / (after.z() - before.z());
      time_ -= missing * step;
      return after + missing * (before - after);
    }
  }
  double time() const { return time_; }

 private:
  /// Orientation (x, y, z, w; body to world), position, angular momentum about the centre and
  /// linear momentum of body and fluid, in world axes.
  using State = Eigen::Matrix<double, 13, 1>;

  // Points of equal area on a spiral of the unit sphere, stretched.
  void placePoints() {
    constexpr int kPoints = 2000;
    const double pi = std::acos(-1.0), golden = pi * (3 - std::sqrt(5.0));
    double area = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double z = 1 - (2 * i + 1.0) / kPoints, r = std::sqrt(1 - z * z);
      const Eigen::Vector3d on_sphere(r * std::cos(golden * i), r * std::sin(golden * i), z);
      const Eigen::Vector3d normal = on_sphere.cwiseQuotient(body_.semi_axes);
      FaceInFlow point;
      point.normal = normal.normalized();
      point.centroid = on_sphere.cwiseProduct(body_.semi_axes);
      point.area = 4 * pi / kPoints * body_.semi_axes.prod() * normal.norm();
      point.angular = point.linear = Eigen::Vector3d::Zero();
      point.density = body_.density;
      point.viscosity = body_.viscosity;
      point.separation_cosine = std::cos(body_.separation_angle);
      area += point.area;
      points_.push_back(point);
    }
    for (FaceInFlow& point : points_) point.reference_length = std::sqrt(area);
  }

  // Returns torque and force in the body's axes.
  Eigen::Matrix<double, 6, 1> load(const Eigen::Vector3d& w, const Eigen::Vector3d& v) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (FaceInFlow& point : points_) {
      point.angular = w;
      point.linear = v;
      sum += point.wrenchOf(point.pressureForce());
      if (body_.viscosity > 0) sum += point.wrenchOf(point.frictionForce());
    }
    return sum;
  }

  // l' = torque + p x v, p' = force + weight - buoyancy.
  State rate(const State& s) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(s[3], s[0], s[1], s[2]).normalized();
    const Eigen::Vector3d l = s.segment<3>(7), p = s.tail<3>();
    const Eigen::Vector3d w = (q.conjugate() * l).cwiseQuotient(inertia_.head<3>());
    const Eigen::Vector3d v = (q.conjugate() * p).cwiseQuotient(inertia_.tail<3>());
    const Eigen::Matrix<double, 6, 1> wrench = load(w, v);
    State rate;
    rate.head<4>() = 0.5 * (q * Eigen::Quaterniond(0, w.x(), w.y(), w.z())).coeffs();
    rate.segment<3>(4) = q * v;
    rate.segment<3>(7) = q * wrench.head<3>() + p.cross(q * v);
    rate.tail<3>() =
        q * wrench.tail<3>() + (body_.mass - body_.density * body_.volume()) * body_.gravity;
    return rate;
  }

  EllipsoidInFluid body_;
  std::vector<FaceInFlow> points_;
  Eigen::Matrix<double, 6, 1> inertia_;  ///< body and fluid
  State state_;
  double time_ = 0;
};

}  // namespace ambient::reference
