// Forces by hand in stock Bullet, as programs add them before each step: buoyancy, linear and
// quadratic drag with coefficients of handbooks, damping of the spin. At the surface each quarter
// of a box has the buoyancy of what of it is below.

#include <algorithm>
#include <string>

#include "tests/benchmark/rivals/bullet_world.h"

namespace ambient::rivals {
namespace {

/// Forces on one body: f = lift e_z - (linear + quadratic |v|) v, torque = -turning w.
struct Coefficients {
  btScalar lift;       ///< under water [N]
  btScalar linear;     ///< Stokes, 6 pi mu r [N s/m]
  btScalar quadratic;  ///< rho C_D A / 2 [N s^2/m^2]
  btScalar turning;    ///< [N m s]
};

/// Drag coefficient times area [m^2].
double dragArea(const Solid& solid) {
  const auto [a, b, c] = solid.size;
  switch (solid.form) {
    case Form::kBox:
      return 1.05 * 4 * (a * b + b * c + c * a) / 3;  // a cube; mean of the sides
    case Form::kCapsule:
      return 0.7 * (4 * a * b + kPi * a * a);  // a short cylinder, broadside
    case Form::kBall:
      return 0.47 * kPi * a * a;
    case Form::kEllipsoid:
      return 0.47 * kPi * std::max({a * b, b * c, c * a});
  }
  return 0;
}

Coefficients coefficientsOf(const Scene& scene) {
  const Solid& solid = scene.solid;
  const double displaced = kWaterDensity * volumeOf(solid);
  const double size = *std::max_element(solid.size.begin(), solid.size.end());
  const double drag = scene.is_ideal ? 0 : 1;
  return {btScalar(displaced * kGravity), btScalar(drag * 6 * kPi * kWaterViscosity * size),
          btScalar(drag * kWaterDensity / 2 * dragArea(solid)),
          btScalar(drag * 0.1 * displaced * size * size)};
}

class HandWorld : public BulletWorld {
 public:
  explicit HandWorld(const Scene& scene) : BulletWorld(scene), by_hand_(coefficientsOf(scene)) {}

  void step() override {
    for (const auto& body : bodies_) addForces(*body);
    BulletWorld::step();
  }

 private:
  void addForces(btRigidBody& body) const {
    const btScalar wet = scene_.has_surface ? addQuarters(body) : 1;
    if (!scene_.has_surface) body.applyCentralForce({0, 0, by_hand_.lift});
    const btVector3& v = body.getLinearVelocity();
    body.applyCentralForce(-wet * (by_hand_.linear + by_hand_.quadratic * v.length()) * v);
    body.applyTorque(-wet * by_hand_.turning * body.getAngularVelocity());
  }

  // Returns the part of the box that is under water.
  btScalar addQuarters(btRigidBody& body) const {
    const auto x = btScalar(scene_.solid.size[0] / 2), y = btScalar(scene_.solid.size[1] / 2),
               z = btScalar(scene_.solid.size[2]);
    const btMatrix3x3& turn = body.getWorldTransform().getBasis();
    const btScalar height = body.getWorldTransform().getOrigin().z();
    btScalar wet = 0;
    for (const btScalar i : {btScalar(-1), btScalar(1)}) {
      for (const btScalar j : {btScalar(-1), btScalar(1)}) {
        const btVector3 arm = turn * btVector3(i * x, j * y, 0);
        const btScalar part =
            std::clamp((z - height - arm.z()) / (2 * z), btScalar(0), btScalar(1));
        body.applyForce({0, 0, part * by_hand_.lift / 4}, arm);
        wet += part / 4;
      }
    }
    return wet;
  }

  const Coefficients by_hand_;
};

std::unique_ptr<World> makeHandWorld(const Scene& scene, bool has_fluid) {
  if (has_fluid) return std::make_unique<HandWorld>(scene);
  return std::make_unique<BulletWorld>(scene);
}

}  // namespace

Engine handEngine() {
  const int version = btGetVersion();
  return {"forces by hand",
          "Bullet " + std::to_string(version / 100) + "." + std::to_string(version % 100),
          "drag coefficients of handbooks typed in", makeHandWorld};
}

}  // namespace ambient::rivals
