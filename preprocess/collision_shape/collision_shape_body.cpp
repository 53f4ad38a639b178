#include "preprocess/collision_shape/collision_shape_body.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "bullet_ambient/fluid_body/fnv1a.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/collision_shape/collision_solids.h"
#include "preprocess/collision_shape/solid_contact.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/join_meshes.h"
#include "preprocess/mesh/plain_text.h"
#include "preprocess/potential_flow/potential_flow.h"
#include "preprocess/potential_flow/shape_symmetry.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

std::string nameOf(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  return settings.name.empty() ? shape.getName() : settings.name;
}

void requireUsable(const CollisionShapeSettings& settings, const std::string& name) {
  const auto require = [&](const char* what, int value, int least) {
    if (value >= least && value <= kMostDivisions) return;
    raiseInputError(name, what, " = ", value, " is not between ", least, " and ", kMostDivisions);
  };
  require("faces", settings.faces, 1);
  require("max_panels", settings.flow.max_panels, 0);
  require("threads", settings.flow.threads, 0);
}

std::vector<Solid> solidsOf(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  requireUsable(settings, nameOf(shape, settings));
  SolidResolution resolution;
  resolution.faces = settings.faces;
  resolution.flow_faces = std::max(settings.faces, settings.flow.max_panels);
  return makeCollisionSolids(shape, settings.margins, resolution, nameOf(shape, settings));
}

void appendBytes(const TriangleMesh& mesh, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(mesh.vertices.data()),
               static_cast<std::size_t>(mesh.vertices.size()) * sizeof(double));
  bytes.append(reinterpret_cast<const char*>(mesh.triangles.data()),
               static_cast<std::size_t>(mesh.triangles.size()) * sizeof(int));
}

Provenance provenanceOf(const btCollisionShape& shape, const std::vector<Solid>& solids,
                        const CollisionShapeSettings& settings) {
  std::string bytes;
  for (const Solid& solid : solids) {
    appendBytes(solid.mesh, bytes);
    appendBytes(solid.flow, bytes);
    appendBytes(solid.cavities, bytes);
  }
  Provenance provenance;
  provenance.source = std::string("collision shape ") + shape.getName();
  provenance.source_hash = fnv1a64(bytes);
  provenance.settings = std::string(settings.margins ? "with" : "without") + " margins, faces " +
                        std::to_string(settings.faces) + ", panels " +
                        std::to_string(settings.flow.max_panels);
  provenance.generator = libraryVersion();
  return provenance;
}

void requireGaps(const std::vector<Solid>& solids, const std::string& name) {
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!areInContact(solids[i].mesh, solids[j].mesh)) continue;
      raiseInputError(name, solids[j].part, " and ", solids[i].part, " overlap or touch, and the ",
                      "flow needs the surface of their union: make the fluid body of one closed ",
                      "mesh or one convex hull of them (the collision shape may stay as it is), ",
                      "or leave a gap of ", kLeastGap, " of the smaller one's size");
    }
  }
}

/// What a user should know about the body, one line each.
void reportSolids(const std::vector<Solid>& solids, double volume,
                  const CollisionShapeSettings& settings, const std::string& name) {
  constexpr double kMuch = 0.1;
  double margins = 0;
  for (const Solid& solid : solids) {
    margins += solid.margin_volume;
    for (const std::string& warning : solid.warnings) settings.report(warning);
  }
  if (margins <= kMuch * (volume - margins)) return;
  std::ostringstream text;
  text.precision(4);
  text << name << ": the margin that Bullet collides with is part of the body: its volume is "
       << volume << " m^3, without the margin it would be " << volume - margins
       << " m^3; set a smaller margin, or leave margins out (CollisionShapeSettings::margins, "
       << "--no-margins)";
  settings.report(text.str());
}

/// One surface of all solids, or of all cavities.
TriangleMesh joined(const std::vector<Solid>& solids, TriangleMesh Solid::*surface) {
  std::vector<TriangleMesh> parts;
  for (const Solid& solid : solids) parts.push_back(solid.*surface);
  return joinMeshes(parts);
}

PotentialFlow solveFlow(const TriangleMesh& mesh, const CollisionShapeSettings& settings,
                        const std::string& name) {
  try {
    return solvePotentialFlow(mesh, settings.flow);
  } catch (const std::runtime_error& error) {
    raiseInputError(name, error.what());
  }
}

/// The nearest symmetric positive semi-definite matrix: extrapolation may leave a tiny negative
/// eigenvalue where the true inertia vanishes.
Matrix6 withoutNegativePart(const Matrix6& K) {
  const SymmetricEigen<6> eigen = symmetricEigen<6>(K);
  const Matrix6 positive =
      eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
  return (positive + positive.transpose()) / 2;
}

/// The added mass of a single solid about the shape's origin, if it is not that of its mesh.
void setAddedMass(const Solid& solid, const CollisionShapeSettings& settings,
                  BuildSettings& build) {
  build.added_mass = solid.added_mass;
  if (solid.added_mass || solid.flow.triangleCount() == 0) return;
  const PotentialFlow flow = solveFlow(solid.flow, settings, build.name);
  build.added_mass_parts = flow.parts;
  Matrix6 added_mass = flow.added_mass;
  if (solid.flow_ratio != 0) {
    const Matrix6 coarse = solveFlow(solid.coarse_flow, settings, build.name).added_mass;
    added_mass = withoutNegativePart(added_mass + (added_mass - coarse) / (solid.flow_ratio - 1));
  }
  build.added_mass = symmetrisedAddedMass(added_mass, solid.mesh);
}

}  // namespace

CollisionShapeSettings::CollisionShapeSettings()
    : report([](const std::string& text) {
        std::fprintf(stderr, "warning: %s\n", plainLine(text).c_str());
      }) {}

FluidBody makeFluidBody(const btCollisionShape& shape, const CollisionShapeSettings& settings) {
  const std::vector<Solid> solids = solidsOf(shape, settings);
  BuildSettings build;
  build.name = nameOf(shape, settings);
  build.origin = Eigen::Vector3d::Zero();
  build.flow = settings.flow;
  build.provenance = provenanceOf(shape, solids, settings);
  requireGaps(solids, build.name);
  if (solids.size() == 1) {
    setAddedMass(solids.front(), settings, build);
    build.sphere_radius = solids.front().sphere_radius;
  }
  build.cavities = joined(solids, &Solid::cavities);
  const FluidBody body = makeFluidBody(joined(solids, &Solid::mesh), build);
  if (settings.report) reportSolids(solids, body.volume, settings, build.name);
  return body;
}

Provenance describeCollisionShape(const btCollisionShape& shape,
                                  const CollisionShapeSettings& settings) {
  return provenanceOf(shape, solidsOf(shape, settings), settings);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
