#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

using Defects = std::vector<MeshDefect>;

constexpr double kFullSphere = 4 * kPi;

/// One closed surface among those that make up a mesh.
struct Shell {
  std::vector<int> triangles;
  double volume = 0;  // signed
  double area = 0;
  Eigen::AlignedBox3d bounds;
  int depth = 0;  // number of other shells around it
};

void measure(const TriangleMesh& mesh, Shell& shell) {
  for (const int t : shell.triangles) shell.bounds.extend(boundsOf(mesh, t));
  const Eigen::Vector3d middle = shell.bounds.center();
  for (const int t : shell.triangles) {
    shell.volume += tetrahedronVolume(mesh, t, middle);
    shell.area += areaOf(mesh, t);
  }
}

// Parts that only cross each other are left to findContradictions().
bool surrounds(const TriangleMesh& mesh, const Shell& outer, const Shell& inner) {
  if (!outer.bounds.contains(inner.bounds)) return false;
  const Eigen::Vector3d point = mesh.barycentre(inner.triangles.front());
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

/// The defect of all shells for which is_bad() holds; textOf() says what is wrong with the first.
template <class IsBad, class TextOf>
Defects defectOf(const char* kind, const std::vector<Shell>& shells, const IsBad& is_bad,
                 const TextOf& textOf) {
  MeshDefect defect{kind, {}, {}};
  for (const Shell& shell : shells) {
    if (!is_bad(shell)) continue;
    if (defect.text.empty()) defect.text = textOf(shell);
    defect.triangles.insert(defect.triangles.end(), shell.triangles.begin(), shell.triangles.end());
  }
  return defect.text.empty() ? Defects() : Defects{defect};
}

Defects findFlatShells(const TriangleMesh& mesh, const std::vector<Shell>& shells) {
  const auto ratioOf = [](const Shell& shell) {
    return std::abs(shell.volume) / portable::pow(shell.area, 1.5);
  };
  return defectOf(
      "encloses no volume", shells,
      [&](const Shell& shell) { return !(ratioOf(shell) >= kLeastVolume); },
      [&](const Shell& shell) {
        const int first = shell.triangles.front();
        return defectText(
            "the surface around triangle ", first, " at ", pointText(mesh.corner(first, 0)),
            " encloses no volume: volume / area^1.5 = ", ratioOf(shell), ", at least ",
            kLeastVolume, " needed (an open surface of zero thickness is a sheet)");
      });
}

bool isWrong(const Shell& shell) { return (shell.volume > 0) != (shell.depth % 2 == 0); }

bool areAllWrong(const std::vector<Shell>& shells) {
  return std::all_of(shells.begin(), shells.end(), isWrong);
}

// Whether a nested shell that points outwards is superfluous or a cavity only the user can know.
Defects findNestedShells(const TriangleMesh& mesh, const std::vector<Shell>& shells) {
  if (areAllWrong(shells)) return {};
  return defectOf(
      "a part counts twice", shells,
      [](const Shell& shell) { return isWrong(shell) && shell.depth > 0; },
      [&](const Shell& shell) {
        const int first = shell.triangles.front();
        return defectText(
            "the part around triangle ", first, " at ", pointText(mesh.corner(first, 0)), " (",
            shell.triangles.size(), " triangles) lies inside another part and points ",
            shell.volume > 0 ? "outwards" : "inwards",
            ": its volume would count twice; leave it out, or turn it round if it is a cavity");
      });
}

/// Turns shells that point the wrong way; returns how many triangles that were.
std::size_t turnShells(TriangleMesh& mesh, const std::vector<Shell>& shells) {
  std::size_t turned = 0;
  for (const Shell& shell : shells) {
    if (!isWrong(shell)) continue;
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
    area += areaOf(mesh, t);
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

/// Returns how often the surface encloses the body side of a triangle, at its barycentre. On a
/// surface that bounds a body once, the principal value of the winding number is 1/2 there.
double timesEnclosed(const TriangleMesh& mesh, int triangle) {
  const Eigen::Vector3d point = mesh.barycentre(triangle);
  double angle = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    if (t != triangle) angle += solidAngle(mesh, t, point);
  }
  return angle / kFullSphere + 0.5;
}

// Samples the surface at a fixed number of places, so that the verdict does not depend on the
// number of triangles.
Defects findContradictions(const TriangleMesh& mesh) {
  constexpr int kSamples = 256;
  constexpr double kMostOfArea = 0.01;
  MeshDefect defect{"the volume contradicts itself", {}, {}};
  int last = -1, bad = 0;
  double times = 0, times_at_example = 0;
  for (const int triangle : evenSample(mesh, kSamples)) {
    const bool is_new = triangle != last;
    if (is_new) times = timesEnclosed(mesh, triangle);
    last = triangle;
    if (std::abs(times - 1) < 0.25) continue;
    if (bad++ == 0) times_at_example = times;
    if (is_new) defect.triangles.push_back(triangle);
  }
  const double share = static_cast<double>(bad) / kSamples;
  if (share <= kMostOfArea) return {};
  const int example = defect.triangles.front();
  defect.text =
      defectText("the volume contradicts itself on ", std::round(1000 * share) / 10,
                 " % of the area: at triangle ", example, " near ",
                 pointText(mesh.barycentre(example)), " the surface encloses the body side ",
                 std::round(2 * times_at_example) / 2 + 0.0,  // not -0
                 " times, must be 1 on all but ", 100 * kMostOfArea,
                 " % (parts overlap or touch, or the surface crosses itself)");
  return {defect};
}

/// The triangles of all shells inside the body, or of all others.
TriangleMesh extract(const TriangleMesh& mesh, const std::vector<Shell>& shells, bool inside) {
  std::vector<Eigen::Vector3i> triangles;
  for (const Shell& shell : shells) {
    if ((shell.depth > 0) != inside) continue;
    for (const int t : shell.triangles) triangles.emplace_back(mesh.triangles.col(t));
  }
  return withUsedVertices(mesh.vertices, triangles);
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

std::string placeOf(const TriangleMesh& mesh, int t) {
  return "triangle " + std::to_string(t) + " at " + pointText(mesh.barycentre(t));
}

Defects findOverlaps(const TriangleMesh& mesh, const SurfaceCrossings& crossings) {
  if (!crossings.between_parts) return {};
  const auto [first, second] = *crossings.between_parts;
  return {{"parts overlap",
           "separate parts of the surface overlap or touch at " + placeOf(mesh, first) + " and " +
               placeOf(mesh, second) + ": unite them or leave a gap",
           {first, second}}};
}

/// Turns whole components round so that normals point out of the body, and takes those inside
/// another one out of the mesh, as cavities: they must point inwards, as they do in a consistent
/// mesh. Defects: a component that encloses no volume, lies inside another one with the wrong
/// orientation, or crosses or touches another one; more than 1 % of the surface, tried at 256
/// places evenly over its area, that encloses the body otherwise than once. Warns of a component
/// that crosses itself elsewhere. Cost O(T log T) and 256 T solid angles.
/// @pre closed, manifold, consistently oriented.
CheckedMesh orientShells(const TriangleMesh& mesh, const MeshEdges& edges,
                         const std::string& name) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  CheckedMesh result{mesh, {}};
  const MeshComponents components = computeMeshComponents(mesh, edges);
  const std::vector<Shell> shells = findShells(mesh, components);
  result.addDefects(findFlatShells(mesh, shells));
  const SurfaceCrossings crossings = findSurfaceCrossings(mesh, components.component_of);
  result.addDefects(findOverlaps(mesh, crossings));
  result.addDefects(findNestedShells(mesh, shells));
  if (crossings.within_part) {
    result.warnings.push_back(name + ": the surface crosses itself at " +
                              placeOf(mesh, crossings.within_part->first) + " and " +
                              placeOf(mesh, crossings.within_part->second) +
                              ": the volume and the flow are wrong there");
  }
  if (!result.defects.empty()) return result;
  const std::size_t turned = turnShells(result.mesh, shells);
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": inside out, " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to point into the fluid";
    result.warnings.push_back(warning.str());
  }
  result.addDefects(findContradictions(result.mesh));
  takeOutCavities(result, shells, name);
  return result;
}

CheckedMesh withoutUnusedVertices(const TriangleMesh& mesh, const std::string& name) {
  std::vector<int> number(mesh.vertexCount(), -1);  // of vertices that are used, in their order
  for (const int corner : mesh.triangles.reshaped()) number[corner] = 0;
  std::vector<Eigen::Vector3d> vertices;
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(vertices.size());
    vertices.emplace_back(mesh.vertices.col(v));
  }
  const std::size_t unused = number.size() - vertices.size();
  if (unused == 0) return {mesh, {}};
  std::vector<Eigen::Vector3i> triangles = columnsOf(mesh.triangles);
  for (Eigen::Vector3i& t : triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  return {
      makeTriangleMesh(vertices, triangles),
      {name + ": " + std::to_string(unused) + " vertices belong to no triangle and were left out"}};
}

}  // namespace

