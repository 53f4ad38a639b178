#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "bullet_ambient/bullet/ambient_action.h"
#include "bullet_ambient/bullet/ambient_solver.h"

namespace ambient::test {

/// The fluid that the boxes of a pile are in.
struct PileFluid {
  double added_mass = 0.5;  ///< largest added mass over the mass of a box
  double buoyancy = 0;      ///< displaced mass over the mass of a box
};

/// How a pile starts.
struct PileDef {
  int edge = 8;         ///< boxes along each edge of the cube
  double tilt = 0.002;  ///< root mean square of the boxes' angles about each axis [rad]
  double height = 0;    ///< of the lowest box above the floor [m]
  double gap = 0;       ///< between neighbours [m]
  unsigned seed = 1;
};

/// A cube of equal boxes, slightly apart and turned, dropped onto a plane between four walls. The
/// same boxes for every solver; restitution 0.
class Pile {
 public:
  static constexpr double kHalfEdge = 0.1;  ///< of a box [m]
  static constexpr double kMass = 1;        ///< of a box [kg]

  /// Takes part of the boxes, spread over the pile, into a fluid. A part of 0 leaves the registry
  /// empty.
  Pile(btConstraintSolver& solver, AmbientRegistry* registry, double ambient_part, PileFluid fluid,
       PileDef def = {});
  ~Pile();
  Pile(const Pile&) = delete;
  Pile& operator=(const Pile&) = delete;

  btDiscreteDynamicsWorld& world() { return world_; }
  const std::vector<std::unique_ptr<btRigidBody>>& boxes() const { return boxes_; }
  void step(double duration);
  void keepAwake();
  bool isAsleep() const;
  /// Of boxes and fluid, kinetic and potential [J].
  double energy(const AmbientRegistry* registry, PileFluid fluid) const;
  /// Root mean square over all boxes [m/s].
  double meanSpeed() const;

 private:
  void addWalls(int edge);
  void addBoxes(const PileDef& def);
  btRigidBody& add(double mass, btCollisionShape& shape, const btTransform& start);

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDiscreteDynamicsWorld world_;
  std::unique_ptr<AmbientAction> action_;
  std::vector<std::unique_ptr<btCollisionShape>> wall_shapes_;
  btBoxShape box_shape_;
  std::vector<std::unique_ptr<btRigidBody>> walls_, boxes_;
};

/// Added mass of a box's size that couples rotation and translation, no faces.
FluidBody pileFluidBody(PileFluid fluid);

}  // namespace ambient::test
