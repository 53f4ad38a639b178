#pragma once

#include "bullet_ambient/immersed/region_id.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

struct AmbientBody;
class FluidRegions;
struct MotionView;

/// Wet part of a body or link: the part in its fluid; near a water surface the part in the fluid
/// below.
struct WetState {
  double volume = 0;  ///< [m^3]
  double share = 0;  ///< share of the volume that is wet [1]; for a sheet, whose volume is 0, share
                     ///< of its height
  double draught = 0;  ///< depth of the lowest point [m]; 0: dry; infinite: no surface is near
  double area = 0;     ///< [m^2]
  /// Centre of the wet volume in W [m]; for a dry body its centre of volume.
  Vector3 centre_of_buoyancy{0, 0, 0};
  RegionId region = RegionId::kNone;
};

/// Computes the wet part at the present pose, from the region there.
WetState wetStateOf(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions);

}  // namespace ambient
