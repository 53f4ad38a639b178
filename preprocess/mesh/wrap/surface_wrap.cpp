#include "preprocess/mesh/wrap/surface_wrap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/grid_surface.h"

namespace ambient {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::Vector3i;

/// A loop of edges that bound an odd number of triangles: the rim of a hole or of a sheet.
struct OpenLoop {
  std::vector<int>
      vertices;  ///< in order, opposite to the orientation of the triangles that the loop bounds
  int triangle = 0;  ///< one of these triangles
};

/// Finds all loops of open edges, in O(T log T); each passes a vertex once. Walks along open edges
/// until each was walked once. Every vertex has an even number of them, for
/// each triangle adds two or none to its corners: a walk ends where it began. Where several loops
/// meet in a vertex, each turns away from its triangle to the nearest open edge. Triangles may have
/// either orientation.
class OpenEdgeWalk {
 public:
  OpenEdgeWalk(const TriangleMesh& mesh, const MeshEdges& edges)
      : mesh_(mesh), edges_at_(mesh.vertexCount()), place_on_path_(mesh.vertexCount(), -1) {
    for (const EdgeGroup& group : edges.edges) {
      if (group.size() % 2 == 0) continue;
      const HalfEdge& edge = edges.half_edges[group.first];
      edges_at_[edge.low].push_back(static_cast<int>(open_.size()));
      if (edge.high != edge.low) edges_at_[edge.high].push_back(static_cast<int>(open_.size()));
      open_.push_back(edge);
    }
    was_walked_.assign(open_.size(), false);
  }

  std::vector<OpenLoop> findAll() {
    for (std::size_t e = 0; e < open_.size(); ++e) {
      if (!was_walked_[e]) walkFrom(static_cast<int>(e));
    }
    return std::move(loops_);
  }

 private:
  struct Step {
    int from = 0, edge = 0;
  };

  int otherEnd(int edge, int vertex) const {
    return open_[edge].low == vertex ? open_[edge].high : open_[edge].low;
  }

  void walkFrom(int edge) {
    int at = open_[edge].low;
    do {
      was_walked_[edge] = true;
      place_on_path_[at] = static_cast<int>(path_.size());
      path_.push_back({at, edge});
      at = otherEnd(edge, at);
      if (place_on_path_[at] >= 0) takeLoop(place_on_path_[at]);
      edge = path_.empty() ? -1 : nextEdge(at, path_.back().edge);
    } while (edge >= 0);
  }

  /// Takes the steps from `first` on off the path.
  void takeLoop(int first) {
    OpenLoop loop;
    int along = 0;
    for (auto step = path_.begin() + first; step != path_.end(); ++step) {
      const HalfEdge& edge = open_[step->edge];
      loop.vertices.push_back(step->from);
      along += edge.forward == (edge.low == step->from) ? 1 : -1;
      place_on_path_[step->from] = -1;
    }
    if (along > 0) std::reverse(loop.vertices.begin(), loop.vertices.end());
    loop.triangle = open_[path_[first].edge].triangle;
    path_.resize(first);
    // A triangle with two corners on one vertex has an edge that is no edge.
    if (loop.vertices.size() >= 3) loops_.push_back(std::move(loop));
  }

  /// The open edge at a vertex that is met first when an edge turns away from its triangle.
  int nextEdge(int vertex, int edge) const {
    int next = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int candidate : edges_at_[vertex]) {
      if (was_walked_[candidate]) continue;
      const double angle = angleFrom(edge, candidate, vertex);
      if (angle < least) {
        next = candidate;
        least = angle;
      }
    }
    return next;
  }

  double angleFrom(int edge, int candidate, int vertex) const {
    const Vector3d centre = mesh_.vertices.col(vertex);
    const HalfEdge& side = open_[edge];
    const Vector3d across = mesh_.corner(side.triangle, (side.side + 2) % 3) - centre;
    const Vector3d from = mesh_.vertices.col(otherEnd(edge, vertex)) - centre;
    const Vector3d to = mesh_.vertices.col(otherEnd(candidate, vertex)) - centre;
    const Vector3d normal = across.cross(from).stableNormalized();
    const double angle = portable::atan2(from.cross(to).dot(normal), from.dot(to));
    return angle > 0 ? angle : angle + 2 * kPi;
  }

