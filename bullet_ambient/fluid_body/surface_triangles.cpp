#include "bullet_ambient/fluid_body/surface_triangles.h"

#include <map>

namespace ambient {

SurfaceTriangles::SurfaceTriangles(const FluidBody& body) {
  const Surface& surface = body.surface;
  const std::size_t count = surface.triangles.size() / 3;
  const std::size_t faces = body.faces.size();
  if (faces != count && faces != 2 * count)
    reject(body, "number of its faces", static_cast<double>(faces),
           "that of the triangles of its surface, or twice that of a sheet's, for the form law");
  is_sheet_ = count > 0 && faces == 2 * count;
  std::map<std::array<double, 3>, int> seen;
  const auto weld = [&](std::size_t at) {
    const double* p = &surface.vertices[3 * at];
    const auto [entry, is_new] = seen.insert({{p[0], p[1], p[2]}, vertexCount()});
    if (is_new) places_.emplace_back(p[0], p[1], p[2]);
    return entry->second;
  };
  const auto corner = [&](std::size_t i) {
    return weld(static_cast<std::size_t>(surface.triangles[i]));
  };
  for (std::size_t t = 0; t < count; ++t) {
    corners_.push_back({corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)});
    normals_.push_back(body.faces.normal(t));
  }
}

}  // namespace ambient
