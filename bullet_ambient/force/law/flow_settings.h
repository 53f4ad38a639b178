#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "bullet_ambient/force/law/pressure_law.h"

namespace ambient {

class Foils;
struct FluidBody;
struct LoadSettings;
class SurfaceLoads;

/// Factory of a user's own surface loads for a shape in a fluid with density > 0. Called when a
/// body is attached and when its fluid or shape changes.
using LoadLaw = std::function<std::shared_ptr<const SurfaceLoads>(
    const std::shared_ptr<const FluidBody>&, const LoadSettings&)>;

/// Arithmetic of the loads on faces. What a face does is rounded; sums, and all else, are in
/// double.
enum class LoadPrecision {
  kSingle,  ///< half the time; its error is at most a hundredth of that of a mesh of 1280 faces
  kDouble,
};

constexpr std::array<std::pair<LoadPrecision, const char*>, 2> kLoadPrecisionNames{
    {{LoadPrecision::kSingle, "single"}, {LoadPrecision::kDouble, "double"}}};

/// Settings of the flow around one body.
struct FlowSettings {
  /// alpha in [pi/2, pi] [rad], larger = more attachment; the published law alone reads it.
  double separation_angle = 1.5707963267948966;
  bool skin_friction = true;  ///< resistance, docs/theory.md eq. (113); published law: eq. (16)
  LoadLaw own_law = nullptr;  ///< empty: this library's pressure and friction
  LoadPrecision precision = LoadPrecision::kSingle;
  /// Allowed error of fewer faces by the form law, FormLevel::p99_error [1]. The level of the fluid
  /// body with the fewest faces within this error stands in for all. 0, or no such level: all
  /// faces.
  double maximum_load_error = 0.01;
  PressureLaw law = PressureLaw::kForm;
  /// Lag lambda of separation behind the incidence, eq. (48): in body lengths over speed; kForm.
  double stall_lag = 4.5;
  /// Height of the roughness of the surface [m], form law: dimples, felt, fouling; 0: smooth.
  double roughness = 0;
  /// Wings, fins and rudders by their numbers, beside the shape of the body; null: none. Kept by
  /// whoever turns them, Foils::turn(); a body that gets a saved state keeps its own.
  std::shared_ptr<const Foils> foils = nullptr;

  /// Whether models by these settings are those of one body alone.
  bool isOfOneBody() const { return own_law || foils; }
};

}  // namespace ambient
