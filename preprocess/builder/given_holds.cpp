#include "preprocess/builder/given_holds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/surface/hold_flow.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/shape/json_schema.h"

namespace ambient {
namespace {

/// Whether a point is in a closed mesh, whichever way its normals look.
bool isIn(const TriangleMesh& mesh, const Vector3& point) {
  double angle = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) angle += solidAngle(mesh, t, point);
  return std::abs(angle) > 2 * kPi;
}

/// Points a little inside the faces of a closed mesh: near their corners, and in their middle.
std::vector<Vector3> pointsWithin(const TriangleMesh& mesh) {
  constexpr double kInwards = 1e-6;  // of its size: meshes may touch
  constexpr double kAside = 0.02;    // of the way from a corner to the middle
  const double inwards = kInwards * mesh.extents().norm();
  std::vector<Vector3> points;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3 middle = mesh.barycentre(t) - inwards * mesh.twiceArea(t).normalized();
    points.push_back(middle);
    for (int k = 0; k < 3; ++k) {
      const Vector3 corner = mesh.vertices.col(mesh.triangles(k, t));
      points.emplace_back(middle + (1 - kAside) * (corner - mesh.barycentre(t)));
    }
  }
  return points;
}

/// Whether a point of a mesh is in, or not in, another mesh.
bool hasPoint(const TriangleMesh& mesh, bool is_in, const TriangleMesh& other) {
  const std::vector<Vector3> points = pointsWithin(mesh);
  return std::any_of(points.begin(), points.end(),
                     [&](const Vector3& point) { return isIn(other, point) == is_in; });
}

Hold tankOf(const TriangleMesh& mesh, std::string name) {
  const MeshProperties properties = computeMassProperties(mesh);
  Hold tank;
  tank.name = std::move(name);
  tank.surface = surfaceOf(mesh);
  tank.volume = properties.volume;
  tank.centre = properties.uniform.centre;
  tank.turning_inertia = tank.volume * turningInertia(properties.uniform.inertia);
  return tank;
}

/// A vessel that holds are added to.
struct GivenTo {
  const TriangleMesh& closed;
  const std::string& source;
  const HoldsOfBody& body;
};

void addTank(const std::filesystem::path& file, double scale, const GivenTo& to) {
  const std::string name = file.string();
  const CheckedMesh tank = requireSound(checkMesh(importMesh(file, scale).mesh, name), name);
  if (hasPoint(tank.mesh, false, to.closed))
    raiseInputError(name, "the tank is not wholly inside ", to.source);
  for (const Hold& hold : to.body.holds) {
    const TriangleMesh room = meshOf(hold.surface);
    if (hasPoint(tank.mesh, true, room) || hasPoint(room, true, tank.mesh))
      raiseInputError(name, "the tank reaches into the ", hold.name, " of ", to.source);
  }
  to.body.holds.push_back(tankOf(tank.mesh, file.stem().string()));
  // A tank in a cavity is empty as a part of it: its surface, outward, keeps its room from being
  // taken off the uniform mass twice.
  TriangleMesh& cavities = to.body.cavities;
  if (cavities.triangleCount() > 0 && !hasPoint(tank.mesh, false, cavities))
    cavities = joinMeshes({cavities, tank.mesh});
}

/// The nearest wall of all holds.
struct NearestWall {
  std::size_t hold = 0;
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
};

NearestWall nearestWall(const std::vector<Hold>& holds, const Vector3& place) {
  NearestWall nearest;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const TriangleMesh walls = meshOf(holds[i].surface);
    for (Eigen::Index t = 0; t < walls.triangleCount(); ++t) {
      const double distance = (nearestPoint(cornersOf(walls, t), place) - place).norm();
      if (distance < nearest.distance) nearest = {i, distance};
    }
  }
  return nearest;
}

void addOpening(const GivenOpening& opening, std::size_t number, const GivenTo& to) {
  constexpr double kFarthest = 0.1;  // of the size of the hold
  const std::string name = to.source + ": opening " + std::to_string(number);
  if (!(opening.area > 0) || !std::isfinite(opening.area))
    raiseInputError(name, "its area of ", opening.area, " m^2 is not positive and finite");
  if (!opening.normal.allFinite() || opening.normal.isZero(0))
    raiseInputError(name, "its normal (", opening.normal.transpose(), ") is no direction");
  if (!opening.place.allFinite()) raiseInputError(name, "its place is not finite");
  if (to.body.holds.empty()) raiseInputError(name, "there is no hold that it could open");
  const NearestWall nearest = nearestWall(to.body.holds, opening.place);
  Hold& hold = to.body.holds[nearest.hold];
  const TriangleMesh walls = meshOf(hold.surface);
  const double most = kFarthest * walls.extents().norm();
  if (!(nearest.distance <= most))
    raiseInputError(name, "it is ", nearest.distance,
                    " m from the nearest wall of a hold, more than ", most, " m");
  if (!(opening.area < computeMassProperties(walls).area))
    raiseInputError(name, "its area of ", opening.area, " m^2 is above that of the walls of the ",
                    hold.name);
  hold.openings.push_back(
      openingOf({opening.place, opening.normal.stableNormalized(), opening.area}));
}

}  // namespace

std::vector<std::string> addGivenHolds(const TriangleMesh& closed, const HoldSearch& given,
                                       const std::string& source, const HoldsOfBody& body) {
  const GivenTo to{closed, source, body};
  const auto found = static_cast<std::ptrdiff_t>(body.holds.size());
  for (const std::filesystem::path& file : given.tanks) addTank(file, given.tank_scale, to);
  if (!given.tanks.empty())
    body.walls = joinMeshes({found == 0 ? closed : body.walls,
                             emptied({body.holds.begin() + found, body.holds.end()})});
  for (std::size_t i = 0; i < given.openings.size(); ++i) addOpening(given.openings[i], i + 1, to);
  std::vector<std::string> lines;
  for (auto hold = body.holds.begin() + found; hold != body.holds.end(); ++hold)
    lines.push_back(inputMessage(source, holdText(*hold), "; a tank"));
  return lines;
}

std::string givenHoldsText(const HoldSearch& given) {
  std::ostringstream text;
  text.precision(17);
  for (const std::filesystem::path& file : given.tanks)
    text << ", tank " << hashText(fnv1a64(readBytes(file)));
  for (const GivenOpening& opening : given.openings)
    text << ", opening " << opening.place.transpose() << ' ' << opening.area << ' '
         << opening.normal.transpose();
  return text.str();
}

}  // namespace ambient
