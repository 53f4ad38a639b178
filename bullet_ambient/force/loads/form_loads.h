#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/loads/wing_lift.h"

namespace ambient {

/// Loads on the wings of a body: their lift, and the pressure on the faces of each.
struct LoadsOnWings {
  WingLift lift;
  std::vector<std::shared_ptr<const SurfaceLoads>> on_faces;
};

/// Returns the loads of the form law on a body that is no ball, docs/theory.md eq. (113), (160).
/// @param on_faces pressure on `faces`
/// @param faces of the body, or of the rest of one with wings
/// @param body it and its tables
/// @param settings of the fluid and the law
/// @param stall_lag as FlowSettings::stall_lag
/// @param wings none: the body is one part
std::shared_ptr<const SurfaceLoads> makeFormLoads(std::shared_ptr<const SurfaceLoads> on_faces,
                                                  const LoadTables::Faces& faces,
                                                  const LoadTables::Body& body,
                                                  const LoadSettings& settings, double stall_lag,
                                                  std::optional<LoadsOnWings> wings = std::nullopt);

/// Returns the loads of the form law on a ball, docs/theory.md eq. (119). `on_unit`: pressure on
/// unitSphere(); null for a ball that no surface cuts.
std::shared_ptr<const SurfaceLoads> makeBallLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                  const FluidBody& ball,
                                                  const LoadSettings& settings);

}  // namespace ambient
