#pragma once

#include <array>
#include <optional>
#include <utility>

#include "bullet_ambient/force/medium/medium.h"

namespace ambient {

/// Files of other programs that a fluid body can be handed over in.
enum class ExportFormat { kSdf, kMjcf, kFossen, kBemio };

/// Names of the formats in commands.
constexpr std::array<std::pair<ExportFormat, const char*>, 4> kExportFormatNames{
    {{ExportFormat::kSdf, "sdf"},
     {ExportFormat::kMjcf, "mjcf"},
     {ExportFormat::kFossen, "fossen"},
     {ExportFormat::kBemio, "bemio"}}};

/// Body, fluid and place for which a fluid body is handed over. Vectors are in F.
struct ExportSettings {
  Medium medium = water();  ///< density and viscosity count
  double gravity = 9.81;    ///< [m/s^2]
  /// [kg]; default: that of the fluid which the body displaces.
  std::optional<double> mass;
  /// [m]; default: of a mass spread evenly over the volume, or over the area of a sheet.
  std::optional<Vector3> centre_of_mass;
  Vector3 forward{1, 0, 0}, up{0, 0, 1};  ///< unit, perpendicular
  /// Depth of the lowest point along `up` below the surface [m]; default: no surface near.
  std::optional<double> draught;
  /// Along `forward` [m/s], for the linearised drag of Fossen's model; default: no drag.
  std::optional<double> speed;
};

}  // namespace ambient
