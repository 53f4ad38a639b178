#pragma once

namespace ambient {

/// Part of every fluid body's provenance, so that files of an older revision are built anew. Raise
/// it with every change after which the same mesh or shape with the same settings gives numbers
/// that differ by more than rounding: added mass and its parts, faces of a shape, reduced loads.
constexpr int kSolverRevision = 19;

}  // namespace ambient
