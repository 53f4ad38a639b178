#include "preprocess/potential_flow/surface/edge_cuts.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

class Cutter {
 public:
  Cutter(const DividedSurface& surface, const MeshEdges& edges, const std::vector<bool>& marks)
      : surface_(surface),
        mesh_(surface.mesh),
        middle_(surface.mesh.triangleCount(), {-1, -1, -1}) {
    for (Index v = 0; v < mesh_.vertexCount(); ++v) vertices_.push_back(mesh_.vertices.col(v));
    for (std::size_t e = 0; e < marks.size(); ++e) {
      if (!marks[e]) continue;
      const EdgeGroup& group = edges.edges[e];
      for (std::size_t k = group.first; k < group.last; ++k)
        middle_[edges.half_edges[k].triangle][edges.half_edges[k].side] =
            static_cast<int>(vertices_.size());
      const HalfEdge& side = edges.half_edges[group.first];
      vertices_.push_back((mesh_.vertices.col(side.low) + mesh_.vertices.col(side.high)) / 2);
    }
  }

  DividedSurface cut() {
    DividedSurface result;
    for (Index t = 0; t < mesh_.triangleCount(); ++t) {
      cutTriangle(t);
      result.face.resize(triangles_.size(), surface_.face[t]);
    }
    TriangleMesh& mesh = result.mesh;
    mesh.vertices.resize(3, static_cast<Index>(vertices_.size()));
    mesh.triangles.resize(3, static_cast<Index>(triangles_.size()));
    for (std::size_t v = 0; v < vertices_.size(); ++v) mesh.vertices.col(v) = vertices_[v];
    for (std::size_t t = 0; t < triangles_.size(); ++t) mesh.triangles.col(t) = triangles_[t];
    return result;
  }

 private:
  void cutTriangle(Index t) {
    const std::array<int, 3>& middle = middle_[t];
    const auto cuts = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
    // Turn the triangle so that side 0 is the only cut one, or the only whole one.
    int turn = 0;
    while (cuts % 3 != 0 && (middle[turn] >= 0) != (cuts == 1)) ++turn;
    const int a = mesh_.triangles(turn, t), b = mesh_.triangles((turn + 1) % 3, t),
              c = mesh_.triangles((turn + 2) % 3, t);
    const int ab = middle[turn], bc = middle[(turn + 1) % 3], ca = middle[(turn + 2) % 3];
    switch (cuts) {
      case 0:
        add(a, b, c);
        break;
      case 1:
        add(a, ab, c);
        add(ab, b, c);
        break;
      case 2:
        add(ca, bc, c);
        addQuadrilateral(a, b, bc, ca);
        break;
      default:
        add(a, ab, ca);
        add(ab, b, bc);
        add(ca, bc, c);
        add(ab, bc, ca);
    }
  }

  void add(int a, int b, int c) { triangles_.emplace_back(a, b, c); }

  /// Along the shorter diagonal; among equal ones the choice follows the vertex numbers.
  void addQuadrilateral(int a, int b, int c, int d) {
    constexpr double kClearlyShorter = 0.99;
    const double ac = (vertices_[a] - vertices_[c]).norm();
    const double bd = (vertices_[b] - vertices_[d]).norm();
    const bool along_ac = ac < kClearlyShorter * bd || (!(bd < kClearlyShorter * ac) && a < b);
    if (along_ac) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(a, b, d);
      add(b, c, d);
    }
  }

  const DividedSurface& surface_;
  const TriangleMesh& mesh_;
  std::vector<std::array<int, 3>> middle_;  ///< per triangle and side: the vertex that cuts it
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

Vector3d normalOf(const TriangleMesh& mesh, Index t) { return mesh.twiceArea(t).normalized(); }

DividedSurface undivided(const TriangleMesh& mesh) {
  DividedSurface surface{mesh, std::vector<int>(mesh.triangleCount())};
  std::iota(surface.face.begin(), surface.face.end(), 0);
  return surface;
}

DividedSurface cutEdges(const DividedSurface& surface, const MeshEdges& edges,
                        const std::vector<bool>& marks) {
  return Cutter(surface, edges, marks).cut();
}

}  // namespace ambient