  const TriangleMesh& mesh_;
  std::vector<HalfEdge> open_;
  std::vector<std::vector<int>> edges_at_;  // by vertex
  std::vector<int> place_on_path_;          // by vertex
  std::vector<bool> was_walked_;
  std::vector<Step> path_;
  std::vector<OpenLoop> loops_;
};

/// The triangles that fill a loop.
struct Cap {
  std::vector<Vector3i> triangles;
  double area = 0;
  int component = 0;  ///< of the mesh
};

Cap makeCap(const TriangleMesh& mesh, const OpenLoop& loop, const MeshComponents& components) {
  std::vector<Vector3d> corners;
  for (const int vertex : loop.vertices) corners.push_back(mesh.vertices.col(vertex));
  Cap cap;
  cap.triangles = dividePolygon(corners);
  cap.area = areaOf(makeTriangleMesh(corners, cap.triangles));
  cap.component = components.component_of[loop.triangle];
  for (Vector3i& t : cap.triangles)
    t = {loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]};
  return cap;
}

/// By component.
std::vector<double> areasOf(const TriangleMesh& mesh, const MeshComponents& components) {
  std::vector<double> areas(components.count, 0.0);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    areas[components.component_of[t]] += areaOf(mesh, t);
  return areas;
}

/// The triangles to wrap, and the size to do it with.
struct WrapInput {
  TriangleMesh mesh;
  double size = 0;
  int holes = 0;          ///< that were filled
  double hole_area = 0;   ///< [m^2]
  bool is_sheet = false;  ///< true: one loop would take more than kSheet of the area of all
};

/// Fills the loops of open edges with triangles on their vertices. A part with a loop that would
/// take more than kSheet of its own area is a sheet, and stays open: a plate, a sail, a patch among
/// others. Cost O(T log T), and O(n^2 log n) for a loop of n edges.
/// @pre indices are in range, coordinates finite.
WrapInput withHolesFilled(const TriangleMesh& mesh) {
  constexpr double kSheet = 0.9;
  const MeshEdges edges = computeMeshEdges(mesh);
  const MeshComponents components = computeMeshComponents(mesh, edges);
  const std::vector<double> areas = areasOf(mesh, components);
  const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
  WrapInput filled;
  std::vector<Cap> caps;
  std::vector<bool> is_sheet(components.count, false);
  for (const OpenLoop& loop : OpenEdgeWalk(mesh, edges).findAll()) {
    caps.push_back(makeCap(mesh, loop, components));
    const Cap& cap = caps.back();
    if (cap.area > kSheet * areas[cap.component]) is_sheet[cap.component] = true;
    if (cap.area > kSheet * whole) filled.is_sheet = true;
  }
  std::vector<Vector3i> triangles = columnsOf(mesh.triangles);
  for (const Cap& cap : caps) {
    if (is_sheet[cap.component]) continue;
    triangles.insert(triangles.end(), cap.triangles.begin(), cap.triangles.end());
    filled.hole_area += cap.area;
    ++filled.holes;
  }
  filled.mesh = makeTriangleMesh(mesh.vertices, triangles);
  return filled;
}

bool isWithin(double share, double now, double then) { return std::abs(now / then - 1) <= share; }

/// Stretched and moved to the volume and the centre of a body.
TriangleMesh fitted(TriangleMesh mesh, const MeshProperties& own, const MeshProperties& body) {
  const double stretch = portable::cbrt(body.volume / own.volume);
  mesh.vertices =
      (stretch * (mesh.vertices.colwise() - own.uniform.centre)).colwise() + body.uniform.centre;
  return mesh;
}

/// Without triangles that have no normal; what they leave open is a gap of no width.
TriangleMesh withoutNeedles(const TriangleMesh& mesh) {
  std::vector<Index> kept;
  for (Index t = 0; t < mesh.triangleCount(); ++t)
    if (heightRatio(mesh, t) >= kLeastHeight) kept.push_back(t);
  return {mesh.vertices, mesh.triangles(Eigen::all, kept)};
}

/// By signed tetrahedra, whether or not the triangles are closed.
double tetrahedraVolumeOf(const TriangleMesh& mesh) {
  return tetrahedraVolume(mesh, mesh.vertices.rowwise().mean());
}

constexpr double kMargin = 3.377;  // steps; a box along the axes has no side on nodes

Vector3d nodeCountsAround(const TriangleMesh& mesh, double step) {
  return (mesh.extents() / step).array() + 2 * kMargin + 1;
}

