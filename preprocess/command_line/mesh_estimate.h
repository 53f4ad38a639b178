#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "preprocess/mesh/triangle_quality.h"
#include "preprocess/potential_flow/results/flow_estimate.h"

namespace ambient {

/// How far the added mass of a mesh can be trusted, and what is worst about it.
struct MeshEstimate {
  std::optional<FlowEstimate> flow;  ///< none: the mesh is too large for a comparison
  std::optional<Thickness> thinnest;
  std::vector<TriangleQuality> worst_triangles;  ///< three
};

/// Solves the flow around a mesh that can be built.
/// @throws std::runtime_error in one line that begins with `name`.
MeshEstimate estimateMesh(const TriangleMesh& mesh, const PotentialFlowSettings& settings,
                          const std::string& name);

nlohmann::ordered_json estimateJson(const MeshEstimate& estimate);
/// Rows of a table for people.
std::string estimateTable(const MeshEstimate& estimate);

}  // namespace ambient
