#include "bullet_ambient/force/loads/face_loads.h"

#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/force/kernels/face_sums.h"
#include "bullet_ambient/force/law/shape_factors.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/invariants.h"

namespace ambient {
namespace {

FaceColumns columnsOf(const FaceTable& faces, PressureLaw law) noexcept {
  const bool is_form = law == PressureLaw::kForm;
  AMBIENT_ASSERT(faces.normal_x.size() == faces.size() && faces.centroid_z.size() == faces.size());
  AMBIENT_ASSERT(!is_form || faces.sharpness.size() == faces.size());
  return {{faces.normal_x.data(), faces.normal_y.data(), faces.normal_z.data()},
          {faces.centroid_x.data(), faces.centroid_y.data(), faces.centroid_z.data()},
          faces.area.data(),
          faces.size(),
          is_form ? faces.sharpness.data() : nullptr};
}

FaceCut cutBy(const SurfacePlane& plane) noexcept {
  AMBIENT_ASSERT(isUnit(plane.normal));
  const Vector3& s = plane.normal;
  return {{s.x(), s.y(), s.z()}, plane.height};
}

/// Adds what the form law asks of a shape, eq. (43d) and (43e).
void addShape(const ShapeFactors& factors, const Vector3& angular, double separation_cosine,
              FaceMotion& motion) noexcept {
  motion.slip_share = factors.slipShare(separation_cosine);
  if (!factors.actOnFaces()) return;
  motion.wing = &factors.in_double;
  motion.pitching_rate = factors.shape.pitching.dot(angular);
  for (int axis = 0; axis < 3; ++axis) {
    motion.pitching[axis] = factors.shape.pitching[axis];
    motion.centre[axis] = factors.shape.centre[axis];
  }
}

Wrench scaled(const double (&sums)[6], double factor) noexcept {
  return {{factor * sums[0], factor * sums[1], factor * sums[2]},
          {factor * sums[3], factor * sums[4], factor * sums[5]}};
}

}  // namespace

double separationCosine(double separation_angle) {
  const double right_angle = portable::acos(0.0);
  const double rounding = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(separation_angle - right_angle) <= rounding) return 0;
  return portable::cos(separation_angle);
}

FaceLoads computeFaceLoads(const FaceTable& faces, double reference_length,
                           const Twist& relative_twist, const LoadSettings& settings,
                           const SurfacePlane* plane) noexcept {
  static const SumFaces sum_faces = kSumFaces.fastest();
  const double cosine = settings.separation_cosine;
  const Vector3& w = relative_twist.angular;
  const Vector3& v = relative_twist.linear;
  AMBIENT_ASSERT(cosine >= -1 && cosine <= 0);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  const FaceCut cut = plane ? cutBy(*plane) : FaceCut{};
  FaceMotion motion{{w.x(), w.y(), w.z()}, {v.x(), v.y(), v.z()},  -cosine * std::abs(cosine),
                    1 - cosine * cosine,   plane ? &cut : nullptr, settings.law};
  const double reynolds_per_speed = settings.reynoldsPerSpeed(reference_length);
  const bool with_friction = reynolds_per_speed > 0;

  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  if (settings.shape) addShape(*settings.shape, w, cosine, motion);
  const FaceSums sums = sum_faces(columnsOf(faces, settings.law), motion, with_friction);
  const double half_density = 0.5 * settings.density;
  FaceLoads loads;
  loads.pressure = scaled(sums.pressure, -half_density);
  if (motion.wing)
    loads.pressure.torque += half_density * sums.pitch * settings.shape->shape.pitching;
  if (with_friction) {
    const double friction_scale = kFrictionCoefficient * reynoldsPower(reynolds_per_speed);
    loads.friction = scaled(sums.friction, -half_density * friction_scale);
  }
  return loads;
}

}  // namespace ambient
