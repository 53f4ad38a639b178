#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/saved_state.h"
#include "preprocess/base/surface_form.h"

namespace ambient::test {

/// A small fluid body with something in every field; no real body has these values.
inline FluidBody seedFluidBody() {
  FluidBody body;
  body.name = "seed";
  body.provenance = {"seed.obj", 1, "none", "fuzz"};
  body.added_mass = Matrix6::Identity();
  body.volume = 1;
  body.area = 2;
  body.uniform_mass.inertia = body.surface_mass.inertia = Matrix3::Identity();
  body.faces.add(Vector3::UnitX(), Vector3::UnitY(), 1);
  body.faces.add(-Vector3::UnitX(), Vector3::UnitZ(), 1);
  body.surface.vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  body.surface.triangles = {0, 1, 2, 0, 2, 1};
  makeSurfaceForm(body);
  return body;
}

/// A multibody of two links, the second one in fluid at the surface of water.
inline MultiBodyState seedMultiBody(const AmbientState& ambient) {
  MultiBodyState body;
  body.velocity.assign(7, 0);
  body.links.resize(2);
  for (MultiBodyLinkState& link : body.links) link.mass = 1;
  body.links[1].collider.emplace();
  body.fluids.push_back({0, ambient});
  body.fluids[0].ambient.plane_B = SurfacePlane{};
  return body;
}

/// A state of two bodies that touch, one in fluid, with a joint, and of a multibody with a motor.
inline WorldState seedState() {
  WorldState state;
  state.bodies.resize(2);
  state.bodies[1].inverse_mass = 1;
  AmbientState& ambient = state.bodies[1].ambient.emplace();
  ambient.def.fluid_body = std::make_shared<const FluidBody>(seedFluidBody());
  ambient.def.medium = air();
  state.multi_bodies.push_back(seedMultiBody(ambient));
  state.multi_body_joints.push_back({{1}});
  state.pairs.push_back({0, 1});
  state.contacts.push_back({{0, 1}, 0, std::vector<btManifoldPoint>(2)});
  state.joints.emplace_back();
  return state;
}

}  // namespace ambient::test
