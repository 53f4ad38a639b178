#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Geometric properties of a mesh, in the mesh's frame.
struct MeshProperties {
  double volume = 0;  ///< volume inside a closed mesh [m^3]; 0 for a sheet
  double area = 0;    ///< area of all triangles, each counted once [m^2]
  /// Uniform density inside, per unit mass; its centre is the centre of volume. For a sheet:
  /// uniform mass per area.
  MassDistribution uniform;
  /// Uniform mass per area, per unit mass: a thin shell.
  MassDistribution surface;
};

/// Exact integrals over the polyhedron that a closed mesh bounds: signed tetrahedra on its faces.
/// Integrals are computed about the mesh itself, so that a far origin costs no further digits.
/// Centres that equal the origin or the middle of the bounding box up to rounding, and products of
/// inertia that are zero up to rounding, are set to these values. Mirtich, "Fast and accurate
/// computation of polyhedral mass properties", 1996, treats the same integrals by projection. Cost
/// O(T).
/// @pre the mesh is closed, outward oriented and encloses a volume (checkMesh()).
MeshProperties computeMassProperties(const TriangleMesh& mesh);

/// Computes the properties of an open sheet of zero thickness: exact integrals over its area. Cost
/// O(T). Centres and moments are not finite if the area is 0, as it is by underflow on a sheet that
/// requireUsualSize() refuses.
MeshProperties computeSheetMassProperties(const TriangleMesh& mesh);

/// Computes the properties of a closed mesh or, if `sheet`, of an open sheet.
inline MeshProperties computeMassProperties(const TriangleMesh& mesh, bool sheet) {
  return sheet ? computeSheetMassProperties(mesh) : computeMassProperties(mesh);
}
/// Sum of the volumes inside closed meshes [m^3]; what two of them share counts twice.
double sumOfVolumes(const std::vector<TriangleMesh>& meshes);

/// Scales a closed mesh about its centre of volume, to a volume [m^3].
TriangleMesh withVolume(TriangleMesh mesh, double volume);

/// Smallest and largest size of a mesh [m]. Far beyond them, areas, volumes and moments leave the
/// range of a double.
constexpr double kSmallestSize = 1e-9, kLargestSize = 1e9;

/// Volume over area^1.5 below which a surface encloses nothing; a square plate reaches it at a
/// thickness of 3e-6 of its side, where single-precision coordinates end. A sphere has 0.094.
constexpr double kLeastVolume = 1e-6;

/// Checks that a mesh is neither tiny nor huge, and wide and thick enough for its triangles to have
/// normals. Returns its properties. Cost O(T).
/// @throws std::runtime_error in one line that begins with `source`, if its diagonal is not
/// kSmallestSize to kLargestSize, its area over the diagonal's square is below 1e-12 or, unless it
/// is a sheet, its volume over its area^1.5 below kLeastVolume.
MeshProperties requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source);

/// Text of extents [m]: "1 x 2 x 3 m".
std::string extentsText(const Eigen::Vector3d& extents);

/// Returns one line that begins with `source` if the longest extent is above 500 m or below 1 mm,
/// as of a mesh in millimetres; else empty. `is_scaled`: the user has chosen a factor, and knows of
/// large sizes.
std::string unlikelySizeWarning(const TriangleMesh& mesh, bool is_scaled,
                                const std::string& source);

}  // namespace ambient
