#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/floating/floating_body.h"

namespace ambient {

/// The shortest text that reads back as the same bits; with a point in every locale.
std::string numberText(double number);

/// A number rounded to `digits`, for people.
std::string roundedText(double number, int digits = 4);

/// A number with `digits` after the point, for people; never -0.
std::string fixedText(double number, int digits);

/// Numbers with a separator between them.
template <class Vector>
std::string rowText(const Vector& row, const char* separator = " ") {
  std::string text;
  for (Eigen::Index i = 0; i < row.size(); ++i)
    text += (i > 0 ? separator : "") + numberText(row[i]);
  return text;
}

/// The entries of a 6x6 matrix in the order of other programs: translation before rotation.
Matrix6 linearFirst(const Matrix6& rotation_first);

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

/// A fluid body with mass, in one fluid at one place. Vectors in F; matrices about F's origin,
/// rotation first.
struct HandedBody {
  std::shared_ptr<const FluidBody> shape;
  ExportSettings settings;
  std::string name;                      ///< the shape's; all but letters, digits, _ . - became _
  PointMass weight;                      ///< [kg], [m]
  Matrix3 inertia = Matrix3::Zero();     ///< about the centre of mass [kg m^2]
  Matrix6 added_mass = Matrix6::Zero();  ///< [kg m^2, kg m; kg m, kg]
  SurfacePlane
      plane;      ///< plane of the surface; its gravity and density count without a surface, too
  WetVolume wet;  ///< wet volume in the fluid

  /// Forward, left and up in F, as columns.
  Matrix3 axes() const;
  /// Centre of buoyancy [m]; for a sheet, which has no volume, the centre of its area.
  Vector3 middle() const;
  /// Inertia of the mass alone.
  Matrix6 ownInertia() const;
};

/// Gives a fluid body mass and fluid. The added mass at a surface is that of fast motions, the
/// potential 0 on the undisturbed surface, docs/theory.md eq. (60).
/// @throws std::invalid_argument in one line that names the fluid body, the value and the limit.
HandedBody handedBody(const std::shared_ptr<const FluidBody>& shape,
                      const ExportSettings& settings);

// Each of these makes a file of one format. Matrices are symmetric to rounding.

/// SDFormat 1.10: a model of one link with mass and fluid_added_mass. The link's frame is F.
ExportedBody makeSdf(const HandedBody& body);

/// MJCF: a free body with mass and the ellipsoid that comes nearest to its added mass. The report
/// compares the two.
ExportedBody makeMjcf(const HandedBody& body);

/// JSON: Fossen's matrices in SNAME's body axes, origin at that of F.
ExportedBody makeFossen(const HandedBody& body);

/// Returns the format with a name. @throws std::invalid_argument in one line, if there is none.
ExportFormat exportFormatOf(const std::string& name);

/// Converts a fluid body to the format of another program; docs/file_format.md has frames, units
/// and what each format loses. The same body and settings give the same bytes.
/// @throws std::invalid_argument in one line that names the fluid body, the value and the limit, if
/// a number is not physical, or a draught is asked for of a body without parts of its added mass.
ExportedBody exportFluidBody(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                             const ExportSettings& settings);

/// Computes the semi-axes [m] of the ellipsoid with given added masses against translation along
/// its axes, per unit density [m^3]. Any three positive added masses belong to exactly one
/// ellipsoid. One below 1e-5 of the largest, as of a sheet, is raised to that.
Vector3 semiAxesOf(const Vector3& added_mass);

/// Ellipsoid whose added mass approximates a given one.
struct EllipsoidFit {
  Vector3 semi_axes{0, 0, 0};          ///< [m]
  Vector3 centre{0, 0, 0};             ///< [m]
  Matrix3 axes = Matrix3::Identity();  ///< axes of the ellipsoid, as columns
};

/// Fits an ellipsoid to an added mass per unit density. Axes and sizes follow from the translation
/// block. The centre is where rotation and translation couple least (sum of squares); where that
/// leaves a choice, as for sheets, nearest to `middle` [m].
EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle);

/// MuJoCo's coefficients of quadratic drag, the first three of fluidcoef. Its drag at a speed v
/// along an axis k of an ellipsoid and its torque at w about it are
///
///   rho v^2 (blunt A_k + slender (A_max - A_k)),  rho w^2 (angular I_k + slender (I_max - I_k))
///
/// with the silhouette A_k along the axis and I_k = 8/15 pi a_k max(a_i, a_j)^4.
struct EllipsoidDrag {
  double blunt = 0.5, slender = 0.25, angular = 1.5;  ///< defaults: MuJoCo's
};

/// Computes MuJoCo's drag at 1 m/s along the axes of the ellipsoid [N] and its torque at 1 rad/s
/// about them [N m], in a fluid of density 1 kg/m^3; rotation first.
Vector6 unitDrag(const EllipsoidDrag& drag, const Vector3& semi_axes);

/// Computes the same of a body by the form law without friction, averaged over both directions.
Vector6 unitDrag(const HandedBody& body, const EllipsoidFit& fit);

/// Fits coefficients >= 0 to such drags: least squares of the differences, each relative to its
/// drag or to 1 % of the largest.
EllipsoidDrag fitDrag(const Vector6& unit_drag, const Vector3& semi_axes);

}  // namespace ambient
