#include "preprocess/mesh/mesh_orientation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/winding_number.h"

namespace ambient {
namespace {

constexpr double kFullSphere = 4 * 3.14159265358979323846;

// Volume over area^1.5 below which a surface encloses nothing; a square plate reaches it at a
// thickness of 3e-6 of its side, where single-precision coordinates end. A sphere has 0.094.
constexpr double kLeastVolume = 1e-6;

std::string pointText(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(9);
  text << "(" << point.x() << ", " << point.y() << ", " << point.z() << ")";
  return text.str();
}

void turnRound(TriangleMesh& mesh, Eigen::Index triangle) {
  std::swap(mesh.triangles(1, triangle), mesh.triangles(2, triangle));
}

struct Neighbour {
  int triangle = -1;
  bool same_sense = false;  // both run along the shared edge in the same direction: one is wrong
};

std::vector<std::vector<Neighbour>> neighboursOf(const TriangleMesh& mesh, const MeshEdges& edges) {
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangleCount());
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() != 2) continue;
    const HalfEdge& p = edges.half_edges[edge.first];
    const HalfEdge& q = edges.half_edges[edge.first + 1];
    neighbours[p.triangle].push_back({q.triangle, p.forward == q.forward});
    neighbours[q.triangle].push_back({p.triangle, p.forward == q.forward});
  }
  return neighbours;
}

