// Bullet's own examples with all their bodies in water: what a step costs against stock Bullet, and
// whether worlds without a body in a fluid move as in stock Bullet.

#include <btBulletDynamicsCommon.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <string>

#include "bullet_ambient/ambient.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/benchmark/existing_scenes/bullet_examples.h"

namespace ambient {
namespace {

struct Options {
  std::string filter;     // examples whose name contains it
  int steps = 600;        // of 1/60 s
  double density = 2500;  // of all bodies [kg/m^3]; 0: masses as they are
  std::string law = "form";
};

constexpr int kStepsPerTurn = 10;

// Gives all bodies one density, so that none of them floats away.
void setDensity(btDiscreteDynamicsWorld& world, FluidBodyCache& shapes, double density) {
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    btRigidBody* body = btRigidBody::upcast(objects[i]);
    if (!body || body->isStaticOrKinematicObject()) continue;
    try {
      const double volume = shapes.fluidBody(*body->getCollisionShape())->volume;
      const auto mass = static_cast<btScalar>(density * volume);
      btVector3 inertia;
      body->getCollisionShape()->calculateLocalInertia(mass, inertia);
      body->setMassProps(mass, inertia);
      body->updateInertiaTensor();
    } catch (const std::exception&) {
      // Has no fluid body: keeps its mass; addAll() says why.
    }
  }
}

// Returns processor time: waiting for a core is nobody's cost.
double secondsOf(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

bool moveAlike(btDiscreteDynamicsWorld& a, btDiscreteDynamicsWorld& b) {
  const btCollisionObjectArray &of_a = a.getCollisionObjectArray(),
                               &of_b = b.getCollisionObjectArray();
  if (of_a.size() != of_b.size()) return false;
  for (int i = 0; i < of_a.size(); ++i)
    if (!(of_a[i]->getWorldTransform() == of_b[i]->getWorldTransform())) return false;
  return true;
}

// Three worlds, stepped in turns, so that other work on the machine hits all of them.
struct Row {
  AttachReport attached;
  double attach_time = 0;  // [s]
  double stock_time = 0;   // per step [s]
  double unused_ratio = 0, water_ratio = 0;
  double substeps = 0;  // per body in flight and step
  bool is_unused_equal = false;
};

Row measure(const BulletExample& example, const Options& options) {
  FluidBodyCache shapes;
  ExampleRun stock(example), unused(example), wet(example);
  const Fluid no_fluid(unused.world());
  Fluid fluid(wet.world());
  AttachSettings settings;
  settings.flow.law = options.law == "form" ? PressureLaw::kForm : PressureLaw::kPublished;
  Row row;
  if (options.density > 0)
    for (ExampleRun* run : {&stock, &unused}) setDensity(run->world(), shapes, options.density);
  FluidBodyCache own_shapes;
  row.attach_time = secondsOf([&] {
    if (options.density > 0) setDensity(wet.world(), own_shapes, options.density);
    row.attached = fluid.addAll(own_shapes, water(), settings);
  });
  double stock_total = 0, unused_total = 0, water_total = 0;
  row.is_unused_equal = true;
  for (int done = 0; done < options.steps; done += kStepsPerTurn) {
    const auto turn = [](ExampleRun& run) {
      return secondsOf([&] {
        for (int i = 0; i < kStepsPerTurn; ++i) run.step();
      });
    };
    stock_total += turn(stock);
    unused_total += turn(unused);
    water_total += turn(wet);
    row.is_unused_equal = row.is_unused_equal && moveAlike(stock.world(), unused.world());
  }
  row.stock_time = stock_total / options.steps;
  row.unused_ratio = unused_total / stock_total;
  row.water_ratio = water_total / stock_total;
  const AmbientCounters counters = fluid.counters();
  const double body_steps = static_cast<double>(row.attached.attached) * options.steps;
  row.substeps = body_steps > 0 ? static_cast<double>(counters.substeps) / body_steps : 0;
  return row;
}

void print(const BulletExample& example, const Row& row) {
  std::printf("| %s | %d | %d | %zu | %.2f | %.0f | %.2f | %s | %.2f | %.2f |\n", example.name,
              row.attached.attached, row.attached.fluid_bodies, row.attached.refused.size(),
              row.attach_time, 1e6 * row.stock_time, row.unused_ratio,
              row.is_unused_equal ? "yes" : "NO", row.water_ratio, row.substeps);
  for (const AttachReport::Refusal& refusal : row.attached.refused)
    std::fprintf(stderr, "%s: body %d: %s\n", example.name, refusal.body, refusal.reason.c_str());
  std::fflush(stdout);
}

int run(const Options& options) {
  std::puts(
      "| example | bodies in water | fluid bodies | refused | attached in [s] | stock step [us] | "
      "nothing attached | same bits | all in water | substeps |\n"
      "|---|---|---|---|---|---|---|---|---|---|");
  bool is_equal = true;
  for (const BulletExample& example : bulletExamples()) {
    if (std::string(example.name).find(options.filter) == std::string::npos) continue;
    const Row row = measure(example, options);
    print(example, row);
    is_equal = is_equal && row.is_unused_equal;
  }
  return is_equal ? 0 : 1;
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  ambient::Options options;
  CLI::App app("Bullet's examples in water: cost against stock Bullet, as a table");
  app.add_option("--filter", options.filter, "examples whose name contains this");
  app.add_option("--steps", options.steps, "steps of 1/60 s")->check(CLI::Range(10, 100000));
  app.add_option("--density", options.density, "of all bodies [kg/m^3]; 0: masses as they are")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--law", options.law, "of pressure")->check(CLI::IsMember({"form", "published"}));
  CLI11_PARSE(app, argc, argv);
  try {
    return ambient::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "existing_scenes: %s\n", error.what());
    return 2;
  }
}
