// Cost of a step over that of stock Bullet, in one run. The worlds take turns of a few
// steps each; each pair of turns gives a ratio. So other load of the machine hits
// both.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/pile/pile_scene.h"
#include "tests/support/bodies/ellipsoid_body.h"

namespace ambient::test {
namespace {

using Step = std::function<void()>;

// Processor time of `count` steps [s]: excludes waiting for a core.
double secondsFor(const Step& step, int count) {
  const std::clock_t begin = std::clock();
  for (int i = 0; i < count; ++i) step();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

struct Cost {
  double ratio;         // median
  double low, high;     // quartiles
  double stock_micros;  // minimum per step
};

Cost compare(const Step& stock, const Step& ambient, int turns, int steps_per_turn) {
  std::vector<double> ratios;
  double fastest = 1e300;
  for (int i = 0; i < turns; ++i) {
    const double a = secondsFor(stock, steps_per_turn);
    const double b = secondsFor(ambient, steps_per_turn);
    ratios.push_back(b / a);
    fastest = std::min(fastest, a / steps_per_turn);
  }
  std::sort(ratios.begin(), ratios.end());
  return {ratios[ratios.size() / 2], ratios[ratios.size() / 4], ratios[ratios.size() * 3 / 4],
          fastest * 1e6};
}

// Number of turns, and a filter: scenes with a name that contains the text.
struct Plan {
  std::string filter;
  int turns = 60;

  bool has(const std::string& scene) const { return scene.find(filter) != std::string::npos; }
};

void print(const std::string& scene, const Cost& cost) {
  std::printf("%-56s %6.2f  (%.2f to %.2f)  stock %9.1f us\n", scene.c_str(), cost.ratio, cost.low,
              cost.high, cost.stock_micros);
  std::fflush(stdout);
}

constexpr double kStep = 1.0 / 240;

void comparePiles(double part, const Plan& plan) {
  const std::string scene =
      "pile of 512, " + std::to_string(static_cast<int>(100 * part)) + " % in fluid";
  if (!plan.has(scene)) return;
  Pile stock, ambient(part, {});
  for (Pile* pile : {&stock, &ambient}) {
    pile->keepAwake();
    for (int i = 0; i < 480; ++i) pile->step(kStep);
  }
  print(scene, compare([&] { stock.step(kStep); }, [&] { ambient.step(kStep); }, plan.turns, 4));
}

// Bodies in flight without contacts.
class Flock : WholeWorld<> {
 public:
  /// `def`: null, without fluid.
  Flock(const AttachDef* def, int count) {
    world.setGravity({0, 0, btScalar(-9.81)});
    if (def) fluid_.emplace(world);
    for (int i = 0; i < count; ++i) {
      btRigidBody& body =
          contents.add(1, btVector3(btScalar(0.1), btScalar(0.2), btScalar(0.3)), sphere_,
                       btTransform(btQuaternion::getIdentity(), {btScalar(10 * i), 0, 0}));
      body.setLinearVelocity({1, 2, 3});
      body.setAngularVelocity({2, btScalar(i % 7), -1});
      body.setActivationState(DISABLE_DEACTIVATION);
      if (def) fluid_->add(body, *def);
    }
  }
  Fluid& fluid() { return *fluid_; }
  void step() { contents.step(kStep); }

 private:
  btSphereShape sphere_{btScalar(0.3)};
  std::optional<Fluid> fluid_;
};

struct FlockPlan {
  FlowSettings flow;
  int elsewhere = 0;  ///< attached bodies outside of the world
};

void compareFlocks(const std::string& name, const FluidBody& shape, const Plan& plan,
                   const FlockPlan& flock = {}) {
  const std::string scene = "100 bodies in flight, " + name;
  if (!plan.has(scene)) return;
  constexpr int kCount = 100;
  AttachDef def;
  def.fluid_body = std::make_shared<FluidBody>(shape);
  def.medium = air();
  def.flow = flock.flow;
  Flock stock(nullptr, kCount), ambient(&def, kCount);
  btSphereShape sphere(btScalar(0.3));
  std::list<btRigidBody> elsewhere;
  for (int i = 0; i < flock.elsewhere; ++i)
    ambient.fluid().add(elsewhere.emplace_back(1, nullptr, &sphere, btVector3(1, 1, 1)), def);
  print(scene, compare([&] { stock.step(); }, [&] { ambient.step(); }, plan.turns, 20));
}

void comparePrecisions(const FluidBody& shape, const Plan& plan) {
  const std::string faces = std::to_string(shape.faces.size()) + " faces";
  FlowSettings flow;
  compareFlocks(faces + ", default", shape, plan, {flow});
  flow.precision = LoadPrecision::kDouble;
  compareFlocks(faces + ", double precision", shape, plan, {flow});
}

void run(const Plan& plan) {
  std::printf("Bullet in %s; ratio to stock: median (quartiles)\n",
              sizeof(btScalar) == 8 ? "float64" : "float32");
  for (const double part : {0.0, 0.1, 1.0}) comparePiles(part, plan);
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  compareFlocks("no faces", facelessEllipsoid(semi_axes), plan);
  compareFlocks("no faces, 10000 attached elsewhere", facelessEllipsoid(semi_axes), plan,
                {{}, 10000});
  for (const int level : {2, 3})
    compareFlocks(std::to_string(20 << (2 * level)) + " faces", meshedEllipsoid(semi_axes, level),
                  plan);
  comparePrecisions(latticeEllipsoid(semi_axes, 25, 11), plan);
  comparePrecisions(meshedEllipsoid(semi_axes, 4), plan);
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  if (argc > 3) {
    std::fprintf(stderr, "usage: %s [PART OF THE NAMES OF SCENES [TURNS]]\n", argv[0]);
    return 2;
  }
  ambient::test::Plan plan;
  if (argc > 1) plan.filter = argv[1];
  if (argc > 2) plan.turns = std::max(1, std::atoi(argv[2]));
  ambient::test::run(plan);
}
