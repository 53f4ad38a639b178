#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// Reference of added mass per unit density, about the mesh's origin.
struct Reference {
  Matrix6 added_mass = Matrix6::Zero();
  /// Distance from the finest mesh to the extrapolated value over the largest entry of the block;
  /// the larger one of rotation and translation. 0: closed form or published value.
  double correction = 0;
};

/// Entries that vanish by symmetry of the body, though not of its mesh.
enum class Symmetry {
  kThreeMirrors,  ///< all off the diagonal
  kTwoMirrors,    ///< x -> -x, y -> -y: all but the diagonal, (w_x, v_y) and (w_y, v_x)
  kThreeTurns,    ///< half turns about x, y, z: all but the diagonals of the four blocks
  kFlatSheet      ///< all but w_x, w_y, v_z
};

/// Class of shape, with a required accuracy.
enum class Target { kSmooth, kSharp, kSheet };
double wantedError(Target target);

/// One row of the table.
struct AccuracyCase {
  std::string shape;
  Target target = Target::kSmooth;
  Symmetry symmetry = Symmetry::kThreeMirrors;
  TriangleMesh mesh;  ///< user's mesh
  std::function<Reference()> reference;

  bool sheet() const { return target == Target::kSheet; }
};

/// Errors over the largest entry of the block. Rotation of a sphere: over the inertia of a solid
/// sphere of fluid. Coupling: over the geometric mean of the largest entries of rotation and
/// translation.
struct AccuracyRow {
  Eigen::Index panels = 0;
  double rotation = 0, translation = 0, coupling = 0;
  double should_be_zero = 0;     ///< largest entry that vanishes by symmetry, same scale
  double processor_seconds = 0;  ///< one build, sum of all threads
};

/// Added mass about the mesh's origin by makeFluidBody(). 0 panels: the dense solver with a panel
/// for each triangle.
Matrix6 builtAddedMass(const TriangleMesh& mesh, bool sheet, int max_panels, int threads = 0);

/// Builds the case at default settings.
AccuracyRow measureAccuracy(const AccuracyCase& one, const Reference& reference);

/// Errors of rotation, translation and coupling alone.
AccuracyRow compareAddedMass(const Matrix6& K, const Reference& reference, Symmetry symmetry);

/// Limit of two meshes with triangles as panels, for an error of order `order` in the panel
/// size.
Reference extrapolate(const TriangleMesh& coarse, const TriangleMesh& fine, bool sheet,
                      double order);

/// Processor time of this program [s].
double processorSeconds();

}  // namespace ambient::study
