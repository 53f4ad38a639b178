#include "preprocess/builder/fluid_body_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/surface/hold_flow.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wings/triangle_tree.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/waterline/waterline_builder.h"

namespace ambient {

namespace {

/// Whether a point is in a closed mesh, whichever way its normals look.
bool isIn(const TriangleMesh& mesh, const Vector3& point) {
  return std::abs(solidAngle(mesh, point)) > 2 * kPi;
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

/// A vessel that holds are added to, and the meshes that change with them.
struct GivenTo {
  const TriangleMesh& closed;  ///< of the vessel, or of the body without holds
  const std::string& source;   ///< begins lines and messages
  std::vector<Hold>& holds;
  TriangleMesh& walls;     ///< with holds: the faces of walls alone
  TriangleMesh& cavities;  ///< closed surfaces inside that nothing fills
};

void addTank(const std::filesystem::path& file, double scale, const GivenTo& to) {
  const std::string name = file.string();
  const CheckedMesh tank = requireSound(checkMesh(importMesh(file, scale).mesh, name), name);
  if (hasPoint(tank.mesh, false, to.closed))
    raiseInputError(name, "the tank is not wholly inside ", to.source);
  for (const Hold& hold : to.holds) {
    const TriangleMesh room = meshOf(hold.surface);
    if (hasPoint(tank.mesh, true, room) || hasPoint(room, true, tank.mesh))
      raiseInputError(name, "the tank reaches into the ", hold.name, " of ", to.source);
  }
  to.holds.push_back(tankOf(tank.mesh, file.stem().string()));
  // A tank in a cavity is empty as a part of it: its surface, outward, keeps its room from being
  // taken off the uniform mass twice.
  TriangleMesh& cavities = to.cavities;
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
    const int wall = TriangleTree(walls).nearest(place);
    const double distance = (nearestPoint(cornersOf(walls, wall), place) - place).norm();
    if (distance < nearest.distance) nearest = {i, distance};
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
  if (to.holds.empty()) raiseInputError(name, "there is no hold that it could open");
  const NearestWall nearest = nearestWall(to.holds, opening.place);
  Hold& hold = to.holds[nearest.hold];
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

/// Adds the tanks and openings that a user has given to the holds of a vessel. A tank is a hold
/// without openings, in the walls or in a cavity of the body; an opening belongs to the hold whose
/// wall is nearest. Returns a line for each tank.
/// @throws std::runtime_error in one line that names the file of the tank, if it is no closed body,
/// is not inside the vessel or reaches into another hold; or the number of the opening, if it has
/// no area or direction, or no hold is near
std::vector<std::string> addGivenHolds(const HoldSearch& given, const GivenTo& to) {
  const auto found = static_cast<std::ptrdiff_t>(to.holds.size());
  for (const std::filesystem::path& file : given.tanks) addTank(file, given.tank_scale, to);
  if (!given.tanks.empty())
    to.walls = joinMeshes(
        {found == 0 ? to.closed : to.walls, emptied({to.holds.begin() + found, to.holds.end()})});
  for (std::size_t i = 0; i < given.openings.size(); ++i) addOpening(given.openings[i], i + 1, to);
  std::vector<std::string> lines;
  for (auto hold = to.holds.begin() + found; hold != to.holds.end(); ++hold)
    lines.push_back(inputMessage(to.source, holdText(*hold), "; a tank"));
  return lines;
}

/// Text of the tanks and openings for Provenance::settings, with hashes of the files; begins with
/// ", " where there are some.
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

const std::string& sourceOf(const BuildSettings& settings) {
  return settings.source.empty() ? settings.name : settings.source;
}

/// Uniform density between the surface and the cavities and holds.
MassDistribution uniformMassOf(const TriangleMesh& mesh, const MeshProperties& properties,
                               const BuildSettings& settings) {
  if (settings.cavities.triangleCount() == 0 && settings.found_holds.empty())
    return properties.uniform;
  return computeMassProperties(joinMeshes({mesh, settings.cavities, emptied(settings.found_holds)}))
      .uniform;
}

MassDistribution surfaceMassOf(const MeshProperties& properties, const TriangleMesh& walls) {
  if (walls.triangleCount() == 0) return properties.surface;
  return computeMassProperties(walls).surface;
}

FaceTable facesOf(const TriangleMesh& mesh, bool sheet) {
  FaceTable faces;
  faces.reserve(static_cast<std::size_t>(mesh.triangleCount()) * (sheet ? 2 : 1));
  const auto addSide = [&](double side) {
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
      const Eigen::Vector3d twice_area = mesh.twiceArea(t);
      faces.add(side * twice_area.normalized(), mesh.barycentre(t), twice_area.norm() / 2);
    }
  };
  addSide(1);
  if (sheet) addSide(-1);
  return faces;
}

/// Sharpness of the faces of a body whose mesh is `whole`, divided. The parts of a triangle are as
/// sharp as it is: strips of a barrel stay round, though a part between others is flat.
std::vector<double> sharpnessOfParts(const TriangleMesh& whole, const std::vector<int>& face,
                                     const FluidBody& body) {
  FluidBody undivided;
  undivided.area = body.area;
  undivided.surface = surfaceOf(whole);
  undivided.faces = facesOf(whole, body.faces.size() > face.size());
  const std::vector<double> sharpness = computeSharpness(undivided);
  std::vector<double> parts;
  for (auto side = sharpness.begin(); side < sharpness.end(); side += whole.triangleCount())
    for (const int t : face) parts.push_back(side[t]);
  return parts;
}

MassDistribution aboutOrigin(MassDistribution mass, const Eigen::Vector3d& origin) {
  mass.centre -= origin;
  return mass;
}

/// Farther off, the digits that are left of the coordinates would not do.
void requireNearOrigin(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                       const std::string& source) {
  constexpr double kFarthest = 1e6;
  const double size = mesh.extents().norm();
  const double distance = (mesh.vertices.colwise() - origin).cwiseAbs().maxCoeff();
  if (distance <= kFarthest * size) return;
  raiseInputError(source, "the body reaches ", distance, " m from its origin, more than ",
                  kFarthest, " times its size of ", size, " m");
}

/// Refuses an added mass that is not finite, which no limit above has caught.
void requireFinite(const Matrix6& added_mass, const TriangleMesh& mesh, const std::string& source) {
  if (added_mass.allFinite()) return;
  raiseInputError(source, "its added mass is not finite: its size of ", extentsText(mesh.extents()),
                  " is beyond what can be solved");
}

void requireWaterline(const BuildSettings& settings) {
  const int subdivisions = settings.waterline_subdivisions;
  if (subdivisions < 0 || subdivisions > kMostWaterlineSubdivisions)
    raiseInputError(sourceOf(settings), "waterline subdivisions = ", subdivisions,
                    " is not between 0 (no table) and ", kMostWaterlineSubdivisions);
  if (subdivisions == 0) return;
  if (settings.flow.sheet)
    raiseInputError(sourceOf(settings), "a sheet cannot have a waterline table");
  if (settings.sphere_radius > 0)
    raiseInputError(sourceOf(settings), "a sphere needs no waterline table: all have the same one");
}

/// Makes a body the sphere that its mesh approximates; its volume is that of the sphere.
void setSphere(double radius, FluidBody& body) {
  const Matrix3 square = radius * radius * Matrix3::Identity();
  body.sphere_radius = radius;
  body.area = 4 * kPi * radius * radius;
  body.uniform_mass.inertia = 2.0 / 5 * square;
  body.surface_mass.inertia = 2.0 / 3 * square;
}

void tellStage(const BuildSettings& settings, const std::string& stage) {
  if (settings.begin) settings.begin(stage);
}

WaterlineTable waterlineOf(const FluidBody& body, const BuildSettings& settings) {
  WaterlineSettings waterline;
  waterline.subdivisions = settings.waterline_subdivisions;
  waterline.threads = settings.flow.threads;
  waterline.progress = [&settings](int done, int attitudes) {
    tellStage(settings, "waterline table, " + std::to_string(done) + " of " +
                            std::to_string(attitudes) + " attitudes");
  };
  return withSource(sourceOf(settings) + ": waterline table", [&] {
    if (body.added_mass_parts.empty())
      throw std::runtime_error("the added mass is a sum, without parts that it could correct");
    return makeWaterlineTable(body, waterline);
  });
}

/// Solves the flow about a mesh. Sets the added mass of the body, and where boundary layers leave
/// it.
void takeFlow(const TriangleMesh& mesh, const BuildSettings& settings, FluidBody& body,
              KnownViscousFlow& viscous_flow) {
  tellStage(settings, "solving the flow");
  const RefinedFlow flow =
      withSource(sourceOf(settings), [&] { return solveRefinedFlow(mesh, settings.flow); });
  if (flow.is_coarse && settings.warn) {
    settings.warn(
        sourceOf(settings) +
        ": its long triangles leave too few panels across its edges: the added mass may be some, "
        "at worst tens of per cent off; cut them into shorter ones, or give more panels");
  }
  body.added_mass = flow.added_mass;
  body.added_mass_parts = flow.parts;
  body.asymmetry = flow.asymmetry;
  if (settings.flow.sheet) return;
  constexpr Eigen::Index kManyStrips = 3000;  // take longer than their flow
  if (settings.flow.polyhedron && !viscous_flow.resistance && mesh.triangleCount() > kManyStrips)
    viscous_flow.resistance = computeStokesResistance(
        flow.surface, {false, StokesSettings().panels, settings.flow.threads});
  const MeshSeparation found = computeSeparation(flow.surface, flow.potential.rightCols<3>(),
                                                 translationAxes(flow.added_mass));
  viscous_flow.separation = found.separation;
  if (!found.is_resolved && settings.warn) {
    settings.warn(sourceOf(settings) +
                  ": the flow at its edges or in its hollows is not resolved: friction of "
                  "layers came out negative there and counts as 0; smaller triangles help");
  }
}

/// Sets the wings of a body, whose mesh is the source's, divided.
void takeWings(const TriangleMesh& mesh, const std::vector<int>& source_of,
               const BuildSettings& settings, FluidBody& body) {
  if (settings.wings.given.empty()) return;
  if (settings.sphere_radius > 0) raiseInputError(sourceOf(settings), "a sphere has no wings");
  std::vector<std::uint8_t> labels;
  for (const int t : source_of)
    labels.push_back(settings.wings.labels[static_cast<std::size_t>(t)]);
  withSource(sourceOf(settings),
             [&] { setWings(settings.wings, mesh, std::move(labels), settings.flow.sheet, body); });
}

}  // namespace

std::string libraryVersion() {
  return "bullet_ambient " AMBIENT_VERSION ", solver revision " + std::to_string(kSolverRevision);
}

std::vector<std::string> takeHolds(TriangleMesh& mesh, BuildSettings& settings) {
  Vessel vessel = findHolds(mesh, settings.holds, sourceOf(settings));
  if (!vessel.holds.empty()) {
    settings.walls = std::move(mesh);
    mesh = std::move(vessel.closed);
    settings.found_holds = std::move(vessel.holds);
  }
  for (const Hold& hold : settings.found_holds)
    vessel.lines.push_back(
        inputMessage(sourceOf(settings), holdText(hold, settings.holds.unit), "; it stays dry"));
  const std::vector<std::string> given = addGivenHolds(
      settings.holds,
      {mesh, sourceOf(settings), settings.found_holds, settings.walls, settings.cavities});
  vessel.lines.insert(vessel.lines.end(), given.begin(), given.end());
  return vessel.lines;
}

std::string holdsText(const HoldSearch& search) {
  std::ostringstream text;
  text.precision(17);
  text << ", holds " << (search.is_wanted ? "auto" : "none");
  if (search.is_wanted && search.up) text << ", up " << search.up->transpose();
  text << givenHoldsText(search);
  return text.str();
}

FluidBody makeFluidBody(const TriangleMesh& source_mesh, const BuildSettings& settings) {
  const MeshProperties undivided =
      requireUsualSize(source_mesh, settings.flow.sheet, sourceOf(settings));
  requireWaterline(settings);
  DividedSurface divided = divideSurface(source_mesh, settings.least_faces);
  TriangleMesh& mesh = divided.mesh;
  const bool is_divided = mesh.triangleCount() > source_mesh.triangleCount();
  const MeshProperties properties =
      is_divided ? computeMassProperties(mesh, settings.flow.sheet) : undivided;
  const Eigen::Vector3d origin = settings.origin.value_or(properties.uniform.centre);
  requireNearOrigin(mesh, origin, sourceOf(settings));
  const MassDistribution uniform_mass = uniformMassOf(mesh, properties, settings);
  mesh.vertices.colwise() -= origin;

  FluidBody body;
  KnownViscousFlow viscous_flow = settings.viscous_flow;
  if (viscous_flow.resistance)
    viscous_flow.resistance = shiftOrigin(*viscous_flow.resistance, origin);
  body.name = settings.name;
  body.provenance = settings.provenance;
  if (body.provenance.generator.empty()) body.provenance.generator = libraryVersion();
  if (settings.added_mass) {
    body.added_mass = shiftOrigin(*settings.added_mass, origin);
    body.added_mass_parts = placed(settings.added_mass_parts, 1, -origin);
  } else {
    takeFlow(mesh, settings, body, viscous_flow);
  }
  requireFinite(body.added_mass, mesh, sourceOf(settings));
  body.volume = properties.volume;
  body.area = settings.flow.sheet ? 2 * properties.area : properties.area;
  body.origin = origin;
  AMBIENT_ASSERT(body.volume >= 0 && body.area > 0 && origin.allFinite());
  AMBIENT_ASSERT(isSymmetric(body.added_mass, 1e-9));
  body.uniform_mass = aboutOrigin(uniform_mass, origin);
  body.surface_mass = aboutOrigin(surfaceMassOf(properties, settings.walls), origin);
  for (const Hold& hold : settings.found_holds) body.holds.push_back(moved(hold, -origin));
  body.centre_of_volume = properties.uniform.centre - origin;
  body.faces = facesOf(mesh, settings.flow.sheet);
  body.surface = surfaceOf(mesh);
  body.faces.sharpness =
      is_divided ? sharpnessOfParts(source_mesh, divided.face, body) : computeSharpness(body);
  AMBIENT_ASSERT(body.faces.sharpness.size() == body.faces.size());
  takeWings(mesh, divided.face, settings, body);
  AMBIENT_ASSERT(settings.sphere_radius >= 0);
  if (settings.sphere_radius > 0) setSphere(settings.sphere_radius, body);
  withSource(sourceOf(settings), [&] { prepare(body, viscous_flow, settings.flow.threads); });
  if (settings.waterline_subdivisions == 0) return body;
  tellStage(settings, "waterline table");
  body.waterline = waterlineOf(body, settings);
  return body;
}

}  // namespace ambient
