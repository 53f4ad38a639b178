#include "bullet_ambient/fluid_body/surface_triangles.h"

#include <Eigen/Geometry>
#include <map>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

SurfaceTriangles::SurfaceTriangles(const FluidBody& body) {
  const std::size_t count = body.surface.triangles.size() / 3;
  const std::size_t faces = body.faces.size();
  if (faces != count && faces != 2 * count)
    reject(body, "number of its faces", static_cast<double>(faces),
           "that of the triangles of its surface, or twice that of a sheet's, for the form law");
  is_sheet_ = count > 0 && faces == 2 * count;
  weld(body.surface);
  for (std::size_t t = 0; t < count; ++t) normals_.push_back(body.faces.normal(t));
}

SurfaceTriangles::SurfaceTriangles(const Surface& surface) {
  weld(surface);
  for (int t = 0; t < size(); ++t) {
    const auto corner = [&](int i) { return place(vertex(t, i)); };
    normals_.push_back((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized());
  }
}

void SurfaceTriangles::weld(const Surface& surface) {
  AMBIENT_ASSERT(surface.triangles.size() % 3 == 0 && surface.vertices.size() % 3 == 0);
  constexpr int kUnknown = -1;
  std::map<std::array<double, 3>, int> seen;
  std::vector<int> numbers(surface.vertices.size() / 3, kUnknown);
  const auto corner = [&](std::size_t i) {
    const auto vertex = static_cast<std::size_t>(surface.triangles[i]);
    AMBIENT_ASSERT(surface.triangles[i] >= 0 && vertex < numbers.size());
    if (numbers[vertex] != kUnknown) return numbers[vertex];
    const double* p = &surface.vertices[3 * vertex];
    const auto [entry, is_new] = seen.insert({{p[0], p[1], p[2]}, vertexCount()});
    if (is_new) places_.emplace_back(p[0], p[1], p[2]);
    return numbers[vertex] = entry->second;
  };
  corners_.reserve(surface.triangles.size() / 3);
  for (std::size_t t = 0; t < surface.triangles.size() / 3; ++t)
    corners_.push_back({corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)});
}

}  // namespace ambient
