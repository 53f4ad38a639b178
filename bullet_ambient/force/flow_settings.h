#pragma once

#include <functional>
#include <memory>

namespace ambient {

struct FluidBody;
struct LoadSettings;
class SurfaceLoads;

/// A law of surface loads, bound to a shape and its fluid. Called when a body is attached or its
/// fluid or shape changes; density > 0.
using LoadLaw = std::function<std::shared_ptr<const SurfaceLoads>(
    const std::shared_ptr<const FluidBody>&, const LoadSettings&)>;

/// Arithmetic of the loads on faces. What a face does is rounded; sums, and all else, are in
/// double.
enum class LoadPrecision {
  kSingle,  ///< half the time; moves bodies by a hundredth of what 1280 faces leave, or less
  kDouble,
};

/// How the flow follows the surface of one body.
struct FlowSettings {
  double separation_angle =
      1.5707963267948966;     ///< alpha in [pi/2, pi] [rad]; larger = more attachment
  bool skin_friction = true;  ///< turbulent 1/5-power law, docs/theory.md eq. (16)
  LoadLaw own_law = nullptr;  ///< empty: this library's pressure and friction
  LoadPrecision precision = LoadPrecision::kSingle;
  /// Allowed p99 error of reduced loads, LoadLevelError: the cheapest level of the fluid body for
  /// the separation angle that keeps it stands in for the faces. 0, or no such level: all faces.
  double maximum_load_error = 0;
};

}  // namespace ambient
