#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/shape/shapes.h"

namespace ambient {

/// Numbers of a wing that its author gives in place of measured ones.
struct GivenWing {
  std::string name;
  std::optional<double> span, chord;  ///< [m]
  std::optional<double> aspect;       ///< L of docs/theory.md eq. (156), images counted
};

/// Choice of the triangles of a mesh that are wings.
struct WingPlan {
  std::vector<std::uint8_t> labels;  ///< of each triangle: 0 or the number of a wing; empty: none
  std::vector<GivenWing> given;      ///< of each wing
};

/// Finds the wings that are asked for.
/// @param wanted "none"; "auto", for nodes of the mesh file whose names say that they are wings, or
/// where there are none for those of findWings(); or a JSON file that lists them
/// @param mesh checked, of `shape`
/// @param shape its file is read again for names of nodes and numbers of triangles
/// @param scale from the shape to the mesh
/// @throws std::runtime_error in one line that names the file
WingPlan planWings(const std::string& wanted, const TriangleMesh& mesh,
                   const ShapeDescription& shape, double scale);

/// Words of a provenance for what is asked for; empty: none.
std::string wingsText(const std::string& wanted);

/// Sets the wings of a fluid body whose surface and origin are there, and the part of each
/// triangle. `mesh`: that of the body, in its frame, with `labels` of its triangles; `sheet`: they
/// have two sides.
void setWings(const WingPlan& plan, const TriangleMesh& mesh, std::vector<std::uint8_t> labels,
              bool sheet, FluidBody& body);

}  // namespace ambient
