#include "preprocess/floating/floating_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

namespace {

// Second derivative of s.r by a turn of r, with the sign of a force along -s.
Matrix3 leverStiffness(const Vector3& s, const Vector3& r) {
  const Matrix3 product = s * r.transpose();
  return s.dot(r) * Matrix3::Identity() - 0.5 * (product + product.transpose());
}

constexpr double kRounding = 1e-12;

// A sphere has no triangles in its hull.
WetVolume wetVolumeOf(const FluidBody& body, const PackedHull& hull, const SurfacePlane& plane) {
  return body.sphere_radius > 0 ? computeWetSphere(body.sphere_radius, body.centre_of_volume, plane)
                                : computeWetVolume(hull, plane);
}

// The lowest and the highest point along `up` [m].
std::pair<double, double> extentOf(const FluidBody& body, const PackedHull& hull,
                                   const Vector3& up) {
  const double middle = up.dot(body.centre_of_volume), radius = body.sphere_radius;
  return radius > 0 ? std::pair(middle - radius, middle + radius) : computeExtent(hull, up);
}

/// Of the water in all holds [m^3].
double waterIn(const FloatingBody& body) {
  double volume = 0;
  for (const HeldWater& held : body.water) volume += held.volume;
  return volume;
}

/// Takes the water inside off what is wet, with its free surface.
void addWater(const FloatingBody& body, FloatingPose& pose) {
  for (const HeldWater& held : body.water) {
    const HoldFill fill = fillHold(held.hold, pose.plane.normal, held.volume, pose.plane.height);
    pose.wet = withWaterInside(pose.wet, pose.plane, fill);
    pose.wet.waterplane.spread -= fill.water.waterplane.spread;
  }
}

// The height of the plane at which the water carries the body: Newton's method within an interval
// that halving keeps.
void balance(const FloatingBody& body, const PackedHull& hull, FloatingPose& pose) {
  const auto [low, high] = extentOf(*body.shape, hull, pose.plane.normal);
  const double wanted = body.mass / body.density + waterIn(body);
  AMBIENT_ASSERT(body.mass > 0 && body.density > 0 && high > low);
  double below = low, above = high;
  pose.plane.height = (low + high) / 2;
  for (int i = 0; i < 100; ++i) {
    pose.wet = wetVolumeOf(*body.shape, hull, pose.plane);
    const double excess = pose.wet.volume - wanted;
    if (std::abs(excess) <= kRounding * wanted) return;
    (excess > 0 ? above : below) = pose.plane.height;
    const double newton = pose.plane.height - excess / pose.wet.waterplane.area;
    pose.plane.height = newton > below && newton < above ? newton : (below + above) / 2;
  }
}

Matrix3 projector(const Vector3& normal) {
  return Matrix3::Identity() - normal * normal.transpose();
}

}  // namespace

PlaneEigen planeEigen(const Matrix3& matrix, const PlaneAxes& axes) {
  const auto& [e, f] = axes;
  const double a = e.dot(matrix * e), b = e.dot(matrix * f), d = f.dot(matrix * f);
  const double angle = 0.5 * portable::atan2(2 * b, a - d);
  const Vector3 large = portable::cos(angle) * e + portable::sin(angle) * f;
  const Vector3 small = -portable::sin(angle) * e + portable::cos(angle) * f;
  return {{small.dot(matrix * small), large.dot(matrix * large)}, {small, large}};
}

void setWater(FloatingBody& body, const std::vector<double>& volumes) {
  const std::vector<Hold>& holds = body.shape->holds;
  if (volumes.size() > holds.size())
    reject(*body.shape, "number of volumes of water", static_cast<double>(volumes.size()),
           "at most that of its holds");
  body.water.clear();
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (!(volumes[i] >= 0) || !(volumes[i] <= holds[i].volume))
      reject(*body.shape, "water in its " + holds[i].name + " [m^3]", volumes[i],
             "zero or positive, and no more than it holds");
    body.water.push_back({HoldShape(holds[i]), volumes[i]});
  }
}

FloatingPose floatAt(const FloatingBody& body, const PackedHull& hull, const Vector3& up) {
  AMBIENT_ASSERT(isUnit(up));
  FloatingPose pose;
  pose.plane = {up, 0, body.density, body.gravity};
  balance(body, hull, pose);
  pose.outside = pose.wet;
  addWater(body, pose);
  const double weight = body.mass * body.gravity;
  AMBIENT_ASSERT(pose.wet.volume > 0);
  const Vector3 lever = body.centre_of_mass - pose.wet.moment / pose.wet.volume;
  const Matrix3 in_plane = projector(up);
  pose.energy = hydrostaticEnergy(pose.wet, pose.plane) +
                weight * (up.dot(body.centre_of_mass) - pose.plane.height);
  pose.gradient = weight * (in_plane * lever);
  pose.stiffness =
      body.density * body.gravity * (in_plane * pose.wet.waterplane.spread * in_plane) -
      weight * up.dot(lever) * in_plane;
  return pose;
}

