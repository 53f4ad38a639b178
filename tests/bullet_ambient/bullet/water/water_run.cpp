#include "tests/bullet_ambient/bullet/water/water_run.h"

#include <algorithm>
#include <utility>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/motion/surface/stand_lanes.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient::test {

WaterRun::WaterRun(Around around) : around_(around) {
  fluid_.world.setGravity({0, 0, bt(-kRunGravity)});
  fluid_.fluid.setReport([this](const std::string& sentence) { said_.push_back(sentence); });
  if (around == Around::kWater) fill(std::make_shared<StillWater>(0.0, Vector3(0, 0, 1)));
}

WaterRun::WaterRun(std::shared_ptr<const WaterSurface> surface) : WaterRun(Around::kVacuum) {
  around_ = Around::kWater;
  fill(std::move(surface));
}

void WaterRun::fill(std::shared_ptr<const WaterSurface> surface) {
  FluidRegion sea;
  sea.below = water();
  sea.above = air();
  sea.surface = std::move(surface);
  fluid_.fluid.addRegion(sea);
}

btRigidBody& WaterRun::add(const WaterBodyDef& def) {
  FloatingBody& floating =
      bodies_.emplace_back(FloatingBody{makeWaterShape(def.shape, def.size), def.size, 0, nullptr});
  const double displaced = water().density * floating.shape.fluid_body->volume;
  floating.mass = def.specific_gravity * displaced;
  BodyDef body;
  body.mass = floating.mass;
  body.moments = floating.mass * floating.shape.moments;
  body.start = def.start;
  body.shape = floating.shape.collision.get();
  floating.body = &fluid_.add(body);
  const bool is_wet = around_ == Around::kWater;
  if (is_wet) attach(floating, def);
  energy_scale_ += (floating.mass + (is_wet ? displaced : 0)) * kRunGravity * def.size;
  return *floating.body;
}

void WaterRun::attach(const FloatingBody& floating, const WaterBodyDef& def) {
  AttachDef attach;
  attach.fluid_body = floating.shape.fluid_body;
  attach.fluid_frame = floating.shape.fluid_frame;
  attach.flow.law = def.law;
  attach.flow.separation_angle = def.separation_angle;
  attach.flight.max_substeps = def.max_substeps;
  fluid_.fluid.add(*floating.body, attach);
}

void WaterRun::addPlane(const Vector3& normal, double height) {
  BodyDef plane;
  plane.mass = 0;
  plane.moments.setZero();
  plane.shape = &planes_.emplace_back(toBullet(normal), bt(height));
  fluid_.add(plane);
}

bool WaterRun::isDeep() const {
  return std::all_of(bodies_.begin(), bodies_.end(), [](const FloatingBody& floating) {
    return readState(*floating.body).position.z() < -5 * floating.size;
  });
}

double WaterRun::energy() const {
  double sum = 0;
  for (const FloatingBody& floating : bodies_) sum += energyOf(floating);
  return sum;
}

double WaterRun::energyOf(const FloatingBody& floating) const {
  const RigidState state = readState(*floating.body);
  const Vector6 x = state.twist.vector();
  const double weight = floating.mass * kRunGravity * state.position.z();
  if (around_ == Around::kVacuum) {
    const Matrix3 J = (floating.mass * floating.shape.moments).asDiagonal();
    return x.dot(rigidBodyInertia(floating.mass, J) * x) / 2 + weight;
  }
  const AmbientBody& ambient = *membersOf(fluid_.fluid).find(floating.body);
  const SurfaceModel& model = ambient.models->surfaces.at(0).model;
  const Matrix3 R = state.orientation.toRotationMatrix();
  const SurfacePlane still{{0, 0, 1}, 0, model.excess_density, kRunGravity};
  const SurfaceStand stand = standAtSurface(model, seenFrom(still, R, state.position));
  const Immersion& at = stand.immersion_F;
  const double centre = (state.position + R * model.above.centre_of_volume).z();
  const double in_air = model.above.displaced_mass * kRunGravity * centre;
  return x.dot(stand.inertia.full() * x) / 2 + weight - in_air +
         hydrostaticEnergy(at.wet, at.plane) + ambient.encounter().waves.energy();
}

}  // namespace ambient::test
