#include "demos/simulation/body_preparation.h"

#include <memory>

#include "demos/simulation/collision_geometry.h"

namespace ambient {
namespace {

PreparedBody prepareStatic(const BodyDef& def) {
  PreparedBody body;
  body.collision = makeStaticGeometry(def.shape);
  if (def.centre_of_mass) body.centre_of_mass = *def.centre_of_mass;
  return body;
}

PreparedBody prepareDynamic(const BodyDef& def, std::shared_ptr<const FluidBody> fluid_body) {
  PreparedBody body;
  body.fluid_body = std::move(fluid_body);
  // A fluid body's own frame is its shape's frame if nothing else is known of the shape.
  if (!std::holds_alternative<FluidBodyShape>(def.shape.geometry))
    body.fluid_origin = body.fluid_body->origin;
  body.collision = makeDynamicGeometry(def.shape, *body.fluid_body, body.fluid_origin);
  const MassDistribution& per_mass = def.mass_kind == MassKind::kSurface
                                         ? body.fluid_body->surface_mass
                                         : body.fluid_body->uniform_mass;
  body.mass = def.mass;
  body.centre_of_mass = def.centre_of_mass.value_or(Vector3(body.fluid_origin + per_mass.centre));
  body.inertia = def.inertia.value_or(Matrix3(def.mass * per_mass.inertia));
  return body;
}

}  // namespace

std::vector<PreparedBody> prepareBodies(const Scene& scene, FluidBodyCache& fluid_bodies) {
  std::vector<PreparedBody> bodies;
  for (const BodyDef& def : scene.bodies)
    bodies.push_back(def.mass > 0 ? prepareDynamic(def, fluid_bodies.get(def.shape, def.name))
                                  : prepareStatic(def));
  return bodies;
}

}  // namespace ambient
