#pragma once

#include <string>
#include <vector>

#include "preprocess/collision_shape/solids/solid.h"

namespace ambient {

/// Replacement for children of a compound that touch or overlap and cannot be united.
enum class CompoundFallback {
  kHull,    ///< their convex hull: a real flow, but more volume
  kSum,     ///< the sum of the added masses of each alone: right volume if they only touch, no
            ///< interaction
  kRefuse,  ///< nothing: an exception
};

struct UnionSettings {
  int faces = 0;  ///< triangles aimed at
  CompoundFallback fallback = CompoundFallback::kHull;
};

/// Solids with gaps between them, made of the solids of one shape.
struct SeparateSolids {
  std::vector<Solid> solids;
  bool has_unions = false;  ///< true: some of them are unions
  bool is_sum = false;  ///< true: CompoundFallback::kSum was needed; some of them touch or overlap
};

/// Returns true if all of them are polyhedra.
bool arePolyhedra(const std::vector<Solid>& solids);

/// Unites solids that touch or overlap, or leave gaps too narrow for the flow (kLeastGap). Each
/// keeps what of its surface lies outside the others; where that leaves no closed surface, as when
/// they touch in an edge, they are blown up about their centres by 0.03 %, then by 0.12 %. Cost
/// O(T P) for triangles T of one and planes P of the other.
/// @throws std::runtime_error in one line that begins with `name` and names two of them, if they
/// cannot be united and the settings say so.
SeparateSolids uniteSolids(const std::vector<Solid>& solids, const UnionSettings& settings,
                           const std::string& name);

/// Applies the settings' fallback to solids that touch or overlap, and warns. For solids that could
/// be united, but around whose union the flow could not be solved; `reason` says why.
/// @throws std::runtime_error as uniteSolids().
SeparateSolids replaceUnions(const std::vector<Solid>& solids, const UnionSettings& settings,
                             const std::string& reason, const std::string& name);

}  // namespace ambient
