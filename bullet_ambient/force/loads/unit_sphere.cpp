#include "bullet_ambient/force/loads/unit_sphere.h"

#include <cmath>
#include <utility>

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
  return sphere;
}

/// Surface of the fluid at a sphere of a radius [m] and a centre in F [m], with lengths in radii
/// about the centre. `plane_at_centre` is in a frame at the centre with the axes of F.
struct PlaneInRadii {
  PlaneInRadii(const SurfacePlane& plane_at_centre, const Vector3& centre, double radius) noexcept
      : plane(plane_at_centre) {
    plane.height /= radius;
    if (!plane.sides_F) return;
    sides = *plane.sides_F;
    for (int i = 0; i < sides.count; ++i) sides.of[i].point = (sides.of[i].point - centre) / radius;
    plane.sides_F = &sides;
  }
  PlaneInRadii(const PlaneInRadii&) = delete;  // plane points to sides

  SurfacePlane plane;
  PoolSides sides;
};

/// Result of makeWetSphereLoads().
class WetSphereLoads final : public SurfaceLoads {
 public:
  WetSphereLoads(std::shared_ptr<const SurfaceLoads> on_unit, const FluidBody& sphere)
      : on_unit_(std::move(on_unit)),
        centre_(sphere.centre_of_volume),
        radius_(sphere.sphere_radius) {}

  Wrench load(const Twist& x) const noexcept override { return parts(x).total(); }
  FaceLoads parts(const Twist& x) const noexcept override {
    return enlarged(on_unit_->parts(inRadii(x)));
  }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    const PlaneInRadii surface(wet.plane, centre_, radius_);
    return enlarged(on_unit_->wetLoad(inRadii(x), {surface.plane, wet.share}));
  }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    const PlaneInRadii surface(wet.plane, centre_, radius_);
    return enlarged(on_unit_->wetParts(inRadii(x), {surface.plane, wet.share}));
  }
  int faces() const noexcept override { return on_unit_->faces(); }
  bool needsGuard() const noexcept override { return on_unit_->needsGuard(); }
  double wakeShare() const noexcept override { return on_unit_->wakeShare(); }
  /// Frame at the sphere's centre with the axes of F.
  FrameOffset frame(const FrameOffset& fluid_frame) const override {
    return {fluid_frame.rotation, fluid_frame.rotation * centre_ + fluid_frame.translation};
  }

 private:
  Twist inRadii(const Twist& x) const noexcept { return {radius_ * x.angular, x.linear}; }
  Wrench enlarged(const Wrench& load) const noexcept {
    const double square = radius_ * radius_;
    return {square * radius_ * load.torque, square * load.force};
  }
  FaceLoads enlarged(const FaceLoads& loads) const noexcept {
    return {enlarged(loads.pressure), enlarged(loads.friction)};
  }

  std::shared_ptr<const SurfaceLoads> on_unit_;
  Vector3 centre_;
  double radius_;
};

}  // namespace

std::shared_ptr<const FluidBody> unitSphere() {
  static const auto sphere = std::make_shared<const FluidBody>(makeSphere());
  return sphere;
}

std::shared_ptr<const SurfaceLoads> makeWetSphereLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                       const FluidBody& sphere) {
  return std::make_shared<WetSphereLoads>(std::move(on_unit), sphere);
}

}  // namespace ambient