CubicGrid gridAround(const TriangleMesh& mesh, double step) {
  CubicGrid grid;
  grid.step = step;
  grid.origin = mesh.vertices.rowwise().minCoeff().array() - kMargin * step;
  const Vector3d counts = nodeCountsAround(mesh, step);
  for (std::size_t k = 0; k < 3; ++k)
    grid.counts[k] = static_cast<std::int64_t>(std::ceil(counts[static_cast<Index>(k)]));
  return grid;
}

void requireNodes(const TriangleMesh& mesh, double step, const std::string& name) {
  constexpr double kMostNodes = 2e7;
  const double nodes = gridNodesAround(mesh, step);
  if (nodes <= kMostNodes) return;
  raiseInputError(name, "cannot be wrapped with a size of ", step, " m: a grid of ", nodes,
                  " nodes would be needed, at most ", kMostNodes,
                  " are possible; give a larger size");
}

TriangleMesh fullWrap(const TriangleMesh& mesh, double step) {
  return makeGridSurface(mesh, gridAround(mesh, step));
}

WrapInput usableInput(const TriangleMesh& mesh, double size, const std::string& name) {
  if (mesh.triangleCount() > 0 && !mesh.vertices.allFinite())
    raiseInputError(name, "a vertex has a coordinate that is not finite");
  WrapInput input = withHolesFilled(mesh);
  input.mesh = withoutNeedles(input.mesh);
  input.size = size;
  if (input.mesh.triangleCount() == 0) raiseInputError(name, "there are no triangles with an area");
  const double diagonal = input.mesh.extents().norm();
  if (size == 0) input.size = kDefaultWrapSize * diagonal;
  if (!(input.size > 0 && input.size <= diagonal)) {
    raiseInputError(name, "cannot be wrapped with a size of ", size,
                    " m: it must be positive and at most its diagonal of ", diagonal, " m");
  }
  return input;
}

/// The first of 2, 4, 8... times a size with which nearly all that the triangles enclose is inside;
/// 0: none.
double sufficientSize(const TriangleMesh& mesh, double size, double enclosed) {
  constexpr double kNearlyAll = 0.9;
  const double largest = mesh.extents().norm() / 4;
  for (double larger = 2 * size; larger <= largest; larger *= 2)
    if (tetrahedraVolumeOf(fullWrap(mesh, larger)) >= kNearlyAll * enclosed) return larger;
  return 0;
}

/// Refuses a surface through whose gaps the fluid has come in.
void requireInside(const WrapInput& input, const TriangleMesh& surface, const std::string& name) {
  constexpr double kLeast = 0.5;
  const double found = tetrahedraVolumeOf(surface);
  // The tetrahedra count twice what two parts enclose, which the points do not, at a higher cost.
  if (found >= kLeast * std::abs(tetrahedraVolumeOf(input.mesh))) return;
  const double enclosed = enclosedVolume(input.mesh);
  if (found >= kLeast * enclosed) return;
  const double larger = sufficientSize(input.mesh, input.size, enclosed);
  const std::string problem = inputMessage(
      name, "wrapped with a size of ", input.size, " m encloses ", found, " m^3 of the ", enclosed,
      " m^3 that its triangles surround, less than half: gaps between them are wider than that");
  if (larger == 0) throw std::runtime_error(problem + ", and no size closes them");
  std::ostringstream advice;
  advice << "; a size of " << larger << " m closes them";
  throw std::runtime_error(problem + advice.str());
}

/// The convex hull of a mesh; empty if all vertices lie in a plane.
TriangleMesh hullOf(const TriangleMesh& mesh, const std::string& name) {
  try {
    return makeConvexHull(mesh.vertices, name);
  } catch (const std::runtime_error&) {
    return {};
  }
}

