#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "bullet_ambient/force/medium/medium.h"

namespace ambient {

/// File formats of other programs for fluid bodies.
enum class ExportFormat { kSdf, kMjcf, kFossen };

/// Names of the formats in commands.
constexpr std::array<std::pair<ExportFormat, const char*>, 3> kExportFormatNames{
    {{ExportFormat::kSdf, "sdf"},
     {ExportFormat::kMjcf, "mjcf"},
     {ExportFormat::kFossen, "fossen"}}};

/// Body, fluid and place for which a fluid body is handed over. Vectors are in F.
struct ExportSettings {
  Medium medium = water();  ///< density and viscosity count
  double gravity = 9.81;    ///< [m/s^2]
  /// Mass [kg]; default: that of the displaced fluid.
  std::optional<double> mass;
  /// Centre of mass [m]; default: that of a uniform mass in the volume, or on the area of a sheet.
  std::optional<Vector3> centre_of_mass;
  Vector3 forward{1, 0, 0}, up{0, 0, 1};  ///< unit, perpendicular
  /// Depth of the lowest point along `up` below the surface [m]; default: no surface near.
  std::optional<double> draught;
  /// Speed along `forward` [m/s] for the linearised drag of Fossen's model; default: no drag.
  std::optional<double> speed;
};

/// A fluid body in the file format of another program.
struct ExportedBody {
  std::string bytes;   ///< content of the file, text
  std::string report;  ///< lines for people on what the format leaves out; may be empty

  /// Writes the file completely or not at all.
  /// @throws std::runtime_error in one line that names the file, if it cannot be written.
  void write(const std::filesystem::path& file) const;
};

}  // namespace ambient
