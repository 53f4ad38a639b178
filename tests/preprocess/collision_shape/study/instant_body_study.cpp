// What Quality::kInstant costs and how far it is off, over 200 random shapes: instant_body_study
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <random>
#include <vector>

#include "bullet_ambient/bullet/conversions.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/pi.h"
#include "preprocess/collision_shape/collision_shape_body.h"

namespace ambient {
namespace {

/// Random shapes of one seed, which it owns.
class ShapeMaker {
 public:
  explicit ShapeMaker(unsigned seed) : random_(seed) {}

  const btCollisionShape& hull() {
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

  const btCollisionShape& compound() {
    auto compound = std::make_unique<btCompoundShape>();
    const int count = 2 + static_cast<int>(random_() % 4);
    for (int i = 0; i < count; ++i) {
      const btQuaternion turn(btVector3(0, 0, 1), static_cast<btScalar>(uniform(0, 3)));
      const Vector3 place(uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(-0.8, 0.8));
      compound->addChildShape(btTransform(turn, toBullet(place)), primitive());
    }
    return keep(std::move(compound));
  }

  /// A prism over a star, a mesh that is not convex.
  const btCollisionShape& prism() {
    auto mesh = std::make_unique<btTriangleMesh>();
    const int count = 6 + static_cast<int>(random_() % 10);
    const double height = uniform(0.1, 1.5);
    std::vector<Vector3> rim;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * kPi * i / count, radius = uniform(0.4, 1);
      rim.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height / 2);
    }
    const auto add = [&](const Vector3& a, const Vector3& b, const Vector3& c) {
      mesh->addTriangle(toBullet(a), toBullet(b), toBullet(c));
    };
    const Vector3 up(0, 0, height), middle = up / 2;
    for (int i = 0; i < count; ++i) {
      const Vector3 a = rim[static_cast<std::size_t>(i)];
      const Vector3 b = rim[static_cast<std::size_t>((i + 1) % count)];
      add(a, b, middle);
      add(b - up, a - up, middle - up);
      add(a - up, b - up, b);
      add(a - up, b, a);
    }
    auto shape = std::make_unique<btGImpactMeshShape>(mesh.get());
    shape->setMargin(0);
    shape->updateBound();
    meshes_.push_back(std::move(mesh));
    return keep(std::move(shape));
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  btCollisionShape* primitive() {
    const auto size = [&] { return static_cast<btScalar>(uniform(0.2, 0.8)); };
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
  btCollisionShape& keep(std::unique_ptr<btCollisionShape> shape) {
    shapes_.push_back(std::move(shape));
    return *shapes_.back();
  }

  std::mt19937 random_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
};

double errorOf(const Matrix3& block, const Matrix3& reference) {
  return (block - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

/// Of one kind of shapes.
struct Results {
  std::vector<double> milliseconds, translation, rotation;

  void add(const btCollisionShape& shape) {
    CollisionShapeSettings settings;
    settings.report = nullptr;
    settings.faces = kInstantFaces;
    settings.flow.max_panels = 0;  // some per cent off, where the guess is tens
    const FluidBody solved = makeFluidBody(shape, settings);
    settings.quality = Quality::kInstant;
    const auto start = std::chrono::steady_clock::now();
    const FluidBody guess = makeFluidBody(shape, settings);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    const Matrix6 K = shiftOrigin(guess.added_mass, solved.centre_of_volume);
    const Matrix6 reference = shiftOrigin(solved.added_mass, solved.centre_of_volume);
    milliseconds.push_back(time.count());
    rotation.push_back(errorOf(K.topLeftCorner<3, 3>(), reference.topLeftCorner<3, 3>()));
    translation.push_back(
        errorOf(K.bottomRightCorner<3, 3>(), reference.bottomRightCorner<3, 3>()));
  }

  static double share(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
  void print(const char* kind) const {
    std::printf("| %s | %zu | %.1f | %.1f | %.0f | %.0f | %.0f | %.0f |\n", kind,
                translation.size(), share(milliseconds, 0.5), share(milliseconds, 0.9),
                100 * share(translation, 0.5), 100 * share(translation, 0.9),
                100 * share(rotation, 0.5), 100 * share(rotation, 0.9));
    std::fflush(stdout);
  }
};

void run() {
  std::printf(
      "| shapes | number | time [ms] | 90 %% | translation off by [%%] | 90 %% | rotation off by "
      "[%%] | "
      "90 %% |\n|---|---|---|---|---|---|---|---|\n");
  Results hulls, compounds, meshes;
  for (unsigned seed = 0; seed < 80; ++seed) hulls.add(ShapeMaker(seed).hull());
  hulls.print("convex hulls of 6 to 30 points");
  for (unsigned seed = 0; seed < 80; ++seed) compounds.add(ShapeMaker(seed).compound());
  compounds.print("compounds of 2 to 5");
  for (unsigned seed = 0; seed < 40; ++seed) meshes.add(ShapeMaker(seed).prism());
  meshes.print("prisms over stars, as meshes");
}

}  // namespace
}  // namespace ambient

int main() try {
  ambient::run();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "instant_body_study: %s\n", error.what());
  return 1;
}
