#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/added_mass_part.h"
#include "bullet_ambient/fluid_body/load_level.h"
#include "bullet_ambient/fluid_body/waterline_table.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// The faces that carry the fluid loads, as a structure of arrays over F faces.
/// Frame: fluid body frame F. The slip matrix of the paper's appendix (3F x 6) is U_i = -(I - n
/// n^T) [-[c]x, I] and is therefore held exactly by normals and centroids; computeSlipMatrix()
/// spells it out.
struct FaceTable {
  std::vector<double> normal_x, normal_y, normal_z;        ///< unit normals into the fluid
  std::vector<double> centroid_x, centroid_y, centroid_z;  ///< barycentres [m]
  std::vector<double> area;                                ///< [m^2]
  /// From round (0) to flat or edged (1), more on long flat sides; docs/theory.md eq. (45). In
  /// [0, 2]; empty: not known.
  std::vector<double> sharpness;

  std::size_t size() const { return area.size(); }
  /// All of them in that order, but for the sharpness, which follows from the surface.
  std::array<const std::vector<double>*, 7> columns() const {
    return {&normal_x, &normal_y, &normal_z, &centroid_x, &centroid_y, &centroid_z, &area};
  }
  Vector3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
  Vector3 centroid(std::size_t i) const { return {centroid_x[i], centroid_y[i], centroid_z[i]}; }
  void reserve(std::size_t faces);
  void add(const Vector3& normal, const Vector3& centroid, double area);
};

/// Fewer faces that stand in for all of them by the form law.
struct FormLevel {
  FaceTable faces;  ///< with sharpness
  double p99_error =
      0;  ///< exceeded by one motion in a hundred, relative to 1/2 rho sum A_i |u_i|^2
};

/// Where the mass sits, for a body of mass 1 kg: centre [m] in F and inertia about it [m^2], in F's
/// axes.
struct MassDistribution {
  Vector3 centre{0, 0, 0};
  Matrix3 inertia = Matrix3::Zero();
};

/// Where a fluid body came from.
struct Provenance {
  std::string source;             ///< file name or shape description, without directories
  std::uint64_t source_hash = 0;  ///< FNV-1a of the source's bytes
  std::string settings;           ///< solver settings, as text
  std::string generator;          ///< program and version that made it
};

/// The triangles of the shape in F, for drawing and inspection only.
struct Surface {
  std::vector<double> vertices;  ///< x, y, z per vertex [m]
  std::vector<std::int32_t>
      triangles;  ///< three vertex indices per triangle, counter-clockwise from the fluid
};

/// What the fluid needs to know of one shape: plain data, per unit fluid density, independent of
/// any body. Frame F: origin chosen when built (default: centre of volume), axes of the source
/// mesh.
struct FluidBody {
  std::string name;
  Provenance provenance;
  Matrix6 added_mass =
      Matrix6::Zero();   ///< K_fluid / rho about F's origin, symmetric positive semi-definite
  double asymmetry = 0;  ///< largest |K - K^T| before symmetrising, over the largest |K| [1]
  double volume = 0;     ///< displaced volume [m^3]; 0 for a sheet
  double area = 0;       ///< wetted area [m^2]
  Vector3 centre_of_volume{0, 0, 0};  ///< in F [m]
  Vector3 origin{0, 0, 0};            ///< F's origin in the source mesh's frame [m]
  MassDistribution uniform_mass;      ///< uniform density inside
  MassDistribution surface_mass;      ///< uniform mass per area, at face barycentres
  FaceTable faces;
  Surface surface;
  std::vector<LoadLevel> levels;       ///< of reduced loads by the published law; may be empty
  std::vector<FormLevel> form_levels;  ///< the same by the form law
  /// Of a body that is a sphere about its centre of volume [m]: its loads are those of the smooth
  /// sphere, and faces and levels are not evaluated. 0: any other shape.
  double sphere_radius = 0;
  /// Measured drag coefficients along the axes of F, on the frontal areas, that the form law is
  /// scaled to; 0: none, and then all are.
  Vector3 drag{0, 0, 0};
  /// Of patches all over the surface, for bodies that the surface of the water cuts. Their sum is
  /// the added mass to the error of its discretisation; empty: not known.
  std::vector<AddedMassPart> added_mass_parts;
  /// What those parts lack at the surface of the water; may be empty.
  WaterlineTable waterline;
};

/// Slip matrix U (3F x 6) of docs/theory.md eq. (12): U x is the slip velocity of fully attached
/// flow at every face, stacked, for the relative twist x in F. Padilla et al. 2025, appendix A.2.
Eigen::Matrix<double, Eigen::Dynamic, 6> computeSlipMatrix(const FaceTable& faces);

/// Sizes of the bounding box of the body's surface along the axes of F [m]; 0 without a surface.
Vector3 extentsOf(const FluidBody& body);

/// The same shape, `factor` times as large about F's origin: lengths s, areas s^2, volumes s^3,
/// added mass s^3 to s^5 as scaleShape(). The provenance stays; its settings tell the factor.
/// @throws std::invalid_argument if the factor is not positive and finite.
FluidBody scaled(const FluidBody& body, double factor);

/// @throws std::invalid_argument: one line that names the fluid body, the value and the limit.
[[noreturn]] void reject(const FluidBody& body, const std::string& what, double value,
                         const char* limit);

}  // namespace ambient
