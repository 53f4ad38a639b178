#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "tests/support/world.h"

namespace ambient::test {

/// Added mass and buoyancy of the boxes of a pile.
struct PileFluid {
  double added_mass = 0.5;  ///< largest added mass over the mass of a box
  double buoyancy = 0;      ///< displaced mass over the mass of a box
};

/// Initial arrangement of a pile.
struct PileDef {
  int edge = 8;         ///< boxes along each edge of the cube
  double tilt = 0.002;  ///< root mean square of the boxes' angles about each axis [rad]
  double height = 0;    ///< gap between floor and lowest boxes [m]
  double gap = 0;       ///< gap between neighbours [m]
  unsigned seed = 1;
};

/// A cube of equal boxes, slightly apart and turned, dropped onto a plane between four walls. All
/// solvers get the same boxes; restitution 0.
class Pile {
 public:
  static constexpr double kHalfEdge = 0.1;  ///< box [m]
  static constexpr double kMass = 1;        ///< box [kg]

  /// A pile without fluid.
  explicit Pile(const PileDef& def = {});
  /// Takes part of the boxes, spread over the pile, into a fluid. A part of 0 leaves the fluid
  /// empty.
  Pile(double ambient_part, PileFluid fluid, const PileDef& def = {});

  btDiscreteDynamicsWorld& world() { return host_.world; }
  const std::vector<std::unique_ptr<btRigidBody>>& boxes() const { return boxes_.bodies(); }
  void step(double duration) { host_.step(duration); }
  void keepAwake();
  bool isAsleep() const;
  /// Of boxes and fluid, kinetic and potential [J].
  double energy() const;

 private:
  void addWalls(int edge);
  void addBoxes(const PileDef& def);
  btRigidBody& add(WorldContents& group, double mass, btCollisionShape& shape,
                   const btTransform& start);

  std::vector<std::unique_ptr<btCollisionShape>> wall_shapes_;
  btBoxShape box_shape_;
  WholeWorld<> host_;  // its contents: walls
  WorldContents boxes_{host_.world};
  PileFluid fluid_def_;
  std::optional<Fluid> fluid_;
};

/// Added mass for a box, coupling rotation and translation; no faces.
FluidBody pileFluidBody(PileFluid fluid);

}  // namespace ambient::test
