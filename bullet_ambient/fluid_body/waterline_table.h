#pragma once

#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Correction of the added mass at the surface of still water, docs/theory.md eq. (61a): boundary
/// elements minus the sum over parts (60). Per unit density, about F's origin.
struct WaterlineTable {
  /// Immersion from which on the surface is ignored; see `immersions`.
  static constexpr double kDeep = 3;

  /// Subdivisions of the lattice of the surface's normals in F; 0: there is no table.
  int subdivisions = 0;
  /// Immersions eta: depth of the lowest point over the height of the body. Ascending, in
  /// (0, kDeep); at kDeep the correction is 0.
  std::vector<double> immersions;
  /// Symmetric matrices; index: normal times number of immersions, plus immersion.
  std::vector<Matrix6> corrections;

  bool empty() const { return subdivisions == 0; }
};

}  // namespace ambient
