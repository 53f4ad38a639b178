#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <random>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/hand_over/handed_body.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {

constexpr double kSeaDensity = 1025, kSeaGravity = 9.8;

/// Sea water without viscosity.
inline ExportSettings inSea() {
  ExportSettings settings;
  settings.medium = {kSeaDensity, 0, Vector3::Zero(), Vector3::Zero()};
  settings.gravity = kSeaGravity;
  return settings;
}

/// An ellipsoid somewhere in F.
struct PlacedEllipsoid {
  Vector3 semi_axes{0.9, 0.5, 0.3}, centre{0.2, -0.1, 0.4};
  Eigen::Matrix3d axes =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
};

/// Its fluid body, with the added mass of the closed form and one part that is all of it.
inline std::shared_ptr<FluidBody> bodyOf(const PlacedEllipsoid& placed) {
  FluidBody body = facelessEllipsoid(placed.semi_axes);
  const FrameOffset in_F{Matrix3(placed.axes), placed.centre};
  const Matrix6 added = in_F.inertiaToB(body.added_mass);
  body.added_mass = 0.5 * (added + added.transpose());
  body.centre_of_volume = placed.centre;
  body.uniform_mass.centre = placed.centre;
  body.uniform_mass.inertia =
      placed.axes * ellipsoidMoments(placed.semi_axes, 1).asDiagonal() * placed.axes.transpose();
  body.added_mass_parts =
      std::vector{AddedMassPart{placed.centre, Vector6::Zero(), body.added_mass}};
  return std::make_shared<FluidBody>(body);
}

/// A point and axes, as columns, in which other programs count velocities. All in F.
struct OtherFrame {
  Vector3 origin{0, 0, 0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// Kinetic energy of the fluid around an ellipsoid per unit density, by the velocities of its
/// centre along its axes; velocities are those of the other frame, translation first.
inline double fluidEnergy(const PlacedEllipsoid& placed, const OtherFrame& frame,
                          const Vector6& velocities) {
  const Vector3 angular = frame.axes * velocities.tail<3>();
  const Vector3 linear =
      frame.axes * velocities.head<3>() + angular.cross(placed.centre - frame.origin);
  Vector6 local;
  local << placed.axes.transpose() * angular, placed.axes.transpose() * linear;
  return 0.5 * reference::ellipsoidAddedMass(placed.semi_axes).dot(local.cwiseAbs2());
}

/// Largest difference of x.Kx/2 from that energy over random velocities, relative to it.
inline double energyError(const Matrix6& K, const PlacedEllipsoid& placed,
                          const OtherFrame& frame) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double largest = 0;
  for (int i = 0; i < 20; ++i) {
    Vector6 x;
    for (double& value : x) value = uniform(random);
    const double energy = fluidEnergy(placed, frame, x);
    largest = std::max(largest, std::abs(0.5 * x.dot(K * x) - energy) / energy);
  }
  return largest;
}

inline std::string exported(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                            const ExportSettings& settings = {}) {
  return exportFluidBody(body, format, settings).bytes;
}

/// A smooth sphere about the origin with a mesh, as the preprocessor makes it.
inline std::shared_ptr<FluidBody> sphereBody(double radius) {
  FluidBody body = meshedEllipsoid(Vector3::Constant(radius), 2);
  body.sphere_radius = radius;
  body.uniform_mass.inertia = 0.4 * radius * radius * Matrix3::Identity();
  return std::make_shared<FluidBody>(body);
}

}  // namespace ambient::test
