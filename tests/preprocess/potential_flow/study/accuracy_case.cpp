#include "tests/preprocess/potential_flow/study/accuracy_case.h"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/potential_flow/surface/flat_merging.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient::study {
namespace {

double largestOf(const Matrix6& K, int row, int column) {
  return K.block<3, 3>(row, column).cwiseAbs().maxCoeff();
}

/// Largest entry of the rotation block. Spheres have 0 there: inertia of a solid sphere of fluid
/// instead.
double rotationScale(const Matrix6& exact) {
  const double largest = largestOf(exact, 0, 0);
  if (largest > 0) return largest;
  const double volume = 2 * largestOf(exact, 3, 3);
  const double radius = std::cbrt(3 * volume / (4 * std::acos(-1.0)));
  return 0.4 * volume * radius * radius;
}

bool isZero(Symmetry symmetry, int row, int column) {
  const bool diagonal = row == column, block_diagonal = row % 3 == column % 3;
  const bool across = row / 3 != column / 3 && row % 3 != column % 3 && row % 3 != 2;
  switch (symmetry) {
    case Symmetry::kThreeMirrors:
      return !diagonal;
    case Symmetry::kTwoMirrors:
      return !diagonal && !(across && column % 3 != 2);
    case Symmetry::kThreeTurns:
      return !block_diagonal;
    default:
      return !diagonal || (row != 0 && row != 1 && row != 5);
  }
}

}  // namespace

double wantedError(Target target) {
  switch (target) {
    case Target::kSmooth:
      return 0.005;
    case Target::kSharp:
      return 0.01;
    default:
      return 0.002;
  }
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Matrix6 builtAddedMass(const TriangleMesh& mesh, bool sheet, int max_panels, int threads) {
  BuildSettings settings;
  settings.origin = Vector3(0, 0, 0);
  settings.flow.sheet = sheet;
  settings.flow.max_panels = max_panels;
  settings.flow.threads = threads;
  if (max_panels == 0) settings.flow.solver = FlowSolverKind::Dense;
  return makeFluidBody(mesh, settings).added_mass;
}

AccuracyRow compareAddedMass(const Matrix6& K, const Reference& reference, Symmetry symmetry) {
  const Matrix6& exact = reference.added_mass;
  const Matrix6 error = K - exact;
  const double rotation = rotationScale(exact), translation = largestOf(exact, 3, 3);
  const double mixed = std::sqrt(rotation * translation);
  AccuracyRow row;
  row.rotation = largestOf(error, 0, 0) / rotation;
  row.translation = largestOf(error, 3, 3) / translation;
  row.coupling = largestOf(error, 0, 3) / mixed;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double scale = i / 3 != j / 3 ? mixed : (i < 3 ? rotation : translation);
      if (isZero(symmetry, i, j))
        row.should_be_zero = std::max(row.should_be_zero, std::abs(K(i, j)) / scale);
    }
  return row;
}

AccuracyRow measureAccuracy(const AccuracyCase& one, const Reference& reference) {
  const double begin = processorSeconds();
  const Matrix6 K = builtAddedMass(one.mesh, one.sheet(), kDefaultPanels);
  const double seconds = processorSeconds() - begin;
  AccuracyRow row = compareAddedMass(K, reference, one.symmetry);
  const TriangleMesh basis = mergeFlatTriangles(one.mesh, one.sheet(), kDefaultPanels);
  row.panels = refineSurface(basis, one.sheet(), kDefaultPanels).triangleCount();
  row.processor_seconds = seconds;
  return row;
}

Reference extrapolate(const TriangleMesh& coarse, const TriangleMesh& fine, bool sheet,
                      double order) {
  const Matrix6 K_coarse = builtAddedMass(coarse, sheet, 0);
  const Matrix6 K_fine = builtAddedMass(fine, sheet, 0);
  const double ratio =
      static_cast<double>(fine.triangleCount()) / static_cast<double>(coarse.triangleCount());
  Reference reference;
  reference.added_mass = K_fine + (K_fine - K_coarse) / (std::pow(ratio, order / 2) - 1);
  const AccuracyRow correction = compareAddedMass(K_fine, reference, Symmetry::kThreeMirrors);
  reference.correction = std::max(correction.rotation, correction.translation);
  return reference;
}

}  // namespace ambient::study