CheckedMesh checkSurface(const TriangleMesh& mesh, const std::string& name, bool sheet) {
  CheckedMesh mended{mesh, {}, {}, findValueDefects(mesh)};
  if (!mended.defects.empty()) return mended;
  mended.takeStep(withoutCopies(mended.mesh, name));
  mended.takeStep(withoutFolds(mended.mesh, name));
  mended.takeStep(withoutFlatTriangles(mended.mesh, name));
  mended.addDefects(findFlatTriangles(mended.mesh));
  mended.takeStep(withoutUnusedVertices(mended.mesh, name));
  if (mended.defects.empty()) mended.takeStep(withoutTJunctions(mended.mesh, name));
  const MeshEdges edges = computeMeshEdges(mended.mesh);
  mended.addDefects(findDoubleTriangles(mended.mesh));
  mended.addDefects(findTopologyDefects(mended.mesh, edges, sheet));
  if (!mended.defects.empty()) return mended;
  CheckedMesh oriented = mended;
  oriented.takeStep(orientConsistently(mended.mesh, edges, name));
  if (!sheet && oriented.defects.empty())
    oriented.takeStep(orientShells(oriented.mesh, edges, name));
  if (oriented.defects.empty()) return oriented;
  mended.defects = std::move(oriented.defects);
  return mended;
}

}  // namespace ambient
