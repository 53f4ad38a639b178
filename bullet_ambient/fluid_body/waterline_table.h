#pragma once

#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// What the parts of a body's added mass, docs/theory.md eq. (60), lack at the surface of still
/// water, by boundary elements; docs/theory.md eq. (61a). Per unit density, about F's origin.
struct WaterlineTable {
  /// Depth of the lowest point over the height of the body from which on the surface is left out.
  static constexpr double kDeep = 3;

  /// Of the lattice of the surface's normals in F; 0: there is no table.
  int subdivisions = 0;
  /// Depth of the lowest point over the height of the body, ascending, in (0, kDeep); at
  /// kDeep there is nothing lacking.
  std::vector<double> immersions;
  /// Symmetric; of each normal in turn those at all immersions.
  std::vector<Matrix6> corrections;

  bool empty() const { return subdivisions == 0; }
};

}  // namespace ambient
