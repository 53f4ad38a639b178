#pragma once

namespace ambient {

/// Water surface, and right-handed axes in the surface: e_1 x e_2 = s.
struct HullPlane {
  double normal[3];   ///< s
  double axes[2][3];  ///< e_1, e_2
  double height;      ///< h [m]
};

}  // namespace ambient