FloatingPose settle(const FloatingBody& body, const PackedHull& hull, const Vector3& up) {
  constexpr int kMostSteps = 200;
  constexpr double kLongest = 0.3;  // [rad]
  FloatingPose pose = floatAt(body, hull, up);
  const auto [low, high] = extentOf(*body.shape, hull, up);
  const double scale = body.mass * body.gravity * (high - low);
  for (int i = 0; i < kMostSteps; ++i) {
    if (pose.gradient.norm() <= 1e-10 * scale) break;
    const PlaneEigen eigen = planeEigen(pose.stiffness, PlaneAxes(pose.plane.normal));
    Vector3 step = Vector3::Zero();
    for (std::size_t k = 0; k < 2; ++k) {
      const double stiffness = std::max(std::abs(eigen.values[k]), 1e-3 * scale);
      step -= eigen.vectors[k].dot(pose.gradient) / stiffness * eigen.vectors[k];
    }
    step *= std::min(1.0, kLongest / step.norm());
    bool is_lower = false;
    for (int halving = 0; halving < 30 && !is_lower; ++halving, step *= 0.5) {
      const FloatingPose next = floatAt(body, hull, (pose.plane.normal + step).normalized());
      // Near the end, where the energy's rounding hides it, by the gradient.
      is_lower = next.energy < pose.energy - kRounding * scale ||
                 (next.energy <= pose.energy + kRounding * scale &&
                  next.gradient.norm() < pose.gradient.norm());
      if (is_lower) pose = next;
    }
    if (!is_lower) break;
  }
  return pose;
}

Matrix6 restoringStiffness(const WetVolume& wet, const SurfacePlane& plane, const PointMass& weight,
                           const Vector3& point) {
  const Vector3& s = plane.normal;
  const Vector6 q = stack((wet.waterplane.centroid - point).cross(s), s);
  const Matrix3 turn = crossMatrix(s);
  Matrix6 K = wet.waterplane.area * q * q.transpose();
  K.topLeftCorner<3, 3>() += turn * wet.waterplane.spread * turn.transpose();
  K.topLeftCorner<3, 3>() += leverStiffness(s, wet.moment - wet.volume * point);
  K *= plane.density * plane.gravity;
  K.topLeftCorner<3, 3>() -= weight.mass * plane.gravity * leverStiffness(s, weight.centre - point);
  return K;
}

