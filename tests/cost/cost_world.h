#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/ambient.h"
#include "preprocess/collision_shape/fluid_body_cache.h"
#include "tests/support/world.h"

namespace ambient::test {

/// A world of stock Bullet that a fluid can fill.
class CostWorld : WorldParts<> {
 public:
  /// `has_robots`: the world takes multibodies.
  explicit CostWorld(bool has_robots = false);

  /// Adds a box, a ball, or a capsule, cylinder or cone along y; density [kg/m^3], 0: anything that
  /// cannot move.
  btRigidBody& add(std::shared_ptr<btCollisionShape> shape, double density,
                   const btTransform& start);
  /// Adds a body of given mass [kg] and moments of inertia [kg m^2].
  btRigidBody& addBody(std::shared_ptr<btCollisionShape> shape, double mass,
                       const btVector3& moments, const btTransform& start);
  void addJoint(std::unique_ptr<btTypedConstraint> joint) { contents_->join(std::move(joint)); }
  /// Adds a multibody of a base and so many links in a chain, all of one shape and density, on
  /// hinges that turn. @pre has_robots
  void addRobot(const std::shared_ptr<btCollisionShape>& shape, double density, int links,
                const btTransform& start);

  /// Fills the world with fluid.
  void immerse();
  void step() {
    if (each_step) each_step();
    contents_->step(duration);
  }

  double duration = 1.0 / 60;  ///< of a step [s]
  bool has_surface = false;    ///< the water ends at height 0
  bool has_loads = true;       ///< the fluid is not ideal
  /// Puts the bodies into the fluid; default: all of them into water.
  std::function<void(Fluid&, const std::vector<std::unique_ptr<btRigidBody>>&)> attach;
  std::function<void()> each_step;  ///< before each step; empty: nothing

 private:
  FluidBodyCache shapes_;
  btSequentialImpulseConstraintSolver solver_;
  btMultiBodyConstraintSolver robot_solver_;
  std::vector<std::shared_ptr<btCollisionShape>> collision_shapes_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::optional<WorldContents> contents_;
  std::optional<Fluid> fluid_;
};

/// A scene whose cost is of interest.
struct CostScene {
  std::string name;
  int bodies;   ///< when its time is taken
  int warm_up;  ///< steps before its time is taken
  std::function<void(CostWorld&, int bodies)> fill;
  bool has_robots = false;
  /// Fills the world whose time is taken beside, with a fluid; empty: the same bodies without.
  std::function<void(CostWorld&, int bodies)> fill_beside = {};
};

/// Equal bodies without contacts, under water and afloat.
std::vector<CostScene> freeScenes();
/// Bodies afloat whose shapes all have other ratios, by up to a third, beside equal ones: what is
/// longer is the way of their data from memory. Names end in the number of bodies.
std::vector<CostScene> differentScenes();
/// Equal barges afloat: closed, with a hold that is dry, and with water in it.
std::vector<CostScene> vesselScenes();
/// Boxes of 1300 faces under water, each of which gets a scaled() fluid body before every step.
std::vector<CostScene> scaledScenes();
/// Bodies in contacts and joints under water: a pile, and scenes in the manner of Bullet's
/// examples.
std::vector<CostScene> contactScenes();
/// Multibodies without contacts, under water and afloat: bases alone, pairs, robots of 11 boxes.
std::vector<CostScene> robotScenes();
/// Bodies in flight in air, without faces and with as many as their name says. `shapes`: folder of
/// makeFlockShapes().
std::vector<CostScene> flockScenes(const std::string& shapes);
/// Writes the fluid bodies of flockScenes() into a folder, which takes longer than their steps.
void makeFlockShapes(const std::string& folder);

}  // namespace ambient::test
