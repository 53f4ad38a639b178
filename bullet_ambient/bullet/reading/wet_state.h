#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/region_id.h"
#include "bullet_ambient/spatial/vector_types.h"

AMBIENT_BEGIN

struct AmbientBody;
class FluidRegions;

/// Part of a body or link that is in its fluid, and with a surface near, in the fluid below that.
struct WetState {
  double volume = 0;   ///< [m^3]
  double share = 0;    ///< of its volume; of a sheet, which has none, of its height
  double draught = 0;  ///< depth of its lowest point [m]; 0: dry; infinite: no surface
  double area = 0;     ///< [m^2]
  /// In W [m]. Of a dry body its centre of volume.
  Vector3 centre_of_buoyancy{0, 0, 0};
  RegionId region = RegionId::kNone;
};

/// Asks the regions at the pose of now.
WetState wetStateOf(const AmbientBody& ambient, const FluidRegions& regions);

AMBIENT_END
