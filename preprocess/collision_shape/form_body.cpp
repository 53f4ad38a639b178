#include "preprocess/collision_shape/form_body.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/base/numerics.h"
#include "preprocess/collision_shape/solids.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/reduced_loads/form_levels.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {

namespace {

const std::string& nameOf(const ShapeForm& form, const CollisionShapeSettings& settings) {
  return settings.name.empty() ? form.kind : settings.name;
}

bool usesTables(const CollisionShapeSettings& settings) {
  return settings.tables && settings.flow.solver == FlowSolverKind::Automatic;
}

/// Names the source of the added mass, for the provenance: tables, or panels and what stands for
/// what cannot be united.
std::string sourceOf(const std::vector<PlacedShape>& parts,
                     const CollisionShapeSettings& settings) {
  const bool tables = usesTables(settings);
  if (tables && parts.size() == 1 && tabulatedAddedMass(parts.front().shape))
    return addedMassTablesName();
  return "panels " + std::to_string(settings.flow.max_panels) + ", hull" +
         (tables ? "" : ", no tables") +
         (settings.flow.solver == FlowSolverKind::Dense ? ", dense" : "") +
         (settings.flow.solver == FlowSolverKind::Hierarchical ? ", hierarchical" : "");
}

void tellStage(const CollisionShapeSettings& settings, const std::string& stage) {
  if (settings.begin) settings.begin(stage);
}

constexpr int kLeastFaces = 350;  // of a solid that is not one of many

/// Whether solids have fewer faces than each would have among few.
bool areMany(const std::vector<Solid>& solids, const CollisionShapeSettings& settings) {
  return static_cast<double>(kLeastFaces) * static_cast<double>(solids.size()) >
         static_cast<double>(kMostOfMany) * settings.faces;
}

std::vector<Solid> solidsOf(const ShapeForm& form, const CollisionShapeSettings& settings) {
  SolidResolution resolution;
  resolution.faces = settings.faces;
  resolution.least_faces = std::min(kLeastFaces, settings.faces);
  resolution.flow_faces = std::max(resolution.faces, settings.flow.max_panels);
  resolution.tables = usesTables(settings);
  resolution.strict = settings.strict;
  resolution.unit = form.size;
  return makeSolids(form.parts, resolution);
}

/// Returns warnings about the body and its solids, one line each.
std::vector<std::string> warningsOf(const std::vector<Solid>& solids, const FluidBody& body,
                                    const CollisionShapeSettings& settings) {
  std::vector<std::string> lines;
  for (const Solid& solid : solids)
    lines.insert(lines.end(), solid.warnings.begin(), solid.warnings.end());
  const auto unknown = std::count_if(solids.begin(), solids.end(),
                                     [](const Solid& solid) { return !solid.added_mass; });
  if (areMany(solids, settings) && unknown > 0) {
    lines.push_back(inputMessage(body.name, unknown, " of its ", solids.size(),
                                 " parts have neither a closed form nor a table and share ",
                                 body.faces.size(),
                                 " faces with all: the added mass may be some per cent off; give "
                                 "more faces (CollisionShapeSettings::faces)"));
  }
  return lines;
}

/// One surface of all solids, or of all cavities.
TriangleMesh joined(const std::vector<Solid>& solids, TriangleMesh Solid::*surface) {
  std::vector<TriangleMesh> parts;
  for (const Solid& solid : solids) parts.push_back(solid.*surface);
  return joinMeshes(parts);
}

/// Calls solve(), which solves a flow. @throws std::runtime_error that begins with `name`.
template <class Solve>
auto solved(const CollisionShapeSettings& settings, const std::string& name, const Solve& solve) {
  tellStage(settings, "solving the flow");
  return withSource(name, solve);
}

struct AddedMass {
  Matrix6 total = Matrix6::Zero();
  std::vector<AddedMassPart> parts;  // empty where no flow was solved
  KnownViscousFlow viscous_flow{};
};

/// What layers make of a flow that was solved on the vertices of a mesh.
KnownViscousFlow layersOf(const TriangleMesh& mesh,
                          const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential,
                          const Matrix6& added_mass) {
  return {{},
          computeSeparation(mesh, potential.topRows(mesh.vertexCount()).rightCols<3>(),
                            translationAxes(added_mass))
              .separation,
          false};
}

/// About the shape's origin.
AddedMass addedMassOf(const Solid& solid, const CollisionShapeSettings& settings,
                      const std::string& name) {
  if (solid.sphere_radius > 0) return {*solid.added_mass, {}};
  if (solid.added_mass)
    return {*solid.added_mass, mirrored(estimateParts(solid.mesh, *solid.added_mass)),
            solid.viscous_flow};
  const auto solve = [&](const TriangleMesh& mesh) {
    return solved(settings, name, [&] { return solvePotentialFlow(mesh, settings.flow); });
  };
  const PotentialFlow fine = solve(solid.flow);
  Matrix6 total = fine.added_mass;
  if (solid.flow_ratio != 0) {
    const Matrix6 coarse = solve(solid.coarse_flow).added_mass;
    total = positivePart(total + (total - coarse) / (solid.flow_ratio - 1));
  }
  total = symmetrisedAddedMass(total, solid.mesh);
  return {total, fine.parts, layersOf(solid.flow, fine.potential, total)};
}

/// Returns the added mass of many solids apart: that of one flow around all of them on their faces,
/// which has what they do to each other, with the closed form or table of each in place of what its
/// few faces give alone.
AddedMass coupledAddedMass(const std::vector<Solid>& solids, const CollisionShapeSettings& settings,
                           const std::string& name) {
  PotentialFlowSettings undivided = settings.flow;
  undivided.max_panels = 0;
  const auto solve = [&](const TriangleMesh& mesh) {
    return solved(settings, name, [&] { return solveRefinedFlow(mesh, undivided); });
  };
  const RefinedFlow all = solve(joined(solids, &Solid::mesh));
  Matrix6 total = all.added_mass;
  for (const Solid& solid : solids)
    if (solid.added_mass) total += *solid.added_mass - solve(solid.mesh).added_mass;
  total = positivePart(total);
  return {total, all.parts, layersOf(all.surface, all.potential, total)};
}

/// Returns whether the added mass of a solid is not simply that of its mesh.
bool hasOwnAddedMass(const Solid& solid) {
  return solid.added_mass || solid.flow.triangleCount() > 0;
}

/// Returns the added mass of all solids together; none: the builder has to solve the flow around
/// their meshes.
std::optional<AddedMass> addedMassOf(const std::vector<Solid>& solids,
                                     const CollisionShapeSettings& settings,
                                     const std::string& name) {
  if (solids.size() == 1 && hasOwnAddedMass(solids.front()))
    return addedMassOf(solids.front(), settings, name);
  if (solids.size() > 1 && areMany(solids, settings))
    return coupledAddedMass(solids, settings, name);
  return std::nullopt;
}

/// Whether a form is several balls and capsules. Their surfaces have no edge that points outwards.
bool areRound(const ShapeForm& form) {
  return form.parts.size() > 1 &&
         std::all_of(form.parts.begin(), form.parts.end(), [](const PlacedShape& part) {
           return std::holds_alternative<Sphere>(part.shape) ||
                  std::holds_alternative<Capsule>(part.shape) ||
                  std::holds_alternative<BallHull>(part.shape);
         });
}

/// Settings of the flow around solids. Polyhedra need fewer panels than round bodies: all their
/// triangles are merged, and the added mass is extrapolated. The triangles of a union of round
/// bodies are its panels: to divide them changes the added mass of a robot's limbs by less
/// than 1 %.
PotentialFlowSettings flowSettingsFor(const std::vector<Solid>& solids, const ShapeForm& form,
                                      PotentialFlowSettings flow) {
  constexpr int kPanelsOfPolyhedra = 1500;
  flow.polyhedron = flow.max_panels > 0 && arePolyhedra(solids);
  if (flow.polyhedron) flow.max_panels = std::min(flow.max_panels, kPanelsOfPolyhedra);
  flow.convex = flow.polyhedron && form.parts.size() == 1;
  if (areRound(form) && flow.max_panels <= kDefaultPanels) flow.max_panels = 0;
  return flow;
}

/// The resistance of a single hull, on half of the panels that others have: that of links of robots
/// is within 1.3 % in rotation and 0.3 % in translation of theirs, in a third of the time.
std::optional<Matrix6> resistanceOf(const TriangleMesh& mesh, const PotentialFlowSettings& flow) {
  constexpr int kPanels = 150;
  if (!flow.convex) return std::nullopt;
  return computeStokesResistance(mesh, {false, kPanels, flow.threads});
}

bool isBox(const ShapeForm& form) {
  return form.parts.size() == 1 && std::holds_alternative<Box>(form.parts.front().shape);
}

bool isSphere(const ShapeForm& form) {
  return form.parts.size() == 1 && std::holds_alternative<Sphere>(form.parts.front().shape);
}

bool isTabulated(const ShapeForm& form, const CollisionShapeSettings& settings) {
  return usesTables(settings) && form.parts.size() == 1 &&
         tabulatedAddedMass(form.parts.front().shape);
}

/// Whether a form may have holds: it is a mesh or several shapes.
bool mayHaveHolds(const ShapeForm& form, const CollisionShapeSettings& settings) {
  return settings.holds &&
         (form.parts.size() > 1 || std::holds_alternative<TriangleSoup>(form.parts.front().shape));
}

/// Settings with a number of faces. The default law takes sides of a box as they are, so that few
/// triangles do; no loads on a sphere come from its own; round bodies of known added mass need them
/// for the loads alone.
CollisionShapeSettings withFaces(CollisionShapeSettings settings, const ShapeForm& form) {
  constexpr int kFaces = 1300, kRoundFaces = 500, kBoxFaces = 350, kSphereFaces = 80;
  if (settings.faces > 0) return settings;
  settings.faces = isSphere(form)                 ? kSphereFaces
                   : !isTabulated(form, settings) ? kFaces
                   : isBox(form)                  ? kBoxFaces
                                                  : kRoundFaces;
  return settings;
}

/// Rules for the faces of the form law; none of shapes that have none.
struct FacesByRule {
  const FrameOffset pose;

