#include "preprocess/mesh/mesh_shells.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "bullet_ambient/spatial/ambient_assert.h"
#include "bullet_ambient/spatial/pi.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/surface_crossing.h"
#include "preprocess/mesh/winding_number.h"

namespace ambient {
namespace {

constexpr double kFullSphere = 4 * kPi;

// Volume over area^1.5 below which a surface encloses nothing; a square plate reaches it at a
// thickness of 3e-6 of its side, where single-precision coordinates end. A sphere has 0.094.
constexpr double kLeastVolume = 1e-6;

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

std::vector<Shell> findShells(const TriangleMesh& mesh, const MeshComponents& components) {
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
                      "cavity");
    }
    for (const int t : shell.triangles) turnRound(mesh, t);
    turned += shell.triangles.size();
  }
  return turned;
}

/// `count` triangles, evenly spread over the area: large ones several times.
std::vector<int> evenSample(const TriangleMesh& mesh, int count) {
  std::vector<double> area_up_to;
  double area = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Eigen::Vector3d a = mesh.corner(t, 0);
    area += (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).norm() / 2;
    area_up_to.push_back(area);
  }
  std::vector<int> sample;
  for (int i = 0; i < count; ++i) {
    const auto found =
        std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, (i + 0.5) / count * area);
    sample.push_back(static_cast<int>(found - area_up_to.begin()));
  }
  return sample;
}

/// How often the surface encloses the body side of a triangle, in the middle of it. On a surface
/// that bounds a body once, the principal value of the winding number is 1/2 there.
double timesEnclosed(const TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3d point = barycentre(mesh, triangle);
  double angle = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    if (t != triangle) angle += solidAngle(mesh, t, point);
  }
  return angle / kFullSphere + 0.5;
}

// The same number of places whatever the number of triangles, so that the verdict is about the
// shape.
void requireSimpleSurface(const TriangleMesh& mesh, const std::string& name) {
  constexpr int kSamples = 256;
  constexpr double kMostOfArea = 0.01;
  int last = -1, bad = 0, example = -1;
  double times = 0, times_at_example = 0;
  for (const int triangle : evenSample(mesh, kSamples)) {
    if (triangle != last) times = timesEnclosed(mesh, triangle);
    last = triangle;
    if (std::abs(times - 1) < 0.25) continue;
    if (bad++ > 0) continue;
    example = triangle;
    times_at_example = times;
  }
  const double share = static_cast<double>(bad) / kSamples;
  if (share <= kMostOfArea) return;
  raiseInputError(name, "the volume contradicts itself on ", std::round(1000 * share) / 10,
                  " % of the area: at triangle ", example, " near ",
                  pointText(barycentre(mesh, example)), " the surface encloses the body side ",
                  std::round(2 * times_at_example) / 2 + 0.0,  // not -0
                  " times, must be 1 on all but ", 100 * kMostOfArea,
                  " % (parts overlap or touch, or the surface crosses itself)");
}

/// The triangles of all shells inside the body, or of all others.
TriangleMesh extract(const TriangleMesh& mesh, const std::vector<Shell>& shells, bool inside) {
  std::vector<int> new_index(mesh.vertexCount(), -1);
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (const Shell& shell : shells) {
    if ((shell.depth > 0) != inside) continue;
    for (const int t : shell.triangles) {
      Eigen::Vector3i triangle = mesh.triangles.col(t);
      for (int& v : triangle) {
        if (new_index[v] < 0) {
          new_index[v] = static_cast<int>(vertices.size());
          vertices.emplace_back(mesh.vertices.col(v));
        }
        v = new_index[v];
      }
      triangles.push_back(triangle);
    }
  }
  return makeTriangleMesh(vertices, triangles);
}

void takeOutCavities(CheckedMesh& checked, const std::vector<Shell>& shells,
                     const std::string& name) {
  double volume = 0, cavities = 0;
  int count = 0;
  for (const Shell& shell : shells) {
    (shell.depth > 0 ? cavities : volume) +=
        std::abs(shell.volume) * (shell.depth % 2 == 0 ? 1 : -1);
    count += static_cast<int>(shell.depth % 2 == 1);
  }
  if (count == 0) return;
  checked.cavities = extract(checked.mesh, shells, true);
  checked.mesh = extract(checked.mesh, shells, false);
  std::ostringstream warning;
  warning.precision(3);
  warning << name << ": " << count << (count == 1 ? " cavity" : " cavities") << " of "
          << -100 * cavities / volume << " % of the volume: the fluid outside does not see "
          << "what is inside, which stays dry and only counts as empty in the uniform mass";
  checked.warnings.push_back(warning.str());
}

void checkCrossings(CheckedMesh& checked, const MeshComponents& components,
                    const std::string& name) {
  const SurfaceCrossings found = findSurfaceCrossings(checked.mesh, components.component_of);
  const auto placeOf = [&](int t) {
    return "triangle " + std::to_string(t) + " at " + pointText(barycentre(checked.mesh, t));
  };
  if (found.between_parts) {
    raiseInputError(name, "separate parts of the surface overlap or touch at ",
                    placeOf(found.between_parts->first), " and ",
                    placeOf(found.between_parts->second), ": unite them or leave a gap");
  }
  if (found.within_part) {
    checked.warnings.push_back(
        name + ": the surface crosses itself at " + placeOf(found.within_part->first) + " and " +
        placeOf(found.within_part->second) + ": the volume and the flow are wrong there");
  }
}

}  // namespace

CheckedMesh orientOutward(const TriangleMesh& mesh, const MeshEdges& edges,
                          const std::string& name) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  CheckedMesh result{mesh, {}};
  const MeshComponents components = computeMeshComponents(mesh, edges);
  const std::vector<Shell> shells = findShells(mesh, components);
  for (const Shell& shell : shells) requireVolume(mesh, shell, name);
  checkCrossings(result, components, name);
  const std::size_t turned = turnShells(result.mesh, shells, name);
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": inside out, " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to point into the fluid";
    result.warnings.push_back(warning.str());
  }
  requireSimpleSurface(result.mesh, name);
  takeOutCavities(result, shells, name);
  return result;
}

}  // namespace ambient
