#pragma once

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

}  // namespace ambient
