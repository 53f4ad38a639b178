#include "preprocess/mesh/defects/mesh_orientation.h"

#include <sstream>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/mesh_defect.h"

namespace ambient {
namespace {

struct Neighbour {
  int triangle = -1;
  bool same_sense = false;  // both run along the shared edge in the same direction: one is wrong
};

std::vector<std::vector<Neighbour>> neighboursOf(const TriangleMesh& mesh, const MeshEdges& edges) {
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangleCount());
  for (const auto& [p, q] : edgePairs(edges)) {
    neighbours[p.triangle].push_back({q.triangle, p.forward == q.forward});
    neighbours[q.triangle].push_back({p.triangle, p.forward == q.forward});
  }
  return neighbours;
}

/// Finds the triangles of one component that must be reversed to agree with its first triangle.
class TurnSearch {
 public:
  TurnSearch(const TriangleMesh& mesh, const MeshEdges& edges)
      : mesh_(mesh), neighbours_(neighboursOf(mesh, edges)) {
    turned_.assign(neighbours_.size(), kUnknown);
  }

  /// The smaller half of the component of `start`, empty if it was visited before.
  std::vector<int> minorityOf(int start) {
    if (turned_[start] != kUnknown) return {};
    std::vector<int> kept, turned, open{start};
    turned_[start] = 0;
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      (turned_[t] == 1 ? turned : kept).push_back(t);
      for (const Neighbour& neighbour : neighbours_[t]) visit(t, neighbour, open);
    }
    return turned.size() <= kept.size() ? turned : kept;
  }

  /// The surface of a component that was visited is one-sided; empty: none is.
  const std::vector<MeshDefect>& defects() const { return defects_; }

 private:
  static constexpr int kUnknown = -1;

  void visit(int from, const Neighbour& neighbour, std::vector<int>& open) {
    const int wanted = turned_[from] ^ static_cast<int>(neighbour.same_sense);
    int& turned = turned_[neighbour.triangle];
    if (turned == kUnknown) {
      turned = wanted;
      open.push_back(neighbour.triangle);
    } else if (turned != wanted && defects_.empty()) {
      defects_.push_back(
          {"one-sided",
           defectText("the surface is one-sided, as a Moebius strip is, near triangle ", from,
                      " at ", pointText(mesh_.corner(from, 0))),
           {from, neighbour.triangle}});
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<int> turned_;
  std::vector<MeshDefect> defects_;
};

}  // namespace

std::string pointText(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(9);
  text << "(" << point.x() << ", " << point.y() << ", " << point.z() << ")";
  return text.str();
}

void turnRound(TriangleMesh& mesh, Eigen::Index triangle) {
  std::swap(mesh.triangles(1, triangle), mesh.triangles(2, triangle));
}

CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name) {
  AMBIENT_ASSERT(isManifold(edges));
  CheckedMesh result{mesh, {}};
  TurnSearch search(mesh, edges);
  std::size_t turned = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    for (const int wrong : search.minorityOf(t)) {
      turnRound(result.mesh, wrong);
      ++turned;
    }
  }
  if (!search.defects().empty()) return {mesh, {}, {}, search.defects()};
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to agree with their neighbours";
    result.warnings.push_back(warning.str());
  }
  return result;
}

}  // namespace ambient
