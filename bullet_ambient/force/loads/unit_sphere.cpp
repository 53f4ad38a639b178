#include "bullet_ambient/force/loads/unit_sphere.h"

#include <cmath>

#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

/// Adds the triangle of three places near the sphere: its centroid, moved onto the sphere, with the
/// solid angle of the triangle.
void addTriangle(const Vector3& a, const Vector3& b, const Vector3& c, FaceTable& faces) {
  const Vector3 centroid = (a + b + c) / 3, outward = centroid.normalized();
  const double across = std::abs((b - a).cross(c - a).dot(outward)) / 2;
  faces.add(outward, outward, across / centroid.squaredNorm());
}

/// Faces of one octant: kEdge^2 triangles between the directions of a lattice.
void addOctant(const Vector3& signs, FaceTable& faces) {
  constexpr int kEdge = 12;
  const auto place = [&](int i, int j) {
    return signs.cwiseProduct(Vector3(i, j, kEdge - i - j)).normalized();
  };
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; i + j < kEdge; ++j) {
      addTriangle(place(i, j), place(i + 1, j), place(i, j + 1), faces);
      if (i + j + 1 == kEdge) continue;
      addTriangle(place(i + 1, j), place(i, j + 1), place(i + 1, j + 1), faces);
    }
}

FluidBody makeSphere() {
  FluidBody sphere;
  sphere.name = "sphere";
  sphere.sphere_radius = 1;
  sphere.area = 4 * kPi;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) addOctant({x, y, z}, sphere.faces);
  double sum = 0;
  for (const double area : sphere.faces.area) sum += area;
  for (double& area : sphere.faces.area) area *= sphere.area / sum;
  sphere.form.faces = sphere.faces;
  sphere.form.faces.sharpness.assign(sphere.faces.size(), 0);
  sphere.form.shape.edges = 0;
  return sphere;
}

}  // namespace

std::shared_ptr<const FluidBody> unitSphere() {
  static const auto sphere = std::make_shared<const FluidBody>(makeSphere());
  return sphere;
}

PlaneInRadii::PlaneInRadii(const SurfacePlane& plane_at_centre, const Vector3& centre,
                           double radius) noexcept
    : plane(plane_at_centre) {
  plane.height /= radius;
  if (!plane.sides_F) return;
  sides = *plane.sides_F;
  for (int i = 0; i < sides.count; ++i) sides.of[i].point = (sides.of[i].point - centre) / radius;
  plane.sides_F = &sides;
}

}  // namespace ambient
