#include <algorithm>

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/face_loads.h"
#include "bullet_ambient/force/single_motion.h"
#include "bullet_ambient/force/surface_plane.h"
#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/pi.h"

namespace ambient {
namespace {

SingleCut cutBy(const SurfacePlane& plane, const PackedFaces& faces) noexcept {
  const double length = faces.lengthUnit();
  const Eigen::Vector3f s = plane.normal.cast<float>();
  // Far from the body, what counts is on which side of it the plane is.
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
  static const SumBlocks sum_blocks = kSumBlocks.fastest();
  const double length = faces.lengthUnit();
  const ScaledMotion motion = scaledMotion(relative_twist.angular, relative_twist.linear, length);
  SingleMotion single = singleMotion(motion, settings, reference_length);
  const SingleCut cut = plane ? cutBy(*plane, faces) : SingleCut{};
  if (plane) single.cut = &cut;
  const LoadSums sums = sum_blocks(faces.blocks(), single);
  return scaledLoad(sums, settings.density, motion.unit.speed, faces.areaUnit(), length);
}

}  // namespace ambient
