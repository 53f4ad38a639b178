#include "bullet_ambient/force/loads/drag_scale.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/loads/face_loads.h"

namespace ambient {
namespace {

/// Drag coefficient C_j^0 of the form law along an axis, mean of both ways; 0 if edge-on.
double dragAlong(int axis, const FaceTable& faces, const ShapeFactors& shape) {
  const LoadSettings settings{1, 0, 0, false, PressureLaw::kForm, &shape};
  double frontal_area = 0, force = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    frontal_area += 0.5 * faces.area[i] * std::abs(faces.normal(i)[axis]);
  for (const double way : {1.0, -1.0}) {
    const Twist x{Vector3::Zero(), way * Vector3::Unit(axis)};
    force -= way * computeFaceLoads(faces, 1, x, settings).pressure.force[axis];
  }
  return frontal_area > 0 ? force / frontal_area : 0;
}

}  // namespace

DragScale::DragScale(const FluidBody& body, const FaceTable& faces, const ShapeFactors& shape)
    : is_measured_(!body.drag.isZero(0)), centre_(body.centre_of_volume), length_sq_(body.area) {
  AMBIENT_ASSERT(faces.sharpness.size() == faces.size());
  if (!is_measured_) return;
  for (int axis = 0; axis < 3; ++axis) {
    const double drag = dragAlong(axis, faces, shape);
    AMBIENT_ASSERT(std::isfinite(drag));
    if (drag > 0) scales_[axis] = body.drag[axis] / drag;
  }
}

Wrench DragScale::scaled(const Wrench& load, const Twist& x) const noexcept {
  if (!is_measured_) return load;
  const Vector3 v = x.at(centre_), along = v.cwiseAbs2();
  const double turning = length_sq_ * x.angular.squaredNorm();
  const double sum = along.sum() + turning;
  if (!(sum > 0)) return load;
  const double factor = (scales_.dot(along) + scales_.mean() * turning) / sum;
  const double power = load.torque.dot(x.angular) + load.force.dot(x.linear);
  const double more = (factor - 1) * power / sum;
  const Vector3 force = more * v;
  return load + Wrench{more * length_sq_ * x.angular + centre_.cross(force), force};
}

}  // namespace ambient