  FormFaces operator()(const Box& s) const {
    return [s, pose = pose](const FluidBody&) { return boxFaces(s.half_sizes, pose); };
  }
  FormFaces operator()(const Cylinder& s) const {
    return [s, pose = pose](const FluidBody& body) {
      return cylinderFaces(s.radius, s.height, pose, body);
    };
  }
  FormFaces operator()(const Capsule& s) const {
    return [s, pose = pose](const FluidBody& body) {
      return capsuleFaces(s.radius, s.height, pose, body);
    };
  }
  FormFaces operator()(const Cone& s) const {
    return [s, pose = pose](const FluidBody& body) {
      return coneFaces(s.radius, s.height, pose, body);
    };
  }
  template <class Other>
  FormFaces operator()(const Other&) const {
    return nullptr;
  }
};

/// Returns the rule for few faces of the form law in place of all; none, or all are needed: null.
FormFaces facesByRule(const ShapeForm& form, const CollisionShapeSettings& settings) {
  if (form.parts.size() > 1 || settings.load_error < kRuleError) return nullptr;
  const PlacedShape& part = form.parts.front();
  return std::visit(FacesByRule{{part.pose.linear(), part.pose.translation()}}, part.shape);
}

/// Gives a body a level of few faces for the form law beside all, if not all are needed.
void addFewFaces(const CollisionShapeSettings& settings, FluidBody& body) {
  if (settings.load_error == 0 || body.sphere_radius > 0) return;
  tellStage(settings, "choosing few faces");
  if (auto level = smallestFormLevel(body, settings.load_error))
    body.form_levels.push_back(*std::move(level));
}

FluidBody bodyOf(const std::vector<Solid>& solids, const ShapeForm& form,
                 const CollisionShapeSettings& settings) {
  BuildSettings build;
  build.name = nameOf(form, settings);
  build.origin = Eigen::Vector3d::Zero();
  build.provenance = describeForm(form, settings);
  build.begin = settings.begin;
  build.holds.is_wanted = mayHaveHolds(form, settings);
  build.holds.unit = form.size;
  build.flow = flowSettingsFor(solids, form, settings.flow);
  if (solids.size() == 1) build.sphere_radius = solids.front().sphere_radius;
  if (build.sphere_radius == 0) build.waterline_subdivisions = settings.waterline_subdivisions;
  build.cavities = joined(solids, &Solid::cavities);
  TriangleMesh mesh = joined(solids, &Solid::mesh);
  std::vector<std::string> lines;
  if (build.holds.is_wanted) lines = takeHolds(mesh, build);
  if (std::optional<AddedMass> known =
          build.found_holds.empty() ? addedMassOf(solids, settings, build.name) : std::nullopt) {
    build.added_mass = known->total;
    build.added_mass_parts = std::move(known->parts);
    build.viscous_flow = known->viscous_flow;
  } else {
    build.viscous_flow.resistance =
        solved(settings, build.name, [&] { return resistanceOf(mesh, build.flow); });
  }
  build.viscous_flow.form_faces = facesByRule(form, settings);
  FluidBody body = makeFluidBody(mesh, build);
  if (!build.viscous_flow.form_faces) addFewFaces(settings, body);
  body.provenance.said = warningsOf(solids, body, settings);
  body.provenance.said.insert(body.provenance.said.end(), lines.begin(), lines.end());
  return body;
}

}  // namespace