namespace {

// Twists about the centre of mass, in columns.
using Motions = Eigen::Matrix<double, 6, 3>;

// Heave along the normal and turns about two axes of the plane.
Motions motionsOf(const Vector3& up) {
  const PlaneAxes axes(up);
  Motions motions;
  motions << stack(Vector3::Zero(), up), stack(axes.first, Vector3::Zero()),
      stack(axes.second, Vector3::Zero());
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
  const auto [low, high] = extentOf(*body.shape, hull, pose.plane.normal);
  const Matrix6 added =
      makeWettedInertia(body.shape)->inertia({pose.plane, low, high, pose.outside});
  const FrameOffset about_mass{Matrix3::Identity(), -body.centre_of_mass};
  Matrix6 total =
      rigidBodyInertia(body.mass, body.inertia) + body.density * about_mass.inertiaToB(added);
  for (const HeldWater& held : body.water) {  // at its centre, where it turns freely
    const HoldFill fill = fillHold(held.hold, pose.plane.normal, held.volume, pose.plane.height);
    if (!(fill.water.volume > 0)) continue;
    const Vector3 centre = fill.water.moment / fill.water.volume - body.centre_of_mass;
    total += shiftOrigin(rigidBodyInertia(body.density * held.volume, Matrix3::Zero()), -centre);
  }
  const Matrix3 response = motions.transpose() * Cholesky<6>(total).inverse() * motions;
  return Cholesky<3>(response).inverse();
}

SmallOscillation modeOf(const Eigen::Vector3d& q, double square, const Eigen::Matrix3d& stiffness,
                        const Motions& motions) {
  SmallOscillation mode;
  mode.period = square > 0 ? 2 * kPi / std::sqrt(square) : HUGE_VAL;
  const Vector3 turn = motions.topRows<3>() * q;
  if (turn.norm() > 0) mode.turn = turn.normalized();
  mode.is_heave = 2 * q[0] * q[0] * stiffness(0, 0) > q.dot(stiffness * q);
  if (mode.is_heave) mode.turn.setZero();
  return mode;
}

std::array<SmallOscillation, 3> modesOf(const FloatingBody& body, const PackedHull& hull,
                                        const FloatingPose& pose) {
  const Motions motions = motionsOf(pose.plane.normal);
  const Eigen::Matrix3d K = stiffnessOf(body, pose, motions);
  const Eigen::Matrix3d M = inertiaOf(body, hull, pose, motions);
  AMBIENT_ASSERT(isSymmetric(K, 1e-6) && isSymmetric(M, 1e-6));
  const Matrix3 root = Cholesky<3>(M).inverseTransposed();
  const Matrix3 reduced = root.transpose() * K * root;
  const SymmetricEigen<3> eigen = symmetricEigen<3>(reduced);
  constexpr double kNeutral = 1e-9;  // of the square of the highest frequency: rounding
  std::array<SmallOscillation, 3> modes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d q = root * eigen.vectors.col(i);
    const double square = eigen.values[i] > kNeutral * eigen.values[2] ? eigen.values[i] : 0;
    modes[static_cast<std::size_t>(i)] = modeOf(q, square, K, motions);
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
  attitude.draught = pose.plane.height - extentOf(*body.shape, hull, pose.plane.normal).first;
  attitude.height_of_mass = -pose.plane.depth(body.centre_of_mass);
  // Turned about an axis a, the normal moves along a x s, in which the stiffness is given.
  const PlaneEigen eigen = planeEigen(pose.stiffness, PlaneAxes(pose.plane.normal));
  for (std::size_t i = 0; i < 2; ++i)
    attitude.metacentres[i] = {eigen.vectors[i].cross(attitude.up),
                               eigen.values[i] / (body.mass * body.gravity)};
  attitude.modes = modesOf(body, hull, pose);
  return attitude;
}

namespace {

std::string textOf(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void checkFloating(const FloatingBody& body) {
  const auto require = [&](double value, const char* what) {
    if (!(value > 0) || !std::isfinite(value))
      reject(*body.shape, what, value, "positive and finite");
  };
  require(body.mass, "mass [kg]");
  require(body.density, "density of the water [kg/m^3]");
  require(body.gravity, "gravity [m/s^2]");
  require(body.shape->volume, "volume [m^3]");
  require(static_cast<double>(body.shape->surface.triangles.size()) / 3, "number of triangles");
  if (!body.inertia.allFinite() || !body.centre_of_mass.allFinite())
    reject(*body.shape, "an entry of centre of mass or inertia", NAN, "finite");
  require(symmetricEigen<3>(body.inertia).values[0], "smallest principal moment [kg m^2]");
  // Below that the draught is lost in the rounding of the body's extents.
  constexpr double kLightest = 1e-6, kFarthest = 1e6;
  const double displaced = body.density * body.shape->volume;
  if (body.mass < kLightest * displaced)
    reject(*body.shape, "mass [kg]", body.mass,
           ("at least a millionth of that of its volume of water, " + textOf(displaced)).c_str());
  const double size = extentsOf(*body.shape).maxCoeff();
  if (body.centre_of_mass.norm() > kFarthest * size)
    reject(*body.shape, "distance of the centre of mass from the origin [m]",
           body.centre_of_mass.norm(),
           ("at most a million times its size, " + textOf(size)).c_str());
}

// Even over the sphere, none of them along an axis or a diagonal, where the energy may be largest.
Vector3 startAt(int i, int count) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
  return {r * portable::cos(golden * i + 0.1), r * portable::sin(golden * i + 0.1), z};
}

bool isSameDirection(const Vector3& a, const Vector3& b) {
  constexpr double kSameAngle = 1e-3;  // [rad]
  return (a - b).norm() < kSameAngle;
}

// An attitude and all that are alike, with the number of descents to it.
struct Found {
  FloatingPose pose;
  std::vector<Vector3> ups;
  int descents = 0;
};

void add(const FloatingPose& pose, double scale, std::vector<Found>& found) {
  constexpr double kSameEnergy = 1e-7;
  auto same = std::find_if(found.begin(), found.end(), [&](const Found& old) {
    return std::abs(old.pose.energy - pose.energy) <= kSameEnergy * scale;
  });
  if (same == found.end()) same = found.insert(same, {pose, {}, 0});
  ++same->descents;
  const auto is_known = [&](const Vector3& up) { return isSameDirection(up, pose.plane.normal); };
  if (std::none_of(same->ups.begin(), same->ups.end(), is_known))
    same->ups.push_back(pose.plane.normal);
}

}  // namespace

std::vector<FloatingAttitude> findFloatingAttitudes(const FloatingBody& body) {
  constexpr int kStarts = 400;
  checkFloating(body);
  if (body.mass + body.density * waterIn(body) >= body.density * body.shape->volume) return {};
  const PackedHull hull(*body.shape);
  const double scale = body.mass * body.gravity * portable::cbrt(body.shape->volume);
  std::vector<Found> found;
  for (int i = 0; i < kStarts; ++i) add(settle(body, hull, startAt(i, kStarts)), scale, found);
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.descents > b.descents; });
  std::vector<FloatingAttitude> attitudes;
  for (const Found& each : found) {
    attitudes.push_back(describe(body, hull, each.pose));
    attitudes.back().share = static_cast<double>(each.descents) / kStarts;
    attitudes.back().alike = static_cast<int>(each.ups.size());
  }
  return attitudes;
}

}  // namespace ambient
