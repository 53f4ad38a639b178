#include "preprocess/floating/floating_attitudes.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/floating/floating_energy.h"

namespace ambient {
namespace {

[[noreturn]] void rejectFloating(const FloatingBody& body, const char* what, double value,
                                 const std::string& limit) {
  std::ostringstream sentence;
  sentence << "fluid body '" << body.shape->name << "': " << what << " is " << value << "; must be "
           << limit;
  throw std::invalid_argument(sentence.str());
}

std::string textOf(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void checkFloating(const FloatingBody& body) {
  const auto require = [&](double value, const char* what) {
    if (!(value > 0) || !std::isfinite(value))
      rejectFloating(body, what, value, "positive and finite");
  };
  require(body.mass, "mass [kg]");
  require(body.density, "density of the water [kg/m^3]");
  require(body.gravity, "gravity [m/s^2]");
  require(body.shape->volume, "volume [m^3]");
  require(static_cast<double>(body.shape->surface.triangles.size()) / 3, "number of triangles");
  if (!body.inertia.allFinite() || !body.centre_of_mass.allFinite())
    rejectFloating(body, "an entry of centre of mass or inertia", NAN, "finite");
  require(symmetricEigen<3>(body.inertia).values[0], "smallest principal moment [kg m^2]");
  // Below that the draught is lost in the rounding of the body's extents.
  constexpr double kLightest = 1e-6, kFarthest = 1e6;
  const double displaced = body.density * body.shape->volume;
  if (body.mass < kLightest * displaced)
    rejectFloating(body, "mass [kg]", body.mass,
                   "at least a millionth of that of its volume of water, " + textOf(displaced));
  const double size = extentsOf(*body.shape).maxCoeff();
  if (body.centre_of_mass.norm() > kFarthest * size)
    rejectFloating(body, "distance of the centre of mass from the origin [m]",
                   body.centre_of_mass.norm(), "at most a million times its size, " + textOf(size));
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
  if (body.mass >= body.density * body.shape->volume) return {};
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
