#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_solver.h"
#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/motion/rigid_state.h"
#include "tests/golden/golden_record.h"

class btMultiBody;
class btMultiBodyLinkCollider;

namespace ambient::test {

inline btScalar bt(double value) { return static_cast<btScalar>(value); }

/// A body of a golden world. The twist is in world axes.
struct GoldenBody {
  Vector3 position = Vector3::Zero();
  Twist twist{};
  double mass = 1;  ///< [kg]; 0: static
  Vector3 moments{0.02, 0.03, 0.04};
  btCollisionShape* shape = nullptr;  ///< null: meets nothing
};

/// A world with bodies in fluids, built by what a program would use, and the trace of its run.
class GoldenWorld {
 public:
  static constexpr double kStep = 1.0 / 240;
  enum class Kind { kRigidBodies, kMultiBodies };

  explicit GoldenWorld(Kind kind = Kind::kRigidBodies);
  ~GoldenWorld();
  GoldenWorld(const GoldenWorld&) = delete;
  GoldenWorld& operator=(const GoldenWorld&) = delete;

  btRigidBody& addDry(const GoldenBody& def);
  btRigidBody& add(const GoldenBody& def, const AttachDef& attach);
  btTypedConstraint& addJoint(btTypedConstraint* joint);
  /// A chain of two links that hangs from a fixed base. @pre Kind::kMultiBodies.
  void addChain(const Vector3& top);

  btDiscreteDynamicsWorld& world() { return *world_; }
  AmbientRegistry& registry() { return registry_; }
  btRigidBody& body(int index) { return *bodies_[index]; }
  btCollisionShape& box() { return box_; }
  btCollisionShape& ball() { return ball_; }
  btCollisionShape& floor() { return floor_; }

  /// `before` is called with the number of each step. Its sample: place and velocity of the first
  /// body at the end.
  GoldenRecord run(
      int steps, const std::function<void(int)>& before = [](int) {});

 private:
  void traceStep();

  AmbientRegistry registry_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  AmbientAction action_{registry_};
  btEmptyShape no_shape_;
  btBoxShape box_{btVector3(bt(0.3), bt(0.2), bt(0.1))};
  btSphereShape ball_{bt(0.2)};
  btStaticPlaneShape floor_{btVector3(0, 0, 1), 0};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::unique_ptr<btMultiBody> chain_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> links_;
  GoldenTrace trace_;
};

// The worlds of the files beside this one.
std::vector<GoldenRun> goldenFlights();
std::vector<GoldenRun> goldenContacts();
std::vector<GoldenRun> goldenJoints();

/// The box of a golden world in water, three planes of symmetry; 320 faces.
AttachDef symmetricInWater();
/// A bumpy body whose added mass couples all motions, its frame turned and beside the centre of
/// mass; 320 faces.
AttachDef bumpyInWater();

}  // namespace ambient::test
