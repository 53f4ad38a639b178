// Bodies without contacts: loads, integrators, forces from outside.

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "demos/integrators/integrators.h"
#include "tests/golden/golden_world.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

constexpr int kFlightSteps = 120;

// Quadratic drag and a torque that the library's laws do not contain.
class QuadraticDrag : public SurfaceLoads {
 public:
  Wrench load(const Twist& twist) const noexcept override {
    return {-0.05 * twist.angular, -3 * twist.linear.norm() * twist.linear};
  }
};

struct NamedDef {
  std::string name;
  AttachDef attach;
};

NamedDef withChange(const std::string& name, AttachDef attach,
                    const std::function<void(AttachDef&)>& change) {
  change(attach);
  return {name, attach};
}

AttachDef sphereInWater() {
  FluidBody sphere = facelessEllipsoid(Vector3::Constant(0.2));
  sphere.sphere_radius = 0.2;
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(sphere);
  attach.medium = water();
  attach.flow.law = PressureLaw::kPublished;
  return attach;
}

std::vector<NamedDef> loadVariants(const std::string& prefix, const AttachDef& attach) {
  const auto named = [&](const std::string& name, const std::function<void(AttachDef&)>& change) {
    return withChange(prefix + "_" + name, attach, change);
  };
  return {
      named("default", [](AttachDef&) {}),
      named("attached", [](AttachDef& a) { a.flow.separation_angle = 2.2; }),
      named("form", [](AttachDef& a) { a.flow.law = PressureLaw::kForm; }),
      named("without_friction", [](AttachDef& a) { a.flow.skin_friction = false; }),
      named("in_air", [](AttachDef& a) { a.medium = air(); }),
      named("own_model",
            [](AttachDef& a) {
              a.flow.own_law = [](const auto&, const auto&) {
                return std::make_shared<QuadraticDrag>();
              };
            }),
      named("in_a_current",
            [](AttachDef& a) {
              a.medium.velocity = {1, -2, 0.5};
              a.medium.acceleration = {-2, 3, 1};
            }),
  };
}

AttachDef inDoublePrecision(AttachDef attach) {
  attach.flow.precision = LoadPrecision::kDouble;
  return attach;
}

std::vector<NamedDef> integratorVariants(const std::string& prefix, const AttachDef& attach) {
  const auto named = [&](const std::string& name, OwnFlight integrator, int substeps) {
    return withChange(prefix + "_" + name, attach, [&](AttachDef& a) {
      a.flight.own_flight = integrator;
      a.flight.max_substeps = substeps;
    });
  };
  return {named("one_substep", nullptr, 1), named("dormand_prince", flyDormandPrince, 0),
          named("runge_kutta", flyRungeKutta, 0), named("symplectic_euler", flySymplecticEuler, 0)};
}

std::vector<NamedDef> shapeVariants() {
  AttachDef faceless = symmetricInWater();
  faceless.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid({0.3, 0.2, 0.1}));
  return {{"faceless", faceless}};
}

std::vector<NamedDef> allVariants() {
  std::vector<NamedDef> all = shapeVariants();
  for (const auto& variants :
       {loadVariants("symmetric", symmetricInWater()), loadVariants("bumpy", bumpyInWater()),
        loadVariants("bumpy_double_precision", inDoublePrecision(bumpyInWater())),
        loadVariants("sphere", sphereInWater()),
        integratorVariants("symmetric", symmetricInWater()),
        integratorVariants("bumpy", bumpyInWater())})
    all.insert(all.end(), variants.begin(), variants.end());
  return all;
}

// Initial state of body `index`: heavier or lighter than water, slow or fast.
GoldenBody flying(int index) {
  GoldenBody body;
  const double x = index;
  body.position = {3 * x, 0, 1};
  body.twist = {{2 - x, 1 + 3 * x, -1.5}, {1 + x, 0.5, -0.25 * x}};
  body.mass = index % 3 == 2 ? 0.5 : 30;
  body.moments *= body.mass / 3;
  return body;
}

