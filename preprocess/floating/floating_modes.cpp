#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/surface/make_wetted_inertia.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/floating/floating_energy.h"

namespace ambient {
namespace {

// Heave along the normal and turns about two axes of the plane, about the centre of mass.
struct Floaters {
  Vector3 up;
  PlaneAxes axes;
};

using Motions = Eigen::Matrix<double, 6, 3>;

// Twists about the centre of mass, in columns.
Motions motionsOf(const Floaters& of) {
  Motions motions;
  motions << stack(Vector3::Zero(), of.up), stack(of.axes.first, Vector3::Zero()),
      stack(of.axes.second, Vector3::Zero());
  return motions;
}

// Potential energy 1/2 q.K q of small displacements q.
Eigen::Matrix3d stiffnessOf(const FloatingBody& body, const FloatingPose& pose,
                            const Motions& motions) {
  return motions.transpose() *
         restoringStiffness(pose.wet, pose.plane, {body.mass, body.centre_of_mass},
                            body.centre_of_mass) *
         motions;
}

// Returns the inertia of body and added mass against `motions`. All others follow freely.
Eigen::Matrix3d inertiaOf(const FloatingBody& body, const PackedHull& hull,
                          const FloatingPose& pose, const Motions& motions) {
  const auto [low, high] = computeExtent(hull, pose.plane.normal);
  const Matrix6 added = makeWettedInertia(body.shape)->inertia({pose.plane, low, high, pose.wet});
  const FrameOffset about_mass{Matrix3::Identity(), -body.centre_of_mass};
  const Matrix6 total =
      rigidBodyInertia(body.mass, body.inertia) + body.density * about_mass.inertiaToB(added);
  const Matrix3 response = motions.transpose() * Cholesky<6>(total).inverse() * motions;
  return Cholesky<3>(response).inverse();
}

SmallOscillation modeOf(const Eigen::Vector3d& q, double square, const Eigen::Matrix3d& stiffness,
                        const Floaters& of) {
  SmallOscillation mode;
  mode.period = square > 0 ? 2 * kPi / std::sqrt(square) : HUGE_VAL;
  const Vector3 turn = q[1] * of.axes.first + q[2] * of.axes.second;
  if (turn.norm() > 0) mode.turn = turn.normalized();
  mode.is_heave = 2 * q[0] * q[0] * stiffness(0, 0) > q.dot(stiffness * q);
  if (mode.is_heave) mode.turn.setZero();
  return mode;
}

std::array<SmallOscillation, 3> modesOf(const FloatingBody& body, const PackedHull& hull,
                                        const FloatingPose& pose) {
  const Floaters of{pose.plane.normal, PlaneAxes(pose.plane.normal)};
  const Motions motions = motionsOf(of);
  const Eigen::Matrix3d K = stiffnessOf(body, pose, motions);
  const Eigen::Matrix3d M = inertiaOf(body, hull, pose, motions);
  AMBIENT_ASSERT(isSymmetric(K, 1e-6) && isSymmetric(M, 1e-6));
  const Matrix3 root = Cholesky<3>(M).inverseTransposed();
  const Matrix3 reduced = root.transpose() * K * root;
  const SymmetricEigen<3> eigen = symmetricEigen<3>(reduced);
  std::array<SmallOscillation, 3> modes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d q = root * eigen.vectors.col(i);
    modes[static_cast<std::size_t>(i)] = modeOf(q, eigen.values[i], K, of);
  }
  return modes;
}

}  // namespace

FloatingAttitude describe(const FloatingBody& body, const PackedHull& hull,
                          const FloatingPose& pose) {
  FloatingAttitude attitude;
  attitude.up = pose.plane.normal;
  attitude.plane = pose.plane;
  attitude.wet = pose.wet;
  attitude.energy = pose.energy;
  attitude.draught = pose.plane.height - computeExtent(hull, pose.plane.normal).first;
  attitude.height_of_mass = -pose.plane.depth(body.centre_of_mass);
  // Turned about an axis a, the normal moves along a x s, in which the stiffness is given.
  const PlaneEigen eigen = planeEigen(pose.stiffness, PlaneAxes(pose.plane.normal));
  for (std::size_t i = 0; i < 2; ++i)
    attitude.metacentres[i] = {eigen.vectors[i].cross(attitude.up),
                               eigen.values[i] / (body.mass * body.gravity)};
  attitude.modes = modesOf(body, hull, pose);
  return attitude;
}

}  // namespace ambient
