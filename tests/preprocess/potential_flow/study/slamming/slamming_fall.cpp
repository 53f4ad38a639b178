#include "tests/preprocess/potential_flow/study/slamming/slamming_fall.h"

#include <algorithm>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::study {
namespace {

constexpr double kDensity = 1000;        // water [kg/m^3]
constexpr double kLittleGravity = 1e-6;  // [m/s^2]; 0 would remove the surface

/// Lowest and highest z in F.
std::pair<double, double> extentOf(const FluidBody& body) {
  const double centre = body.centre_of_volume.z();
  if (body.sphere_radius > 0) return {centre - body.sphere_radius, centre + body.sphere_radius};
  const std::vector<double>& v = body.surface.vertices;
  double low = v[2], high = v[2];
  for (std::size_t i = 2; i < v.size(); i += 3) {
    low = std::min(low, v[i]);
    high = std::max(high, v[i]);
  }
  return {low, high};
}

btRigidBody& addBody(const FallDef& def, double height, test::FluidWorld& scene) {
  test::BodyDef body;
  body.mass = def.specific_gravity * kDensity * def.shape->volume;
  body.moments = body.mass * def.shape->uniform_mass.inertia.diagonal();
  body.start.position = {0, 0, height};
  body.start.twist.linear = {0, 0, -def.speed};
  btRigidBody& added = scene.add(body);
  AttachDef attach;
  attach.fluid_body = def.shape;
  if (!def.has_loads) attach.flow.own_law = [](const auto&, const auto&) { return nullptr; };
  scene.fluid.add(added, attach);
  return added;
}

}  // namespace

double momentumOf(const SurfaceModel& model, const RigidState& state) {
  const Matrix3 R = state.orientation.toRotationMatrix();
  const SurfacePlane plane = seenFrom({Vector3::UnitZ(), 0, 1, 1}, R, state.position);
  const Matrix6 K = inertiaAt(model, immersionOf(model, plane));
  return -(R * Twist::fromVector(K * state.twist.vector()).linear).z();
}

std::vector<FallStep> fallIntoWater(const FallDef& def) {
  test::FluidWorld scene;
  scene.world.setGravity({0, 0, test::bt(-kLittleGravity)});
  FluidRegion sea;
  sea.below = {kDensity, 1e-3, {0, 0, 0}, {0, 0, 0}};
  sea.above = Medium{};  // a vacuum
  sea.surface = std::make_shared<StillWater>(0.0, Vector3::UnitZ());
  scene.fluid.addRegion(sea);
  const auto [low, high] = extentOf(*def.shape);
  const btRigidBody& body = addBody(def, -low, scene);

  const auto draught = [&, low = low] {
    return -low - static_cast<double>(body.getWorldTransform().getOrigin().z());
  };
  const auto speed = [&] { return -static_cast<double>(body.getLinearVelocity().z()); };
  const double mass = def.specific_gravity * kDensity * def.shape->volume;
  std::vector<FallStep> steps;
  while (draught() < high - low && speed() > 0) {
    const double before = speed();
    scene.step(def.time_step);
    const double middle = 0.5 * (before + speed());
    const double force = mass * (before - speed()) / def.time_step;
    steps.push_back({draught(), readState(body), force / (kDensity * middle * middle)});
  }
  return steps;
}

double forceAt(const std::vector<FallStep>& fall, double draught) {
  const auto step = std::find_if(fall.begin(), fall.end(),
                                 [&](const FallStep& s) { return s.draught_after > draught; });
  return step == fall.end() ? 0 : step->force;
}

}  // namespace ambient::study
