#include "preprocess/potential_flow/results/vertex_projection.h"

#include <Eigen/SparseCholesky>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

Eigen::Matrix<double, Eigen::Dynamic, 6> projectOnVertices(const PanelSurface& surface,
                                                           const PanelMoments& moments) {
  const Eigen::Index vertices = surface.vertexCount();
  AMBIENT_ASSERT(static_cast<Eigen::Index>(moments.size()) == surface.panelCount());
  Eigen::Matrix<double, Eigen::Dynamic, 6> load(vertices, 6);
  load.setZero();
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index t = 0; t < surface.panelCount(); ++t)
    for (int a = 0; a < 3; ++a) {
      const int i = surface.triangles(a, t);
      load.row(i) += moments[t].row(a);
      for (int b = 0; b < 3; ++b)
        entries.emplace_back(i, surface.triangles(b, t),
                             surface.panels[t].area * (a == b ? 2 : 1) / 12);
    }
  for (Eigen::Index v = 0; v < vertices; ++v)
    if (surface.component[v] < 0) entries.emplace_back(v, v, 1);
  Eigen::SparseMatrix<double> mass(vertices, vertices);
  mass.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(mass).solve(load);
}

}  // namespace ambient
