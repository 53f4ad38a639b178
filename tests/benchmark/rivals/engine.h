#pragma once

// What a scene is and what an engine does with it. Needs the C++ library alone: each engine's
// source is compiled with the flags of that engine.

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ambient::rivals {

using Triple = std::array<double, 3>;

enum class Form { kBox, kCapsule, kBall, kEllipsoid };

/// Homogeneous body. Sizes [m]: half extents of a box, semi-axes of an ellipsoid; radius and half
/// of the straight length of a capsule; radius of a ball; the rest is 0.
struct Solid {
  Form form = Form::kBox;
  Triple size{};
  double density = 0;  ///< [kg/m^3]
};

/// Pose and velocity of a body, in the world; the rotation is a unit quaternion w, x, y, z.
struct Motion {
  Triple position{};
  std::array<double, 4> rotation{1, 0, 0, 0};
  Triple velocity{};  ///< of the centre [m/s]
  Triple spin{};      ///< [rad/s]
};

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.81;             ///< along -z [m/s^2]
constexpr double kWaterDensity = 998;         ///< [kg/m^3]
constexpr double kWaterViscosity = 1.002e-3;  ///< [Pa s]

/// Equal bodies in water.
struct Scene {
  Solid solid;
  std::vector<Motion> starts;
  double step = 1.0 / 60;           ///< [s]
  double gravity = kGravity;        ///< along -z [m/s^2]
  bool has_surface = false;         ///< water below z = 0 only
  bool is_ideal = false;            ///< water without drag and friction
  std::optional<double> room = {};  ///< floor at z = 0, walls at this distance from the z axis [m]
};

class World {
 public:
  virtual ~World() = default;
  virtual void step() = 0;
  virtual Motion motion(std::size_t body) const = 0;
};

struct Engine {
  std::string name, version;
  std::string settings;  ///< what was chosen, in a few words
  /// The scene's world, without fluid or with it; null: the engine has no such fluid.
  std::function<std::unique_ptr<World>(const Scene&, bool has_fluid)> make;
};

Engine ambientEngine();
Engine handEngine();
Engine joltEngine();
Engine mujocoEngine();

/// Volume [m^3].
double volumeOf(const Solid& solid);
/// Moments of inertia of an ellipsoid about its axes [kg m^2].
Triple ellipsoidMoments(const Solid& ellipsoid);

}  // namespace ambient::rivals
