#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>

namespace ambient {

struct FluidBody;
struct LoadSettings;
class SurfaceLoads;

/// A law of surface loads, bound to a shape and its fluid. Called when a body is attached or its
/// fluid or shape changes; density > 0.
using LoadLaw = std::function<std::shared_ptr<const SurfaceLoads>(
    const std::shared_ptr<const FluidBody>&, const LoadSettings&)>;

/// What the fluid presses with on a face.
enum class PressureLaw {
  kPublished,  ///< of the slip, docs/theory.md eq. (14): Padilla et al. 2025
  kForm,       ///< of the form drag, eq. (43) to (51): for boxes and whatever else has flat sides
};

/// As scenes and commands name them.
constexpr std::array<std::pair<PressureLaw, const char*>, 2> kPressureLawNames{
    {{PressureLaw::kPublished, "published"}, {PressureLaw::kForm, "form"}}};

/// Arithmetic of the loads on faces. What a face does is rounded; sums, and all else, are in
/// double.
enum class LoadPrecision {
  kSingle,  ///< half the time; moves bodies by a hundredth of what 1280 faces leave, or less
  kDouble,
};

constexpr std::array<std::pair<LoadPrecision, const char*>, 2> kLoadPrecisionNames{
    {{LoadPrecision::kSingle, "single"}, {LoadPrecision::kDouble, "double"}}};

/// How the flow follows the surface of one body.
struct FlowSettings {
  double separation_angle =
      1.5707963267948966;     ///< alpha in [pi/2, pi] [rad]; larger = more attachment
  bool skin_friction = true;  ///< turbulent 1/5-power law, docs/theory.md eq. (16)
  LoadLaw own_law = nullptr;  ///< empty: this library's pressure and friction
  LoadPrecision precision = LoadPrecision::kSingle;
  /// Allowed p99 error of reduced loads, LoadLevelError and FormLevel: the cheapest level of the
  /// fluid body for law and separation angle that keeps it stands in for the faces. 0, or no such
  /// level: all faces.
  double maximum_load_error = 0.01;
  PressureLaw law = PressureLaw::kPublished;  ///< a sphere is the same in both
  /// Delay of separation behind the incidence, kForm: lengths of the body over its speed. 0: none.
  double stall_lag = 4.5;
};

}  // namespace ambient
