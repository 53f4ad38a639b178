#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/solver/fluid_solver.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/saved_state.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/world.h"

namespace ambient::test {

/// A body of the scene, and what the fluid must think of it.
struct FuzzBody {
  std::unique_ptr<btRigidBody> body;
  btScalar mass = 1;
  bool is_in_world = true;
  bool is_attached = false;
};

/// A world with random events, all of them allowed between two steps. All functions throw
/// std::logic_error with one sentence if a check fails.
class FuzzScene {
 public:
  explicit FuzzScene(unsigned seed);
  ~FuzzScene();
  FuzzScene(const FuzzScene&) = delete;
  FuzzScene& operator=(const FuzzScene&) = delete;

  /// Plays one random event, then some steps, each checked.
  void play();
  long long steps() const { return steps_; }

 private:
  using Event = void (FuzzScene::*)();

  // fuzz_scene.cpp
  int below(int count);
  bool chance(double probability) { return arbitrary_.between(0, 1) < probability; }
  btVector3 vector(double size) { return toBullet(arbitrary_.vector(size)); }
  FuzzBody* anyBody();
  void step(int count);
  void check();

  // body_fuzz.cpp
  Medium anyMedium();
  AttachDef anyDef();
  void addBody();
  void destroyBody();
  void moveBetweenWorldAndShelf();
  void attach();
  void attachWrongly();
  void detach();
  void changeMedium();
  void changeShape();
  void changeMass();
  void push();
  void changeFactors();
  void changeFlags();
  void changeSleep();

  // joint_fuzz.cpp
  void addJoint();
  void removeJoint();
  void removeJointsOf(const btRigidBody& body);
  void saveAndRestore();
  void damageBytes();
  void draw();
  std::string motion() const;
  std::vector<int> overlappingPairs() const;
  std::shared_ptr<const FluidBody> findShape(const std::string& name) const;

  Arbitrary arbitrary_;
  long long steps_ = 0;
  std::size_t allocations_ = 0;  // within steps, without Bullet's
  std::string complaint_;
  // True: restored worlds must repeat to the bit. Excludes what a saved state cannot restore:
  // sleeping bodies and shuffled rows, as both depend on margins of older boxes, and compound
  // shapes.
  bool is_repeatable_ = false;

  std::vector<std::shared_ptr<const FluidBody>> fluid_bodies_;
  int scaled_count_ = 0;  ///< fluid bodies made by scaling; makes names unique
  btBoxShape floor_shape_{btVector3(30, 30, 1)};
  btBoxShape box_{btVector3(btScalar(0.4), btScalar(0.3), btScalar(0.2))};
  btSphereShape ball_{btScalar(0.3)};
  btCapsuleShape capsule_{btScalar(0.2), btScalar(0.5)};
  btCompoundShape pair_of_balls_;

  // Sequential impulses: the only stock solver that is stable whatever is joined to what.
  WholeWorld<> host_;
  btDiscreteDynamicsWorld& world_ = host_.world;
  Fluid fluid_{world_};
  btRigidBody* floor_ = nullptr;
  std::vector<FuzzBody> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace ambient::test