// Three bodies of different mass and motion in water; the third is lighter than its added mass.
GoldenRecord fly(const AttachDef& attach) {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), attach);
  return world.run(kFlightSteps);
}

// Eleven different bodies side by side.
GoldenRecord flyTogether() {
  GoldenWorld world;
  const std::vector<NamedDef> variants = allVariants();
  for (int i = 0; i < 11; ++i) world.add(flying(i), variants[3 * i % variants.size()].attach);
  return world.run(kFlightSteps);
}

GoldenRecord flyInWind() {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), i == 1 ? symmetricInWater() : bumpyInWater());
  return world.run(kFlightSteps, [&](int step) {
    Medium medium = water();
    const double t = step * GoldenWorld::kStep;
    medium.velocity = {3 * t, 1 - 2 * t * t, 0};
    medium.acceleration = {3, -4 * t, 0};
    if (step > 60) medium.density = 900;
    for (int i = 0; i < 3; ++i) world.fluid().find(world.body(i))->setMedium(medium);
  });
}

// Forces, impulses, damping, a change of mass, and a spin above Bullet's limit.
GoldenRecord flyPushed() {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), bumpyInWater());
  world.body(1).setAngularVelocity({30, -300, 10});
  world.body(2).setDamping(bt(0.2), bt(0.4));
  return world.run(kFlightSteps, [&](int step) {
    world.body(0).applyForce({bt(3), bt(-step), 5}, {bt(0.1), 0, bt(0.2)});
    world.body(1).applyTorque({bt(0.1 * step), 0, bt(-0.3)});
    if (step % 30 == 7)
      world.fluid()
          .find(world.body(2))
          ->applyImpulse(Wrench::ofForceAt(toVector3(btVector3(bt(0.1), bt(0.3), 0)),
                                           toVector3(btVector3(0, 0, bt(0.1)))));
    if (step == 50) world.body(0).setMassProps(bt(20), {bt(0.2), bt(0.3), bt(0.4)});
  });
}

GoldenRecord flyWithLockedAxes() {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), i == 1 ? symmetricInWater() : bumpyInWater());
  world.body(0).setLinearFactor({1, 1, 0});
  world.body(0).setAngularFactor({0, 0, 1});
  world.body(1).setAngularFactor({0, 1, 1});
  world.body(2).setLinearFactor({0, 1, 1});
  return world.run(kFlightSteps);
}

GoldenRecord flyWithAxisFactors() {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), i == 1 ? symmetricInWater() : bumpyInWater());
  for (int i = 0; i < 3; ++i) world.body(i).setLinearFactor({1, bt(0.5), bt(0.3 * i)});
  world.body(0).setAngularFactor({bt(0.5), 2, 1});
  return world.run(kFlightSteps);
}

// Thousands of radians per step: outside the series of the flow without loads.
GoldenRecord flyWildly() {
  GoldenWorld world;
  for (int i = 0; i < 3; ++i) world.add(flying(i), bumpyInWater());
  AttachDef ideal = bumpyInWater();
  ideal.medium.viscosity = 0;
  ideal.fluid_body = std::make_shared<FluidBody>(facelessEllipsoid({0.3, 0.2, 0.1}));
  world.add(flying(3), ideal);
  for (int i = 0; i < 4; ++i)
    world.body(i).setAngularVelocity({bt(1e6), bt(3e5 * (i + 1)), bt(-1e4)});
  return world.run(20);
}

}  // namespace

std::vector<GoldenRun> goldenFlights() {
  std::vector<GoldenRun> runs;
  for (const NamedDef& variant : allVariants())
    runs.push_back({"flight_" + variant.name, [attach = variant.attach] { return fly(attach); }});
  runs.push_back({"flight_together", flyTogether});
  runs.push_back({"flight_in_wind", flyInWind});
  runs.push_back({"flight_pushed", flyPushed});
  runs.push_back({"flight_with_locked_axes", flyWithLockedAxes});
  runs.push_back({"flight_with_axis_factors", flyWithAxisFactors});
  runs.push_back({"flight_wild", flyWildly});
  return runs;
}

}  // namespace ambient::test
