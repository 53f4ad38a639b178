#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Triangles of a shape in F: for drawing, hydrostatics and the form law.
struct Surface {
  std::vector<double> vertices;  ///< x, y, z per vertex [m]
  std::vector<std::int32_t>
      triangles;  ///< three vertex indices per triangle, counter-clockwise from the fluid
};

/// An opening of a hold: where water comes in over its rim or through it.
struct HoldOpening {
  std::vector<double> outline;    ///< x, y, z of its corners, counter-clockwise from outside [m]
  std::vector<std::int32_t> lid;  ///< triangles across it: three corners of the outline each
  int to = -1;                    ///< the hold that it leads to; -1: the fluid outside
};

/// A room inside a body that keeps water out or in up to its openings. Per unit density, in F.
struct Hold {
  std::string name;
  Surface surface;          ///< its walls and lids, closed, counter-clockwise from outside the hold
  double volume = 0;        ///< [m^3]
  Vector3 centre{0, 0, 0};  ///< of its volume [m]
  /// Inertia of the fluid that fills it, about its centre, as it resists turning, docs/theory.md
  /// eq. (133) [m^5].
  Matrix3 turning_inertia = Matrix3::Zero();
  std::vector<HoldOpening> openings;  ///< each once: one between two holds is the first hold's
};

}  // namespace ambient
