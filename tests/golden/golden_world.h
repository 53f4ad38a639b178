#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "tests/golden/golden_record.h"
#include "tests/support/world.h"

namespace ambient::test {

inline btScalar bt(double value) { return static_cast<btScalar>(value); }

/// A body of a golden world. The twist is in world axes.
struct GoldenBody {
  Vector3 position = Vector3::Zero();
  Twist twist{};
  double mass = 1;  ///< 0: static [kg]
  Vector3 moments{0.02, 0.03, 0.04};
  btCollisionShape* shape = nullptr;  ///< null: no contacts
};

/// A world with bodies in fluids, set up like a user's program, and the trace of its run.
class GoldenWorld {
 public:
  static constexpr double kStep = 1.0 / 240;
  enum class Kind { kRigidBodies, kMultiBodies };

  explicit GoldenWorld(Kind kind = Kind::kRigidBodies);

  btRigidBody& addDry(const GoldenBody& def);
  btRigidBody& add(const GoldenBody& def, const AttachDef& attach);
  btTypedConstraint& addJoint(btTypedConstraint* joint);
  /// A chain of two links that hangs from a fixed base. @pre Kind::kMultiBodies.
  void addChain(const Vector3& top);

  btDiscreteDynamicsWorld& world() { return *world_; }
  Fluid& fluid() { return *fluid_; }
  btRigidBody& body(int index) { return *contents_->bodies()[index]; }
  btCollisionShape& box() { return box_; }
  btCollisionShape& ball() { return ball_; }
  btCollisionShape& floor() { return floor_; }

  /// Calls `before` with the number of each step. The record's sample is position and velocity of
  /// the first body at the end.
  GoldenRecord run(
      int steps, const std::function<void(int)>& before = [](int) {});

 private:
  void traceStep();

  WorldParts<> parts_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  btEmptyShape no_shape_;
  btBoxShape box_{btVector3(bt(0.3), bt(0.2), bt(0.1))};
  btSphereShape ball_{bt(0.2)};
  btStaticPlaneShape floor_{btVector3(0, 0, 1), 0};
  std::optional<WorldContents> contents_;
  std::optional<Fluid> fluid_;
  btMultiBody* chain_ = nullptr;
  GoldenTrace trace_;
};

// Runs of the files beside this header.
std::vector<GoldenRun> goldenFlights();
std::vector<GoldenRun> goldenContacts();
std::vector<GoldenRun> goldenJoints();

/// Box of a golden world in water, three planes of symmetry; 320 faces.
AttachDef symmetricInWater();
/// Bumpy body with all motions coupled by the added mass. Its fluid frame is turned and off the
/// centre of mass; 320 faces.
AttachDef bumpyInWater();

}  // namespace ambient::test
