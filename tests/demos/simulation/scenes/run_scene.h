#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/state/world_state_structs.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/inertia.h"
#include "demos/scene/scene.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/scene_run.h"
#include "demos/simulation/simulation.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/shape_builder.h"
#include "tests/reference/ellipsoid_flight.h"
#include "tests/support/temporary_folder.h"

namespace ambient {

/// Path of a scene of data/scenes.
inline std::filesystem::path sceneFile(const std::string& name) {
  return std::filesystem::path(AMBIENT_DATA) / "scenes" / (name + ".json");
}

inline Scene readNamedScene(const std::string& name,
                            const std::vector<SceneOverride>& overrides = {}) {
  return readScene(sceneFile(name), overrides);
}

/// Runs a scene with bodies prepared earlier.
inline RunRecord runPrepared(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  return runScene(scene, bodies);
}

inline std::vector<PreparedBody> prepare(const Scene& scene) {
  SceneBodyCache cache;
  return prepareBodies(scene, cache);
}

/// Prepares the bodies of a scene; scenes with equal shapes share the fluid body.
inline std::vector<PreparedBody> prepareSharing(const Scene& scene) {
  static SceneBodyCache cache;
  return prepareBodies(scene, cache);
}

inline RunRecord runSharing(const Scene& scene) {
  return runPrepared(scene, prepareSharing(scene));
}

/// Motion of the first body.
inline std::vector<MotionSample> motionOf(const std::string& scene,
                                          const std::string& model = "ambient") {
  return runSharing(readNamedScene(scene, {{"model", model}})).motion[0];
}

/// Scene with the first body's flow solved on its mesh triangles only: faster, within a percent.
/// Writes the .ambient file into the folder.
inline Scene readCoarseScene(const std::string& name, const TemporaryFolder& folder,
                             std::vector<SceneOverride> overrides = {}) {
  ShapeBuildSettings settings;
  settings.name = name;
  settings.origin = Vector3::Zero();
  settings.flow.max_panels = 0;
  const std::filesystem::path file = folder / (name + ".ambient");
  if (!std::filesystem::exists(file))
    writeFluidBody(buildShape(readNamedScene(name, overrides).bodies[0].shape, settings).body,
                   file);
  overrides.push_back(
      {"bodies.0.shape", R"({"type": "fluid_body", "file": ")" + file.string() + "\"}"});
  return readNamedScene(name, overrides);
}

inline RunRecord run(const Scene& scene) { return runPrepared(scene, prepare(scene)); }

/// Converts a body of a scene for the reference. @pre a sphere or an ellipsoid in a still medium
inline reference::EllipsoidInFluid ellipsoidOf(const Scene& scene, std::size_t index) {
  const BodyDef& body = scene.bodies[index];
  reference::EllipsoidInFluid ellipsoid;
  if (const auto* sphere = std::get_if<Sphere>(&body.shape.geometry))
    ellipsoid.semi_axes = Vector3::Constant(sphere->radius);
  else
    ellipsoid.semi_axes = std::get<Ellipsoid>(body.shape.geometry).semi_axes;
  ellipsoid.mass = body.mass;
  // Moment of inertia of a ball: solid or shell.
  const double share = body.mass_kind == MassKind::kSurface ? 2.0 / 3 : 0.4;
  ellipsoid.moments = share * body.mass * ellipsoid.semi_axes.cwiseAbs2();
  if (body.inertia) ellipsoid.moments = body.inertia->diagonal();
  ellipsoid.density = scene.medium.density;
  ellipsoid.viscosity = body.attach.flow.skin_friction ? scene.medium.viscosity : 0;
  ellipsoid.separation_angle = body.attach.flow.separation_angle;
  ellipsoid.gravity = scene.gravity;
  return ellipsoid;
}

/// Reference flight of a body of a scene, from the origin.
inline reference::EllipsoidFlight referenceFlight(const Scene& scene, std::size_t index = 0) {
  const BodyDef& body = scene.bodies[index];
  return {ellipsoidOf(scene, index), body.orientation, body.linear_velocity, body.angular_velocity};
}

/// Pressure and friction on the first body of a scene for a motion about its centre of mass. Both
/// are in the body's axes.
inline Wrench loadOn(const Scene& scene, const PreparedBody& body, const Twist& motion_B) {
  LoadSettings settings;
  settings.density = scene.medium.density;
  settings.viscosity = scene.medium.viscosity;
  settings.separation_cosine = separationCosine(scene.bodies[0].attach.flow.separation_angle);
  FrameOffset fluid_frame;
  fluid_frame.translation = body.fluid_origin - body.centre_of_mass;
  const FluidBody& fluid = *body.fluid_body;
  return fluid_frame.toB(
      computeFaceLoads(fluid.faces, std::sqrt(fluid.area), fluid_frame.toF(motion_B), settings)
          .total());
}

/// Power of pressure and friction on the first body of a scene during its motion [W].
inline double powerOfLoads(const Scene& scene, const PreparedBody& body, const MotionSample& at) {
  const Quaternion to_body = at.orientation.conjugate();
  const Twist motion_B{to_body * at.twist.angular, to_body * at.twist.linear};
  return power(loadOn(scene, body, motion_B), motion_B);
}

/// Weight less buoyancy [N].
inline double weightIn(const Scene& scene, const PreparedBody& body) {
  return (body.mass - scene.medium.density * body.fluid_body->volume) * -scene.gravity.z();
}

/// Overlapping pairs in Bullet's order, from which the order of its rows follows.
inline std::vector<std::pair<int, int>> pairsOf(const Simulation& simulation) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& pair : simulation.state().world.pairs)
    pairs.emplace_back(pair.object_a, pair.object_b);
  return pairs;
}

/// Expects that a simulation and one that has got its saved state go on alike, bit for bit; again
/// and again after 17 more steps. Where Bullet finds several pairs in one step their order is that
/// of its tree, which is not saved: from there on nothing is expected until the next time. At least
/// `share` of all steps are compared.
inline void expectSavedStatesGoOn(const Scene& scene, int rounds = 1, double share = 1) {
  constexpr int kSteps = 30;
  const std::vector<PreparedBody> bodies = prepareSharing(scene);
  Simulation simulation(scene, bodies), other(scene, bodies);
  int compared = 0;
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < 17; ++i) simulation.step();
    const std::size_t pushed = bodies.size() - 1;
    simulation.applyForce(pushed, Vector3(0, 1e-3, 0), simulation.sample()[pushed].position);
    other.restoreState(simulation.saveState());
    EXPECT_EQ(other.time(), simulation.time());
    for (int i = 0; i < kSteps; ++i) {
      simulation.step();
      other.step();
      if (pairsOf(other) != pairsOf(simulation)) break;
      ++compared;
      const std::vector<MotionSample> there = other.sample(), here = simulation.sample();
      for (std::size_t body = 0; body < bodies.size(); ++body) {
        EXPECT_EQ(there[body].position, here[body].position) << scene.name << ", " << round;
        EXPECT_EQ(there[body].twist.vector(), here[body].twist.vector())
            << scene.name << ", " << round;
      }
    }
  }
  EXPECT_GE(compared, share * rounds * kSteps);
}

}  // namespace ambient
