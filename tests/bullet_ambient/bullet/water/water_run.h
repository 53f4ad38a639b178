#pragma once

#include <btBulletCollisionCommon.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {

/// Shapes of bodies that float.
enum class WaterShape {
  kBall,
  kBox,    ///< 1 : 0.7 : 0.45
  kHull,   ///< convex, 14 points
  kAngle,  ///< two bars, one across an end of the other: not convex
  kCube,
};
constexpr int kWaterShapes = 5;

/// Collision shape and fluid body of one body. B has the centre and principal axes of a uniform
/// mass.
struct SizedShape {
  std::unique_ptr<btCompoundShape> collision;
  std::unique_ptr<btCollisionShape> parts[2];  ///< children of a compound
  std::shared_ptr<const FluidBody> fluid_body;
  FrameOffset fluid_frame;   ///< F in B
  Vector3 moments{0, 0, 0};  ///< moments of a uniform mass of 1 kg [m^2]
};

/// Makes a shape with longest side or diameter about `size` [m]. Cost: some tenths of a second for
/// the first one of a shape.
SizedShape makeWaterShape(WaterShape shape, double size);

/// Radius of a sphere about the centre of mass around any shape of size 1 m.
constexpr double kWaterShapeRadius = 0.87;

struct WaterBodyDef {
  WaterShape shape = WaterShape::kBox;
  double size = 1;              ///< [m]
  double specific_gravity = 1;  ///< body's density over water's
  RigidState start{};           ///< twist in world axes
  PressureLaw law = PressureLaw::kForm;
  double separation_angle = 1.5707963267948966;  ///< [rad]
  int max_substeps = 0;                          ///< FlightSettings::max_substeps
};

/// Fluid around the bodies of a run.
enum class Around {
  kWater,   ///< water below air, level 0
  kVacuum,  ///< stock Bullet
};

/// Uniform bodies in a world with gravity along -z.
class WaterRun {
 public:
  explicit WaterRun(Around around);
  /// Makes water with waves.
  explicit WaterRun(std::shared_ptr<const WaterSurface> surface);

  btRigidBody& add(const WaterBodyDef& def);
  /// Adds a plane that holds bodies on the side of its normal.
  void addPlane(const Vector3& normal, double height);
  /// Adds and owns a joint; joined bodies do not collide.
  void join(std::unique_ptr<btTypedConstraint> joint) { fluid_.contents.join(std::move(joint)); }
  void step(double duration) { fluid_.step(duration); }

  /// Tells if all bodies are below five times their size.
  bool isDeep() const;
  /// Energy of bodies, still water and waves made by the bodies, docs/theory.md eq. (64) [J]. In a
  /// vacuum: energy of bodies alone.
  double energy() const;
  /// Sum of (m + rho V) g L over all bodies; in a vacuum m g L [J].
  double energyScale() const { return energy_scale_; }
  AmbientCounters counters() const { return fluid_.fluid.counters(); }
  const std::vector<std::string>& said() const { return fluid_.said; }

 private:
  struct FloatingBody {
    SizedShape shape;
    double size, mass;
    btRigidBody* body;
  };
  void attach(const FloatingBody& floating, const WaterBodyDef& def);
  double energyOf(const FloatingBody& floating) const;

  Around around_;
  std::deque<FloatingBody> bodies_;
  std::deque<btStaticPlaneShape> planes_;
  FluidWorld fluid_;
  double energy_scale_ = 0;
};

}  // namespace ambient::test