/// Refuses a surface that the thickness of thin parts has made larger than the convex hull by more
/// than the error of a wrapped solid. Open triangles reach half of their thickness of 1.5 sizes
/// farther: such a layer is allowed too, unless it would be more than kLayer of the hull, for which
/// the size is too large. A hull that is itself about as thin as the default size, of a sheet or a
/// rod, is no limit.
void requireWithinHull(const WrapInput& input, const TriangleMesh& surface,
                       const std::string& name) {
  constexpr double kLayer = 0.25, kSolid = 0.02;
  const TriangleMesh hull = hullOf(input.mesh, name);
  if (hull.triangleCount() == 0) return;
  const double volume = tetrahedraVolumeOf(hull), found = tetrahedraVolumeOf(surface);
  const double area = areaOf(hull), layer = 0.75 * input.size * area;
  const double thin = kDefaultWrapSize * input.mesh.extents().norm() * area;
  const double most = (1 + kSolid) * volume + (layer <= kLayer * volume ? layer : 0);
  if (found <= most || volume <= thin) return;
  raiseInputError(
      name, "wrapped with a size of ", input.size, " m encloses ", found,
      " m^3, more than its convex hull of ", volume,
      " m^3: parts thinner than the size become 1.5 times as thick; give a smaller size");
}

std::string comparison(const TriangleMesh& before, const TriangleMesh& after, double size) {
  const double volume = tetrahedraVolumeOf(after), area = areaOf(after);
  const double own_volume = std::abs(tetrahedraVolumeOf(before)), own_area = areaOf(before);
  std::ostringstream text;
  text.precision(4);
  text << "wrapped with a size of " << size << " m: " << after.triangleCount() << " for "
       << before.triangleCount() << " triangles, volume " << volume << " m^3";
  const auto change = [&](double now, double then) {
    std::ostringstream percent;
    percent.precision(3);
    percent << std::showpos << 100 * (now / then - 1) << " %";
    return percent.str();
  };
  if (isClosed(computeMeshEdges(before))) {
    text << " (" << change(volume, own_volume) << ")";
  } else {
    text << " (the triangles enclose none, they are open)";
  }
  text << ", area " << area << " m^2 (" << change(area, own_area) << ")";
  return text.str();
}

/// The closed surface around triangles, without a warning about it.
CheckedMesh wrapInput(const WrapInput& input, const std::string& name) {
  constexpr int kLeastFaces = 800, kMostFaces = 4000;
  constexpr double kTolerance = 0.1;
  requireNodes(input.mesh, input.size, name);
  const TriangleMesh fine = fullWrap(input.mesh, input.size);
  if (fine.triangleCount() == 0)
    raiseInputError(name, "cannot be wrapped with a size of ", input.size, " m: nothing is left");
  requireInside(input, fine, name);
  requireWithinHull(input, fine, name);
  const TriangleMesh coarse = coarsened(fine, {kLeastFaces, kMostFaces, kTolerance * input.size});
  CheckedMesh checked = checkMesh(coarse, name);
  if (checked.defects.empty()) return checked;
  return requireSound(checkMesh(fine, name), name);  // parts of the coarser one have come to touch
}

/// wrapInput() for a mesh that was refused: says first why.
CheckedMesh wrapWhatIsBroken(const WrapInput& input, const std::string& name,
                             const std::string& refusal) {
  try {
    return wrapInput(input, name);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(refusal + "; " + std::string(error.what()).substr(name.size() + 2));
  }
}

/// Whether values are in range and some triangle has an area.
bool canBeWrapped(const TriangleMesh& mesh) {
  return findValueDefects(mesh).empty() && withoutNeedles(mesh).triangleCount() > 0;
}

/// True of a closed surface that is a sheet, twice: once from each side.
bool enclosesNothing(const TriangleMesh& mesh) {
  return mesh.triangleCount() > 0 && isClosed(computeMeshEdges(mesh)) &&
         std::abs(tetrahedraVolumeOf(mesh)) < kLeastVolume * portable::pow(areaOf(mesh), 1.5);
}

/// Volume and area of a wrapped mesh before and after; the volume is that with filled holes.
/// @param unit a length of 1 [m]
std::string beforeAndAfter(const TriangleMesh& before, const WrapInput& filled,
                           const TriangleMesh& after, double unit) {
  const double square = unit * unit, cube = square * unit;
  std::ostringstream text;
  text.precision(4);
  text << "wrapped with a size of " << unit * filled.size << " m: volume ";
  if (isClosed(computeMeshEdges(filled.mesh))) {
    text << cube * std::abs(tetrahedraVolumeOf(filled.mesh)) << " m^3";
  } else {
    text << "none (the triangles enclose none)";
  }
  text << " before and " << cube * tetrahedraVolumeOf(after) << " m^3 after, area "
       << square * areaOf(before) << " m^2 before and " << square * areaOf(after) << " m^2 after";
  return text.str();
}

