#include "demos/simulation/body_preparation.h"

#include <memory>
#include <string>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "demos/simulation/robots/robots_in_world.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

// Triangles of a body in F, of a vessel those of its walls.
Surface surfaceAsSeen(const FluidBody& body) {
  if (body.holds.empty()) return body.surface;
  return surfaceOf(wallsOf(meshOf(body.surface), body.holds));
}

Surface readOrMakeSurface(const ShapeDescription& shape, SceneBodyCache& fluid_bodies) {
  if (const auto* from_file = std::get_if<FluidBodyFile>(&shape.geometry))
    return surfaceAsSeen(readFluidBody(from_file->file));
  const CheckedMesh checked = makeShapeMesh(shape);
  fluid_bodies.warn(checked.warnings);
  return surfaceOf(checked.mesh);
}

PreparedBody prepareStatic(const BodyDef& def, SceneBodyCache& fluid_bodies) {
  PreparedBody body;
  body.surface = readOrMakeSurface(def.shape, fluid_bodies);
  if (def.centre_of_mass) body.centre_of_mass = *def.centre_of_mass;
  return body;
}

PreparedBody prepareDynamic(const BodyDef& def, std::shared_ptr<const FluidBody> fluid_body) {
  PreparedBody body;
  body.fluid_body = std::move(fluid_body);
  // A fluid body's own frame is its shape's frame if nothing else is known of the shape.
  if (!std::holds_alternative<FluidBodyFile>(def.shape.geometry))
    body.fluid_origin = body.fluid_body->origin;
  body.surface = moved(surfaceAsSeen(*body.fluid_body), body.fluid_origin);
  const MassDistribution& per_mass = def.mass_kind == MassKind::kSurface
                                         ? body.fluid_body->surface_mass
                                         : body.fluid_body->uniform_mass;
  body.mass = def.mass;
  body.centre_of_mass = def.centre_of_mass.value_or(Vector3(body.fluid_origin + per_mass.centre));
  body.inertia = def.inertia.value_or(Matrix3(def.mass * per_mass.inertia));
  return body;
}

PreparedBody prepare(const Scene& scene, const BodyDef& def, SceneBodyCache& fluid_bodies) {
  if (def.link) return prepareLink(scene, def, fluid_bodies);
  return def.mass > 0
             ? prepareDynamic(def, fluid_bodies.get(def.shape, def.name, def.waterline_table))
             : prepareStatic(def, fluid_bodies);
}

}  // namespace

std::vector<PreparedBody> prepareBodies(const Scene& scene, SceneBodyCache& fluid_bodies) {
  std::vector<PreparedBody> bodies;
  for (const BodyDef& def : scene.bodies) {
    fluid_bodies.announce("body " + std::to_string(bodies.size() + 1) + " of " +
                          std::to_string(scene.bodies.size()));
    bodies.push_back(prepare(scene, def, fluid_bodies));
  }
  return bodies;
}

Surface moved(Surface surface, const Vector3& by) {
  for (std::size_t i = 0; i < surface.vertices.size(); ++i)
    surface.vertices[i] += by[static_cast<Eigen::Index>(i % 3)];
  return surface;
}

}  // namespace ambient
