// Accuracy of united compounds: random ones, and comparison with other constructions of equal
// bodies: compound_study
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "tests/preprocess/collision_shape/study/random_shapes.h"

namespace ambient {
namespace {

CollisionShapeSettings unitedOnly() {
  CollisionShapeSettings settings;
  settings.fallback = CompoundFallback::kRefuse;
  settings.load_error = 0;
  settings.tables = false;
  settings.report = nullptr;
  return settings;
}

/// Few faces, on which the flow takes little time.
CollisionShapeSettings coarselyUnited() {
  CollisionShapeSettings settings = unitedOnly();
  settings.faces = 400;
  settings.flow.max_panels = 0;
  return settings;
}

/// A convex polyhedron: the intersection of half spaces n . x <= d of its triangles.
struct ConvexChild {
  std::vector<Vector3> normals;
  std::vector<double> distances;

  bool contains(const Vector3& x) const {
    for (std::size_t i = 0; i < normals.size(); ++i)
      if (normals[i].dot(x) > distances[i]) return false;
    return true;
  }
};

std::vector<ConvexChild> childrenOf(const btCompoundShape& compound) {
  const CollisionShapeSettings settings = coarselyUnited();
  std::vector<ConvexChild> children;
  for (int i = 0; i < compound.getNumChildShapes(); ++i) {
    const FluidBody body = makeFluidBody(*compound.getChildShape(i), settings);
    const btTransform& place = compound.getChildTransform(i);
    ConvexChild child;
    for (std::size_t f = 0; f < body.faces.size(); ++f) {
      const btVector3 normal = place.getBasis() * toBullet(Vector3(body.faces.normal(f)));
      const btVector3 point = place * toBullet(Vector3(body.faces.centroid(f)));
      child.normals.emplace_back(normal.x(), normal.y(), normal.z());
      child.distances.push_back(normal.dot(point));
    }
    children.push_back(std::move(child));
  }
  return children;
}

/// Volume of the union of convex children, by cells of a lattice.
double latticeVolume(const btCompoundShape& compound) {
  constexpr int kCells = 60;
  const std::vector<ConvexChild> children = childrenOf(compound);
  btVector3 low, high;
  compound.getAabb(btTransform::getIdentity(), low, high);
  const btVector3 cell = (high - low) / kCells;
  int inside = 0;
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const Vector3 place(i % kCells + 0.5, i / kCells % kCells + 0.5, i / (kCells * kCells) + 0.5);
    const Vector3 x(low.x() + cell.x() * place.x(), low.y() + cell.y() * place.y(),
                    low.z() + cell.z() * place.z());
    inside += std::any_of(children.begin(), children.end(),
                          [&](const ConvexChild& child) { return child.contains(x); })
                  ? 1
                  : 0;
  }
  return inside * cell.x() * cell.y() * cell.z();
}

void studyRandomCompounds() {
  constexpr unsigned kCompounds = 300;
  const CollisionShapeSettings settings = coarselyUnited();
  int united = 0;
  double largest = 0;
  for (unsigned seed = 0; seed < kCompounds; ++seed) {
    RandomShapes shapes(seed);
    const btCompoundShape& compound = shapes.mixedCompound(seed % 2 == 0);
    try {
      const double volume = makeFluidBody(compound, settings).volume;
      ++united;
      largest = std::max(largest, std::abs(volume / latticeVolume(compound) - 1));
    } catch (const std::exception& error) {
      std::printf("%u: %s\n", seed, error.what());
    }
  }
  std::printf("%d of %u compounds united, volume at most %.1f %% from that of a lattice\n\n",
              united, kCompounds, 100 * largest);
}

double errorOf(const Matrix3& block, const Matrix3& reference) {
  return (block - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
}

Matrix6 aboutCentre(const FluidBody& body) {
  return shiftOrigin(body.added_mass, body.centre_of_volume);
}

void compare(const char* name, const btCompoundShape& compound, const btCollisionShape& shape) {
  const Matrix6 K = aboutCentre(makeFluidBody(compound, unitedOnly()));
  const Matrix6 reference = aboutCentre(makeFluidBody(shape, unitedOnly()));
  std::printf("| %s | %.1e | %.1e |\n", name,
              errorOf(K.topLeftCorner<3, 3>(), reference.topLeftCorner<3, 3>()),
              errorOf(K.bottomRightCorner<3, 3>(), reference.bottomRightCorner<3, 3>()));
  std::fflush(stdout);
}

btTransform at(double x) {
  return btTransform(btQuaternion::getIdentity(), toBullet(Vector3(x, 0, 0)));
}

void studyKnownUnions() {
  std::printf("| compound | rotation | translation |\n|---|---|---|\n");
  btBoxShape cube(btVector3(0.5, 0.5, 0.5));
  btSphereShape ball(0.5), unit_ball(1);
  btCylinderShapeX rod(btVector3(0.5, 0.5, 0.5));
  btCompoundShape side_by_side, overlapping, capsule, pair;
  for (const double side : {-0.5, 0.5}) {
    side_by_side.addChildShape(at(side), &cube);
    overlapping.addChildShape(at(side / 2), &cube);
    capsule.addChildShape(at(side), &ball);
    pair.addChildShape(at(2 * side), &unit_ball);
  }
  capsule.addChildShape(at(0), &rod);
  compare("two cubes side by side", side_by_side, btBoxShape(btVector3(1, 0.5, 0.5)));
  compare("two cubes that overlap by half", overlapping, btBoxShape(btVector3(0.75, 0.5, 0.5)));
  compare("cylinder with a ball at each end", capsule, btCapsuleShapeX(0.5, 1));
  // Image dipoles have strengths of 1, -1/8, 1/27, ...: their sum is eta(3).
  constexpr double kEta3 = 0.9015426773696957;
  const double images = 4 * kPi / 3 * (3 * kEta3 - 2);
  const double along = makeFluidBody(pair, unitedOnly()).added_mass(3, 3);
  std::printf("| two balls that touch, along their line | | %.1e |\n",
              std::abs(along / images - 1));
  CollisionShapeSettings sum = unitedOnly();
  const Matrix6 whole = makeFluidBody(side_by_side, sum).added_mass;
  const Matrix6 one = makeFluidBody(cube, sum).added_mass;
  std::printf(
      "\ntwo cubes side by side, along and across their line: %.3f, %.3f; sum of the two: %.3f\n",
      whole(3, 3), whole(4, 4), 2 * one(3, 3));
}

}  // namespace
}  // namespace ambient

int main() try {
  ambient::studyRandomCompounds();
  ambient::studyKnownUnions();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "compound_study: %s\n", error.what());
  return 1;
}
