#include "bullet_ambient/motion/surface/surface_passage.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/passage_kernel.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

BoundedTwist passSurface(const SurfacePassage& p, const Vector6& x) noexcept {
  AMBIENT_ASSERT(p.duration > 0 && !(p.gravity < 0));
  AMBIENT_ASSERT(isUnit(p.normal) && isSymmetric(p.after, 1e-9));
  const FullMatrices before = inAllLanes(p.before), after = inAllLanes(p.after),
                     inverse_after = inAllLanes(p.inverse_after);
  const PassedTwists passed =
      passSurface({before, after, inverse_after, inAllLanes(p.gradient.vector()),
                   inAllLanes(p.normal), inAllLanes(p.centre_of_buoyancy), all(p.draught),
                   all(p.cover), all(p.gravity), all(p.duration), Lanes{}},
                  inAllLanes(x));
  return {ofFirstLane(passed.end.twist), passed.end.energy_removed[0]};
}

}  // namespace ambient
