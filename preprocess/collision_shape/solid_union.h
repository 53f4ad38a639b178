#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/solid.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Solids with gaps between them, which bound the same body.
struct SeparateSolids {
  std::vector<Solid> solids;
  bool has_unions = false;  ///< some of them are made of several
  bool is_sum = false;      ///< CompoundFallback::kSum was needed: some of them touch or overlap
};

/// Unites solids that touch or overlap, or leave gaps too narrow for the flow (kLeastGap). Each
/// keeps what of its surface lies outside the others; where that leaves no closed surface, as when
/// they touch in an edge, they are blown up about their centres by 0.03 %, then by 0.12 %. Cost
/// O(T P) for triangles T of one and planes P of the other.
/// @throws std::runtime_error in one line that begins with `name` and names two of them, if they
/// cannot be united and the settings say so.
SeparateSolids uniteSolids(const std::vector<Solid>& solids, const CollisionShapeSettings& settings,
                           const std::string& name);

/// What the settings' fallback puts in place of solids that touch or overlap, with a warning, where
/// they could be united but the flow around their union could not be solved for that reason.
/// @throws std::runtime_error as uniteSolids().
SeparateSolids replaceUnions(const std::vector<Solid>& solids,
                             const CollisionShapeSettings& settings, const std::string& reason,
                             const std::string& name);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
