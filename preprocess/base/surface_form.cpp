#include "preprocess/base/surface_form.h"

#include "preprocess/base/surface_triangles.h"

namespace ambient {
namespace {

/// Returns the triangles of SurfaceForm::hull: flat sides become fans if this needs fewer
/// triangles.
std::vector<std::int32_t> hullOf(const Surface& surface) {
  const SurfaceTriangles mesh(surface);
  std::vector<std::int32_t> hull;
  std::vector<bool> is_replaced(static_cast<std::size_t>(mesh.size()));
  const auto add = [&](int a, int b, int c) {
    for (const int vertex : {a, b, c}) hull.push_back(mesh.source(vertex));
  };
  for (const FlatSide& side : findFlatSides(mesh)) {
    const std::vector<int>& c = side.corners;
    if (c.size() >= side.triangles.size() + 2) continue;
    for (std::size_t i = 2; i < c.size(); ++i) add(c[0], c[i - 1], c[i]);
    for (const int t : side.triangles) is_replaced[static_cast<std::size_t>(t)] = true;
  }
  for (int t = 0; t < mesh.size(); ++t)
    if (!is_replaced[static_cast<std::size_t>(t)])
      add(mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2));
  hull.shrink_to_fit();
  return hull;
}

}  // namespace

void makeSurfaceForm(FluidBody& body) {
  body.form = {};
  if (body.sphere_radius > 0) return;
  body.form.shape = formShapeOf(body);
  const FaceTable faces = formLawFaces(body, body.form.shape);
  body.form.faces = faces;  // a copy has no room to spare
  body.form.hull = hullOf(body.surface);
}

}  // namespace ambient