bool isSoonMade(const ShapeForm& form, const CollisionShapeSettings& settings) {
  return isSphere(form) || (isTabulated(form, settings) && settings.waterline_subdivisions == 0);
}

void requireUsable(const CollisionShapeSettings& settings, const std::string& name) {
  const auto require = [&](const char* what, int value, int least) {
    if (value >= least && value <= kMostDivisions) return;
    raiseInputError(name, what, " = ", value, " is not between ", least, " and ", kMostDivisions);
  };
  require("faces", settings.faces, 0);
  require("max_panels", settings.flow.max_panels, 0);
  require("threads", settings.flow.threads, 0);
  if (!(settings.load_error >= 0))
    raiseInputError(name, "load_error = ", settings.load_error, " is negative");
}

FluidBody makeFormBody(const ShapeForm& form, const CollisionShapeSettings& wanted) {
  const CollisionShapeSettings settings = withFaces(wanted, form);
  const std::string& name = nameOf(form, settings);
  const std::vector<Solid> parts = solidsOf(form, settings);
  if (parts.size() > 1) tellStage(settings, "uniting " + std::to_string(parts.size()) + " shapes");
  std::string reason;
  for (const JoinedBy by : {JoinedBy::kUnion, JoinedBy::kWrap, JoinedBy::kHull}) {
    const SeparateSolids separate = uniteSolids(parts, settings.faces, name, by, reason);
    try {
      return bodyOf(separate.solids, form, settings);
    } catch (const std::runtime_error& error) {
      if (!separate.are_joined) throw;
      reason = error.what();
    }
  }
  throw std::runtime_error(reason);
}

Provenance describeForm(const ShapeForm& form, const CollisionShapeSettings& wanted) {
  const CollisionShapeSettings settings = withFaces(wanted, form);
  Provenance provenance;
  provenance.source = "collision shape " + form.kind;
  provenance.source_hash = fnv1a64(contentOf(form.parts));
  std::ostringstream text;
  text << "faces " << settings.faces << ", load error " << settings.load_error << " of form law "
       << kFormLawRevision << ", " << sourceOf(form.parts, settings);
  if (settings.waterline_subdivisions != 0)
    text << ", waterline " << settings.waterline_subdivisions;
  if (settings.strict) text << ", strict";
  if (form.parts.size() > 1 || std::holds_alternative<TriangleSoup>(form.parts.front().shape))
    text << holdsText({settings.holds, std::nullopt, 1});
  provenance.settings = text.str();
  provenance.generator = libraryVersion();
  return provenance;
}

}  // namespace ambient