/// Which triangles of one component must be turned round to agree with its first one.
class TurnSearch {
 public:
  TurnSearch(const TriangleMesh& mesh, const MeshEdges& edges, std::string name)
      : mesh_(mesh), neighbours_(neighboursOf(mesh, edges)), name_(std::move(name)) {
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

 private:
  static constexpr int kUnknown = -1;

  void visit(int from, const Neighbour& neighbour, std::vector<int>& open) {
    const int wanted = turned_[from] ^ static_cast<int>(neighbour.same_sense);
    int& turned = turned_[neighbour.triangle];
    if (turned == kUnknown) {
      turned = wanted;
      open.push_back(neighbour.triangle);
    } else if (turned != wanted) {
      raiseInputError(name_, "the surface is one-sided, as a Moebius strip is, near triangle ",
                      from, " at ", pointText(mesh_.corner(from, 0)));
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::string name_;
  std::vector<int> turned_;
};

/// One closed surface among those that make up a mesh.
struct Shell {
  std::vector<int> triangles;
  double volume = 0;  // signed
  double area = 0;
  Eigen::AlignedBox3d bounds;
  int depth = 0;  // number of other shells around it
};

void measure(const TriangleMesh& mesh, Shell& shell) {
  for (const int t : shell.triangles) {
    for (int k = 0; k < 3; ++k) shell.bounds.extend(mesh.corner(t, k));
  }
  const Eigen::Vector3d middle = shell.bounds.center();
  for (const int t : shell.triangles) {
    const Eigen::Vector3d a = mesh.corner(t, 0) - middle, b = mesh.corner(t, 1) - middle,
                          c = mesh.corner(t, 2) - middle;
    shell.volume += a.dot(b.cross(c)) / 6;
    shell.area += (b - a).cross(c - a).norm() / 2;
  }
}

Eigen::Vector3d barycentre(const TriangleMesh& mesh, int t) {
  return (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
}

// Parts that only cross each other are left to requireSimpleSurface().
bool surrounds(const TriangleMesh& mesh, const Shell& outer, const Shell& inner) {
  if (!outer.bounds.contains(inner.bounds)) return false;
  const Eigen::Vector3d point = barycentre(mesh, inner.triangles.front());
  double angle = 0;
  for (const int t : outer.triangles) angle += solidAngle(mesh, t, point);
  return std::abs(angle) > kFullSphere / 2;
}

std::vector<Shell> findShells(const TriangleMesh& mesh, const MeshEdges& edges) {
  const MeshComponents components = computeMeshComponents(mesh, edges);
  std::vector<Shell> shells(components.count);
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    shells[components.component_of[t]].triangles.push_back(t);
  }
  for (Shell& shell : shells) measure(mesh, shell);
  for (Shell& shell : shells) {
    for (const Shell& other : shells) {
      shell.depth += static_cast<int>(&other != &shell && surrounds(mesh, other, shell));
    }
  }
  return shells;
}

void requireVolume(const TriangleMesh& mesh, const Shell& shell, const std::string& name) {
  const double ratio = std::abs(shell.volume) / std::pow(shell.area, 1.5);
  if (ratio >= kLeastVolume) return;
  raiseInputError(name, "the surface around triangle ", shell.triangles.front(), " at ",
                  pointText(mesh.corner(shell.triangles.front(), 0)),
                  " encloses no volume: volume / area^1.5 = ", ratio, ", at least ", kLeastVolume,
                  " needed (an open surface of zero thickness is a sheet)");
}

// Turns shells that point the wrong way; returns how many triangles that were. A nested shell that
// points outwards is refused: whether it is superfluous or a cavity only the user can know.
std::size_t turnShells(TriangleMesh& mesh, const std::vector<Shell>& shells,
                       const std::string& name) {
  const auto is_wrong = [](const Shell& s) { return (s.volume > 0) != (s.depth % 2 == 0); };
  const bool all_wrong = std::all_of(shells.begin(), shells.end(), is_wrong);
  std::size_t turned = 0;
  for (const Shell& shell : shells) {
    if (!is_wrong(shell)) continue;
    if (shell.depth > 0 && !all_wrong) {
      raiseInputError(name, "the part around triangle ", shell.triangles.front(), " at ",
                      pointText(mesh.corner(shell.triangles.front(), 0)), " (",
                      shell.triangles.size(), " triangles) lies inside another part and points ",
                      shell.volume > 0 ? "outwards" : "inwards",
                      ": its volume would count twice; leave it out, or turn it round if it is a ",
                      "cavity filled with fluid");
    }
    for (const int t : shell.triangles) turnRound(mesh, t);
    turned += shell.triangles.size();
  }
  return turned;
}

// On a surface that bounds a body once, the principal value of the winding number is 1/2.
void requireSimpleSurface(const TriangleMesh& mesh, const std::string& name) {
  constexpr Eigen::Index kSolidAngles = 10'000'000;  // about half a second
  const Eigen::Index count = mesh.triangleCount();
  const Eigen::Index samples = std::clamp<Eigen::Index>(kSolidAngles / count, 16, count);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const Eigen::Index sample = i * count / samples;
    const Eigen::Vector3d point = barycentre(mesh, static_cast<int>(sample));
    double angle = 0;
    for (Eigen::Index t = 0; t < count; ++t) {
      if (t != sample) angle += solidAngle(mesh, t, point);
    }
    const double inside = angle / kFullSphere + 0.5, outside = inside - 1;
    if (std::abs(outside) < 0.25) continue;
    raiseInputError(name, "the volume contradicts itself: at triangle ", sample, " near ",
                    pointText(point), " the surface encloses the body side ",
                    std::round(2 * inside) / 2,
                    " times, must be 1 (parts overlap or touch, or the surface crosses itself)");
  }
}

}  // namespace

CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name) {
  CheckedMesh result{mesh, {}};
  TurnSearch search(mesh, edges, name);
  std::size_t turned = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    for (const int wrong : search.minorityOf(t)) {
      turnRound(result.mesh, wrong);
      ++turned;
    }
  }
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to agree with their neighbours";
    result.warnings.push_back(warning.str());
  }
  return result;
}

CheckedMesh orientOutward(const TriangleMesh& mesh, const MeshEdges& edges,
                          const std::string& name) {
  CheckedMesh result{mesh, {}};
  const std::vector<Shell> shells = findShells(mesh, edges);
  for (const Shell& shell : shells) requireVolume(mesh, shell, name);
  const std::size_t turned = turnShells(result.mesh, shells, name);
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": inside out, " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to point into the fluid";
    result.warnings.push_back(warning.str());
  }
  requireSimpleSurface(result.mesh, name);
  return result;
}

}  // namespace ambient
