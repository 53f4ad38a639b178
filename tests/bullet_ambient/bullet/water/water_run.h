#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/water/water_shapes.h"

namespace ambient::test {

constexpr double kRunGravity = 9.81;  // [m/s^2]

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
  const std::vector<std::string>& said() const { return said_; }

 private:
  struct FloatingBody {
    SizedShape shape;
    double size, mass;
    btRigidBody* body;
  };
  void fill(std::shared_ptr<const WaterSurface> surface);
  void attach(const FloatingBody& floating, const WaterBodyDef& def);
  double energyOf(const FloatingBody& floating) const;

  Around around_;
  std::deque<FloatingBody> bodies_;
  std::deque<btStaticPlaneShape> planes_;
  FluidWorld fluid_;
  double energy_scale_ = 0;
  std::vector<std::string> said_;
};

}  // namespace ambient::test
