#pragma once

#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
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

/// Water in one hold of a body or link.
struct HoldWater {
  double volume = 0;    ///< [m^3]
  double capacity = 0;  ///< of the hold [m^3]
  double inflow = 0;    ///< from outside in the last step; negative: out [m^3]
  /// Volumes that have come from outside and left since the body was added [m^3].
  double flooded = 0, drained = 0;
  double area = 0;  ///< of its level [m^2]; 0: empty or full
  /// Height of the lowest corner of its openings above the level [m]; infinite: none is open.
  double freeboard = 0;
  bool has_trapped_air = false;  ///< water shuts off its air from that outside
  double air_pressure = 0;       ///< of its air [Pa]
  Vector3 centre{0, 0, 0};       ///< of the water in W [m]; of an empty hold, that of the hold
  Vector3 level{0, 0, 0};        ///< a point of its surface in W [m]
  Vector3 normal{0, 0, 1};       ///< of its surface in W as it sloshes, out of the water; unit
  /// Where this surface meets the walls, in W: pairs of points, each a line that has the water on
  /// its left seen from above; empty as `area` is zero [m].
  std::vector<Vector3> outline;
};

/// Computes the water in the holds at the present pose.
std::vector<HoldWater> holdsOf(const AmbientBody& ambient, const MotionView& now);

/// Computes the wet part at the present pose, from the region there.
WetState wetStateOf(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions);

}  // namespace ambient
