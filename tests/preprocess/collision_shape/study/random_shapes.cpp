#include "tests/preprocess/collision_shape/study/random_shapes.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/conversions.h"

namespace ambient {

template <class Shape>
Shape& RandomShapes::keep(std::unique_ptr<Shape> shape) {
  Shape& kept = *shape;
  shapes_.push_back(std::move(shape));
  return kept;
}

double RandomShapes::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
}

double RandomShapes::length(double low, double high, bool on_grid) {
  const double value = uniform(low, high);
  return on_grid ? std::ceil(4 * value) / 4 : value;
}

btConvexHullShape& RandomShapes::hull() {
  auto hull = std::make_unique<btConvexHullShape>();
  const Vector3 stretch(1, uniform(0.3, 1), uniform(0.15, 1));
  const int count = 6 + static_cast<int>(random_() % 25);
  for (int i = 0; i < count; ++i) {
    const Vector3 point(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    hull->addPoint(toBullet(Vector3(stretch.cwiseProduct(point))));
  }
  hull->setMargin(0);
  return keep(std::move(hull));
}

const btCompoundShape& RandomShapes::mixedCompound(bool on_grid) {
  auto compound = std::make_unique<btCompoundShape>();
  const int count = 2 + static_cast<int>(random_() % 4);
  for (int i = 0; i < count; ++i) {
    const double angle = on_grid ? kPi / 2 * static_cast<double>(random_() % 4) : uniform(0, 3);
    const btQuaternion turn(btVector3(0, 0, 1), static_cast<btScalar>(angle));
    const Vector3 place(length(-1, 0.75, on_grid), length(-1, 0.75, on_grid),
                        length(-1, 0.75, on_grid));
    const bool is_hull = random_() % 5 == 0;
    btCollisionShape* child = is_hull ? &hull() : primitive(on_grid);
    compound->addChildShape(btTransform(turn, toBullet(place)), child);
  }
  return keep(std::move(compound));
}

btCollisionShape* RandomShapes::primitive(bool on_grid) {
  const auto size = [&] { return static_cast<btScalar>(length(0.2, 0.8, on_grid)); };
  const btVector3 half(size(), size(), size());
  switch (random_() % 4) {
    case 0:
      return &keep(std::make_unique<btSphereShape>(half.x()));
    case 1:
      return &keep(std::make_unique<btCylinderShape>(btVector3(half.x(), half.y(), half.x())));
    case 2:
      return &keep(std::make_unique<btCapsuleShape>(half.x(), half.y()));
    default:
      return &keep(std::make_unique<btBoxShape>(half));
  }
}

}  // namespace ambient
