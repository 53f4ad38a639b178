#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_faces.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/force/loads/single_motion.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/invariants.h"

namespace ambient {
namespace {

SingleCut cutBy(const SurfacePlane& plane, const PackedFaces& faces) noexcept {
  const double length = faces.lengthUnit();
  AMBIENT_ASSERT(isUnit(plane.normal));
  const Eigen::Vector3f s = plane.normal.cast<float>();
  // The clamp keeps single precision finite; farther away only the side of the plane matters.
  const double height = std::clamp(plane.height / length, -1e6, 1e6);
  return {{s.x(), s.y(), s.z()},
          static_cast<float>(height),
          static_cast<float>(faces.areaUnit() / (kPi * length * length))};
}

}  // namespace

Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings,
                       const SurfacePlane* plane) noexcept {
  AMBIENT_ASSERT(faces.size() == 0 ||
                 (settings.law == PressureLaw::kForm) == (faces.blocks().form != nullptr));
  AMBIENT_ASSERT(!settings.shape || settings.law == PressureLaw::kForm);
  AMBIENT_ASSERT(settings.density >= 0 && reference_length >= 0);
  static const SumBlocks sum_blocks = kSumBlocks.fastest();
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  SingleMotion single = singleMotion(motion, settings, reference_length);
  const SingleCut cut = plane ? cutBy(*plane, faces) : SingleCut{};
  if (plane) single.cut = &cut;
  if (settings.shape) addShape(*settings.shape, motion, length, settings.separation_cosine, single);
  LoadSums sums = sum_blocks(faces.blocks(), single);
  if (single.wing)
    for (int axis = 0; axis < 3; ++axis)
      sums.wrench[axis] -= settings.shape->shape.pitching[axis] * sums.pitch;
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