/// Says of a mesh that was refused that it has been closed.
std::string filledHoles(const std::string& refusal, const WrapInput& filled, double unit) {
  std::ostringstream text;
  text.precision(4);
  text << refusal << "; holes filled: " << filled.holes << ", of " << unit * unit * filled.hole_area
       << " m^2 in all";
  return text.str();
}

}  // namespace

double gridNodesAround(const TriangleMesh& mesh, double size) {
  return nodeCountsAround(mesh, size).prod();
}

TriangleMesh wrapped(const TriangleMesh& mesh, double size, const CoarseningSettings& settings) {
  const TriangleMesh fine = fullWrap(mesh, size);
  return fine.triangleCount() > 0 ? coarsened(fine, settings) : fine;
}

CheckedMesh wrapSurface(const TriangleMesh& mesh, double size, const std::string& name) {
  const WrapInput input = usableInput(mesh, size, name);
  CheckedMesh result = wrapInput(input, name);
  std::vector<std::string> warnings{name + ": " + comparison(input.mesh, result.mesh, input.size)};
  if (input.holes > 0) {
    warnings.push_back(inputMessage(name, "holes filled before that: ", input.holes, ", of ",
                                    input.hole_area, " m^2 in all"));
  }
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  return result;
}

CheckedMesh makeBodyMesh(const TriangleMesh& mesh, const std::string& name, bool strict,
                         double unit) {
  CheckedMesh checked = checkMesh(mesh, name);
  if (checked.defects.empty()) return checked;
  const std::string refusal = inputMessage(name, checked.defects.front().text);
  if (!canBeWrapped(mesh)) throw std::runtime_error(refusal);
  if (strict)
    throw std::runtime_error(refusal + " (build --wrap makes a closed surface around it)");
  if (enclosesNothing(checked.mesh)) throw std::runtime_error(refusal);
  const WrapInput filled = withHolesFilled(checked.mesh);
  if (filled.is_sheet) {
    throw std::runtime_error(refusal +
                             " (a surface of zero thickness is a sheet: --sheet, in Python "
                             "sheet=True; --wrap makes it thick)");
  }
  if (filled.holes > 0) {
    CheckedMesh whole = checkMesh(filled.mesh, name);
    if (whole.defects.empty()) {
      whole.warnings.insert(whole.warnings.begin(), filledHoles(refusal, filled, unit));
      return whole;
    }
  }
  const WrapInput input = usableInput(checked.mesh, 0, name);
  CheckedMesh result = wrapWhatIsBroken(input, name, refusal);
  result.is_wrapped = true;
  result.warnings.insert(result.warnings.begin(),
                         refusal + "; " + beforeAndAfter(checked.mesh, input, result.mesh, unit));
  return result;
}

std::optional<TriangleMesh> compactSurface(const TriangleMesh& mesh, int triangles) {
  constexpr double kSquares = 8000, kMostNodes = 5e6;
  constexpr double kVolumeChange = 0.0025, kAreaChange = 0.005;
  const MeshProperties body = computeMassProperties(mesh);
  const double step = std::sqrt(body.area / kSquares);
  if (!(gridNodesAround(mesh, step) <= kMostNodes)) return std::nullopt;
  TriangleMesh compact = wrapped(mesh, step, {triangles, triangles, 0});
  if (compact.triangleCount() == 0) return std::nullopt;
  const MeshProperties found = computeMassProperties(compact);
  if (!isWithin(kVolumeChange, found.volume, body.volume)) return std::nullopt;
  if (!isWithin(kAreaChange, found.area, body.area)) return std::nullopt;
  return fitted(std::move(compact), found, body);
}

std::optional<TriangleMesh> inFewerTriangles(const TriangleMesh& mesh, int triangles) {
  constexpr double kVolumeChange = 0.02, kAreaChange = 0.02, kTooMany = 1.1;
  TriangleMesh fewer = coarsened(mesh, {triangles, triangles, 0});
  if (static_cast<double>(fewer.triangleCount()) > kTooMany * triangles) return std::nullopt;
  const MeshProperties found = computeMassProperties(fewer), body = computeMassProperties(mesh);
  if (!isWithin(kVolumeChange, found.volume, body.volume)) return std::nullopt;
  if (!isWithin(kAreaChange, found.area, body.area)) return std::nullopt;
  return fitted(std::move(fewer), found, body);
}

}  // namespace ambient
