#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {

/// Added mass per unit density about the mesh's origin, to compare with.
struct Reference {
  Matrix6 added_mass = Matrix6::Zero();
  /// How far the extrapolation went from the finest mesh, over the largest entry of the block, the
  /// larger of rotation and translation; 0: closed form or published value.
  double correction = 0;
};

/// Which entries vanish by the symmetry of the body, not of its mesh.
enum class Symmetry {
  kThreeMirrors,  ///< all off the diagonal
  kTwoMirrors,    ///< x -> -x, y -> -y: all but the diagonal, (w_x, v_y) and (w_y, v_x)
  kThreeTurns,    ///< half turns about x, y, z: all but the diagonals of the four blocks
  kFlatSheet      ///< all but w_x, w_y, v_z
};

/// What the accuracy is wanted to be.
enum class Target { kSmooth, kSharp, kSheet };
double wantedError(Target target);

/// One row of the table.
struct AccuracyCase {
  std::string shape;
  Target target = Target::kSmooth;
  Symmetry symmetry = Symmetry::kThreeMirrors;
  TriangleMesh mesh;  ///< the user's
  std::function<Reference()> reference;

  bool sheet() const { return target == Target::kSheet; }
};

/// Errors over the largest entry of the block, in rotation of a sphere over the inertia of a solid
/// sphere of the fluid; of the coupling over the root of the product of the
/// two largest entries of rotation and translation.
struct AccuracyRow {
  Eigen::Index panels = 0;
  double rotation = 0, translation = 0, coupling = 0;
  double should_be_zero = 0;     ///< largest entry that vanishes by symmetry, over the same
  double processor_seconds = 0;  ///< of one build, all threads together
};

/// The added mass about the mesh's origin as makeFluidBody() computes it; with 0 panels, every
/// triangle is one, by the dense solver.
Matrix6 builtAddedMass(const TriangleMesh& mesh, bool sheet, int max_panels, int threads = 0);

/// Builds the case at default settings.
AccuracyRow measureAccuracy(const AccuracyCase& one, const Reference& reference);

/// Errors of rotation, translation and coupling alone.
AccuracyRow compareAddedMass(const Matrix6& K, const Reference& reference, Symmetry symmetry);

/// Limit of two meshes whose triangles are panels, for an error of that order in the size of the
/// panels.
Reference extrapolate(const TriangleMesh& coarse, const TriangleMesh& fine, bool sheet,
                      double order);

/// Processor time of this program [s].
double processorSeconds();

}  // namespace ambient::study
