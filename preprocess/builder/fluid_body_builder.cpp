#include "preprocess/builder/fluid_body_builder.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/builder/given_holds.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "preprocess/waterline/waterline_builder.h"

namespace ambient {
namespace {

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

RefinedFlow solveFlow(const TriangleMesh& mesh, const BuildSettings& settings) {
  try {
    return solveRefinedFlow(mesh, settings.flow);
  } catch (const std::runtime_error& error) {
    raiseInputError(sourceOf(settings), error.what());
  }
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

void complete(FluidBody& body, const KnownViscousFlow& known, const BuildSettings& settings) {
  try {
    prepare(body, known, settings.flow.threads);
  } catch (const std::runtime_error& error) {
    raiseInputError(sourceOf(settings), error.what());
  }
}

WaterlineTable waterlineOf(const FluidBody& body, const BuildSettings& settings) {
  WaterlineSettings waterline;
  waterline.subdivisions = settings.waterline_subdivisions;
  waterline.threads = settings.flow.threads;
  waterline.progress = [&settings](int done, int attitudes) {
    tellStage(settings, "waterline table, " + std::to_string(done) + " of " +
                            std::to_string(attitudes) + " attitudes");
  };
  try {
    if (body.added_mass_parts.empty())
      throw std::runtime_error("the added mass is a sum, without parts that it could correct");
    return makeWaterlineTable(body, waterline);
  } catch (const std::runtime_error& error) {
    raiseInputError(sourceOf(settings), "waterline table: ", error.what());
  }
}

/// Solves the flow about a mesh. Sets the added mass of the body, and where boundary layers leave
/// it.
void takeFlow(const TriangleMesh& mesh, const BuildSettings& settings, FluidBody& body,
              KnownViscousFlow& viscous_flow) {
  tellStage(settings, "solving the flow");
  const RefinedFlow flow = solveFlow(mesh, settings);
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
  try {
    setWings(settings.wings, mesh, std::move(labels), settings.flow.sheet, body);
  } catch (const std::runtime_error& error) {
    raiseInputError(sourceOf(settings), error.what());
  }
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
  const std::vector<std::string> given =
      addGivenHolds(mesh, settings.holds, sourceOf(settings),
                    {settings.found_holds, settings.walls, settings.cavities});
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
  complete(body, viscous_flow, settings);
  if (settings.waterline_subdivisions == 0) return body;
  tellStage(settings, "waterline table");
  body.waterline = waterlineOf(body, settings);
  return body;
}

}  // namespace ambient
