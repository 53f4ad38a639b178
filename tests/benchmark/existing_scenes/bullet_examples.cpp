#include "tests/benchmark/existing_scenes/bullet_examples.h"

#include <btBulletDynamicsCommon.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

// Headers of the checkout of Bullet.
#include "BasicDemo/BasicExample.h"
#include "Benchmarks/BenchmarkDemo.h"
#include "CommonInterfaces/CommonExampleInterface.h"
#include "CommonInterfaces/CommonGUIHelperInterface.h"
#include "CommonInterfaces/CommonParameterInterface.h"
#include "Constraints/ConstraintDemo.h"
#include "DynamicControlDemo/MotorDemo.h"
#include "ExtendedTutorials/Bridge.h"
#include "ExtendedTutorials/Chain.h"
#include "ExtendedTutorials/CompoundBoxes.h"
#include "ExtendedTutorials/InclinedPlane.h"
#include "ExtendedTutorials/MultiPendulum.h"
#include "ExtendedTutorials/MultipleBoxes.h"
#include "ExtendedTutorials/NewtonsCradle.h"
#include "ExtendedTutorials/SimpleBox.h"
#include "ExtendedTutorials/SimpleJoint.h"
#include "GyroscopicDemo/GyroscopicSetup.h"
#include "RigidBody/RigidBodySoftContact.h"
#include "RollingFrictionDemo/RollingFrictionDemo.h"
#include "Vehicles/Hinge2Vehicle.h"

AMBIENT_BEGIN

const std::vector<BulletExample>& bulletExamples() {
  static const std::vector<BulletExample> examples = {
      {"Basic example", BasicExampleCreateFunc, 0},
      {"Benchmark 1: 3000 boxes", BenchmarkCreateFunc, 1},
      {"Benchmark 2: 1000 stack", BenchmarkCreateFunc, 2},
      {"Benchmark 3: ragdolls", BenchmarkCreateFunc, 3},
      {"Benchmark 4: convex stack", BenchmarkCreateFunc, 4},
      {"Benchmark 5: primitives on a mesh", BenchmarkCreateFunc, 5},
      {"Benchmark 6: hulls on a mesh", BenchmarkCreateFunc, 6},
      {"Rolling friction", RollingFrictionCreateFunc, 0},
      {"All constraints", AllConstraintCreateFunc, 0},
      {"Motor control", MotorControlCreateFunc, 0},
      {"Gyroscopic", GyroscopicCreateFunc, 0},
      {"Soft contact", RigidBodySoftContactCreateFunc, 0},
      {"Hinge2 vehicle", Hinge2VehicleCreateFunc, 0},
      {"Tutorial: box", ET_SimpleBoxCreateFunc, 0},
      {"Tutorial: boxes", ET_MultipleBoxesCreateFunc, 0},
      {"Tutorial: compound boxes", ET_CompoundBoxesCreateFunc, 0},
      {"Tutorial: joint", ET_SimpleJointCreateFunc, 0},
      {"Tutorial: bridge", ET_BridgeCreateFunc, 0},
      {"Tutorial: chain", ET_ChainCreateFunc, 0},
      {"Tutorial: inclined plane", ET_InclinedPlaneCreateFunc, 0},
      {"Tutorial: pendulums", ET_MultiPendulumCreateFunc, 0},
      {"Tutorial: Newton's cradle", ET_NewtonsCradleCreateFunc, 0},
  };
  return examples;
}

// Every example shows its world to the window when it has built it.
class ExampleRun::Window : public DummyGUIHelper {
 public:
  void autogenerateGraphicsObjects(btDiscreteDynamicsWorld* world) override { shown = world; }
  CommonParameterInterface* getParameterInterface() override { return &parameters_; }

  btDiscreteDynamicsWorld* shown = nullptr;

 private:
  // Sliders and buttons that nobody moves.
  class NoParameters : public CommonParameterInterface {
   public:
    void registerSliderFloatParameter(SliderParams&) override {}
    void registerButtonParameter(ButtonParams&) override {}
    void registerComboBox(ComboBoxParams&) override {}
    void syncParameters() override {}
    void removeAllParameters() override {}
    void setSliderValue(int, double) override {}
  };

  NoParameters parameters_;
};

ExampleRun::ExampleRun(const BulletExample& example) : window_(std::make_unique<Window>()) {
  std::srand(1);
  CommonExampleOptions options(window_.get(), example.option);
  example_.reset(example.create(options));
  example_->initPhysics();
  world_ = window_->shown;
  if (!world_) throw std::runtime_error(std::string(example.name) + ": shows no world");
}

ExampleRun::~ExampleRun() { example_->exitPhysics(); }

void ExampleRun::step() { example_->stepSimulation(1.f / 60); }

AMBIENT_END
