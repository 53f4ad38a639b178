#pragma once

#include <cstdint>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wings/triangle_tree.h"

namespace ambient {

/// Joint of a wing: where it leaves the body.
struct WingJoint {
  double root_thickness = 0;  ///< of the wing at the joint [m]
  /// Thickness across the mean plane in the body, one root thickness beyond the joint, over that of
  /// the root; of a wing that meets the body in its middle, there, over its own. 0: to other wings.
  double step = 0;
  double body_width = 0;  ///< of the body beside the joint, along the span [m]
  double rest_share = 0;  ///< share of the joint that is with the rest of the body
};

struct MeasuredWing {
  Wing wing;
  WingJoint joint;
};

/// Measures the wings of a mesh, docs/theory.md eq. (156), (157): exact moments of their triangles,
/// joints along the edges that they share with others. Frame of the mesh. Cost O(T log T).
/// @param mesh a closed body, or a sheet
/// @param labels of its triangles: 0 or the number of a wing from 1 on
/// @param sheet its triangles have two sides
/// @throws std::runtime_error in one sentence, if a wing has no area
std::vector<MeasuredWing> measureWings(const TriangleMesh& mesh,
                                       const std::vector<std::uint8_t>& labels, bool sheet);

/// False of a part that runs out of the body without a step, as bows and ears do. A slender one,
/// as the wing of an airliner, may.
bool standsOff(const MeasuredWing& measured);

}  // namespace ambient
