#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

class btDiscreteDynamicsWorld;
class CommonExampleInterface;
struct CommonExampleOptions;

AMBIENT_BEGIN

/// One of Bullet's own example programs.
struct BulletExample {
  const char* name;
  CommonExampleInterface* (*create)(CommonExampleOptions&);
  int option;  ///< which scene of the program
};

/// Examples of Bullet 3.24 that consist of rigid bodies, need neither file nor window, and leave
/// the solver as it is.
const std::vector<BulletExample>& bulletExamples();

/// An example that is run without a window. Two of them start alike, whatever they draw by chance.
class ExampleRun {
 public:
  /// @throws std::runtime_error if the example has made no world.
  explicit ExampleRun(const BulletExample& example);
  ~ExampleRun();
  ExampleRun(const ExampleRun&) = delete;
  ExampleRun& operator=(const ExampleRun&) = delete;

  btDiscreteDynamicsWorld& world() { return *world_; }
  /// One step of 1/60 s.
  void step();

 private:
  class Window;

  std::unique_ptr<Window> window_;
  std::unique_ptr<CommonExampleInterface> example_;
  btDiscreteDynamicsWorld* world_;
};

AMBIENT_END
