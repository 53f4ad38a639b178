#include "preprocess/potential_flow/surface/flat_merging.h"

#include "preprocess/mesh/triangle_quality.h"
#include "preprocess/potential_flow/surface/edge_cuts.h"
#include "preprocess/potential_flow/surface/editable_mesh.h"
#include "preprocess/potential_flow/surface/face_bulges.h"

namespace ambient {
namespace {

constexpr double kFlat = 1e-7;    // of the size; more than the rounding of single precision
constexpr double kSkinny = 50;    // longest edge over height; graded meshes stay below
constexpr int kLeastPanels = 20;  // per large triangle, to resolve its edges

EditableMesh merged(const TriangleMesh& mesh, double highest_shape) {
  EditableMesh result(mesh, kFlat * mesh.extents().norm());
  result.flipFlatEdges();
  while (result.contractFlatVertices(highest_shape) > 0) result.flipFlatEdges();
  return result;
}

}  // namespace

TriangleMesh mergeFlatTriangles(const TriangleMesh& mesh, bool sheet, int max_panels) {
  if (max_panels <= 0 || mesh.triangleCount() == 0) return mesh;
  if (!sheet && !estimateBulges(mesh).empty()) return mesh;
  const EditableMesh large = merged(mesh, 1);
  // Round parts keep the grading that they came with.
  if (!large.hasSmoothBends(kSharpCosine)) {
    TriangleMesh result = large.mesh();
    if (kLeastPanels * result.triangleCount() <= max_panels) return result;
  }
  const bool skinny = findWorstTriangles(mesh, 1).front().aspect > kSkinny;
  return skinny ? merged(mesh, 1 / kSkinny).mesh() : mesh;
}

TriangleMesh mergePolyhedronSides(const TriangleMesh& mesh) { return merged(mesh, 1).mesh(); }

}  // namespace ambient
