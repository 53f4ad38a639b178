#include "preprocess/mesh/holds/hold_search.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/base/surface_form.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/hold_labels.h"
#include "preprocess/mesh/holds/pools.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<Eigen::Vector3i>;

constexpr double kLidRounding = 1e-9;
constexpr double kLeastLid = 1e-14;  // of a triangle, over the square of the size

Eigen::Vector3i turned(const Eigen::Vector3i& t) { return {t[0], t[2], t[1]}; }

/// A closed line along the border of the triangles of one label, and the lid across it.
struct Loop {
  std::vector<int> vertices;  // in the direction of the triangles' sides
  int beyond = 0;             // the label on the other side
  Triangles lid;
};

/// Sides of triangles along a border, and the label across each.
struct Border {
  std::vector<int> vertices, beyond;
};

class LidSpanner {
 public:
  LidSpanner(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
             const std::vector<int>& labels)
      : mesh_(mesh), neighbours_(neighbours), labels_(labels) {}

  /// Finds the openings of a hold. Where two holds meet above a bulkhead, their rims go straight
  /// across and a door hangs below.
  std::vector<Loop> loopsOf(int label) const {
    std::vector<Loop> loops;
    std::set<std::pair<int, int>> done;
    for (int t = 0; t < static_cast<int>(labels_.size()); ++t) {
      for (int k = 0; k < 3; ++k) {
        if (labels_[t] != label || !isBorder(t, k) || done.count({t, k}) > 0) continue;
        for (Loop& loop : divided(borderFrom({t, k}, done))) loops.push_back(spanned(loop));
      }
    }
    return loops;
  }

  /// Whether a lid has a triangle without area, between places of its outline on one line.
  bool isFlat(const Loop& loop) const {
    return std::any_of(loop.lid.begin(), loop.lid.end(), [&](const Eigen::Vector3i& t) {
      const Vector3d a = mesh_.vertices.col(t[0]), b = mesh_.vertices.col(t[1]),
                     c = mesh_.vertices.col(t[2]);
      return (b - a).cross(c - a).norm() <= kLeastLid * size_ * size_;
    });
  }

  /// Whether the mesh passes through a lid, away from its outline.
  bool isCrossed(const Loop& loop) const {
    const std::set<int> outline(loop.vertices.begin(), loop.vertices.end());
    const TriangleMesh lid = makeTriangleMesh(mesh_.vertices, loop.lid);
    Eigen::AlignedBox3d bounds;
    for (const int v : loop.vertices) bounds.extend(Vector3d(mesh_.vertices.col(v)));
    for (Eigen::Index t = 0; t < mesh_.triangleCount(); ++t) {
      const auto corners = mesh_.triangles.col(t);
      if (std::any_of(corners.begin(), corners.end(),
                      [&](int v) { return outline.count(v) > 0; }) ||
          !bounds.intersects(boundsOf(mesh_, t)))
        continue;
      for (Eigen::Index l = 0; l < lid.triangleCount(); ++l)
        if (passes(mesh_, t, lid, l) || passes(lid, l, mesh_, t)) return true;
    }
    return false;
  }

 private:
  bool isBorder(int t, int side) const {
    return labels_[neighbours_.across(t, side).triangle] != labels_[t];
  }

  /// Follows a border; round a vertex it goes along the hold's own triangles.
  Border borderFrom(TriangleNeighbours::Side at, std::set<std::pair<int, int>>& done) const {
    Border border;
    const int label = labels_[at.triangle];
    while (done.insert({at.triangle, at.side}).second) {
      border.vertices.push_back(mesh_.triangles(at.side, at.triangle));
      border.beyond.push_back(labels_[neighbours_.across(at.triangle, at.side).triangle]);
      at.side = (at.side + 1) % 3;
      for (;;) {
        const TriangleNeighbours::Side other = neighbours_.across(at.triangle, at.side);
        if (labels_[other.triangle] != label) break;
        at = {other.triangle, (other.side + 1) % 3};
      }
    }
    return border;
  }

  static std::vector<Loop> divided(Border border) {
    const std::size_t count = border.vertices.size();
    std::size_t first = 0;  // a side that begins a run of one label
    while (first < count && border.beyond[first] == border.beyond[(first + count - 1) % count])
      ++first;
    if (first == count) return {{border.vertices, border.beyond[0], {}}};
    std::vector<Loop> loops(1);
    for (std::size_t begin = first; begin < first + count;) {
      Loop run{{}, border.beyond[begin % count], {}};
      while (begin < first + count && border.beyond[begin % count] == run.beyond)
        run.vertices.push_back(border.vertices[begin++ % count]);
      const bool is_door = run.beyond > 0 && run.vertices.size() > 1;
      const std::size_t kept = is_door ? 1 : run.vertices.size();
      std::copy_n(run.vertices.begin(), kept, std::back_inserter(loops[0].vertices));
      run.vertices.push_back(border.vertices[begin % count]);
      if (is_door) loops.push_back(run);
    }
    return loops;
  }

  /// Finds edges of the mesh from one place of a loop to another, (low, high): a lid that had them,
  /// too, would not close.
  std::set<std::pair<int, int>> edgesAcross(const std::vector<int>& loop) const {
    std::map<int, int> place_of;
    for (std::size_t i = 0; i < loop.size(); ++i) place_of.emplace(loop[i], static_cast<int>(i));
    std::set<std::pair<int, int>> edges;
    for (const auto& corners : mesh_.triangles.colwise()) {
      for (int k = 0; k < 3; ++k) {
        const auto a = place_of.find(corners[k]), b = place_of.find(corners[(k + 1) % 3]);
        if (a != place_of.end() && b != place_of.end())
          edges.insert(std::minmax({a->second, b->second}));
      }
    }
    return edges;
  }

  Loop spanned(Loop loop) const {
    if (loop.vertices.size() < 3) return loop;
    std::vector<Vector3d> corners;
    for (const int v : loop.vertices) corners.emplace_back(mesh_.vertices.col(v));
    for (const Eigen::Vector3i& t : dividePolygon(corners, edgesAcross(loop.vertices)))
      loop.lid.push_back({loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]});
    return loop;
  }

  /// Whether a side of a triangle passes through another triangle, from its plane or below to above
  /// by more than rounding.
  bool passes(const TriangleMesh& a, Eigen::Index s, const TriangleMesh& b, Eigen::Index t) const {
    const Vector3d normal = b.twiceArea(t).stableNormalized();
    const double least = kLidRounding * size_;
    for (int k = 0; k < 3; ++k) {
      const Vector3d p = a.corner(s, k), q = a.corner(s, (k + 1) % 3);
      const double from = normal.dot(p - b.corner(t, 0)), to = normal.dot(q - b.corner(t, 0));
      if ((from > least) != (to > least) && crossesTriangle(p, q, b, t)) return true;
    }
    return false;
  }

  const TriangleMesh& mesh_;
  const TriangleNeighbours& neighbours_;
  const std::vector<int>& labels_;
  const double size_ = mesh_.extents().maxCoeff();
};

HoldOpening openingOf(const TriangleMesh& mesh, const Loop& loop) {
  HoldOpening opening;
  std::vector<int> place_of(static_cast<std::size_t>(mesh.vertexCount()), 0);
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    place_of[loop.vertices[i]] = static_cast<int>(i);
    for (const double x : mesh.vertices.col(loop.vertices[i])) opening.outline.push_back(x);
  }
  for (const Eigen::Vector3i& t : loop.lid)
    for (const int v : t) opening.lid.push_back(place_of[v]);
  return opening;
}

/// A hold while it is put together.
struct Draft {
  Triangles triangles;  // walls, turned round, and lids
  std::size_t walls = 0;
  std::vector<HoldOpening> openings;
  const char* fault = nullptr;
};

/// The walls and lids of all holds, by label. The first draft is what the outside sees.
std::vector<Draft> draftsOf(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
                            const std::vector<int>& labels) {
  const int count = *std::max_element(labels.begin(), labels.end());
  std::vector<Draft> drafts(static_cast<std::size_t>(count) + 1);
  for (std::size_t t = 0; t < labels.size(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(static_cast<Eigen::Index>(t));
    if (labels[t] == 0) drafts[0].triangles.push_back(corners);
    if (labels[t] > 0) drafts[labels[t]].triangles.push_back(turned(corners));
  }
  for (Draft& draft : drafts) draft.walls = draft.triangles.size();
  const LidSpanner spanner(mesh, neighbours, labels);
  for (int k = 1; k <= count; ++k) {
    Draft& draft = drafts[k];
    for (const Loop& loop : spanner.loopsOf(k)) {
      if (loop.lid.empty() || (loop.beyond > 0 && loop.beyond < k)) continue;  // that hold's door
      if (spanner.isCrossed(loop)) draft.fault = "the mesh passes through its lid";
      if (spanner.isFlat(loop)) draft.fault = "its lid has a face without area";
      draft.triangles.insert(draft.triangles.end(), loop.lid.begin(), loop.lid.end());
      draft.openings.push_back(openingOf(mesh, loop));
      draft.openings.back().to = loop.beyond - 1;
      for (const Eigen::Vector3i& t : loop.lid)
        drafts[loop.beyond].triangles.push_back(loop.beyond == 0 ? t : turned(t));
    }
  }
  return drafts;
}

/// Returns the surface of a hold with few triangles in place of flat walls; its lids stay those of
/// the closed vessel. Less is computed in each step then.
Surface withFewWalls(const Surface& surface, std::size_t walls) {
  const std::vector<std::int32_t> few = fewTriangles(surface, static_cast<int>(walls));
  Triangles triangles;
  for (std::size_t i = 0; i < few.size(); i += 3)
    triangles.emplace_back(few[i], few[i + 1], few[i + 2]);
  return surfaceOf(withUsedVertices(meshOf(surface).vertices, triangles));
}

Hold holdOf(const TriangleMesh& mesh, Draft& draft) {
  Hold hold;
  const TriangleMesh own = withUsedVertices(mesh.vertices, draft.triangles);
  hold.surface = surfaceOf(own);
  hold.openings = std::move(draft.openings);
  const bool is_closed = isClosed(computeMeshEdges(own));
  if (is_closed) hold.volume = tetrahedraVolume(own, own.bounds().center());
  if (!(hold.volume > 0)) {
    draft.fault = "its walls and lids do not close";
    return hold;
  }
  const MassDistribution mass = computeMassProperties(own).uniform;
  hold.centre = mass.centre;
  hold.turning_inertia = hold.volume * turningInertia(mass.inertia);
  hold.surface = withFewWalls(hold.surface, draft.walls);
  return hold;
}

/// Spans lids across the borders of labelled triangles: the closed mesh and the holds.
/// @param labels of the triangles, as labelTriangles() makes them
/// @param unit a length of 1 of the mesh in metres
/// @param name begins lines about holds that are left out since their lids or walls do not close
Vessel spanLids(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
                std::vector<int> labels, double unit, const std::string& name) {
  Vessel vessel;
  for (;;) {
    std::vector<Draft> drafts = draftsOf(mesh, neighbours, labels);
    std::vector<Hold> holds;
    int faulty = 0;
    for (int k = 1; k < static_cast<int>(drafts.size()) && faulty == 0; ++k) {
      Draft& draft = drafts[k];
      if (!draft.triangles.empty()) holds.push_back(holdOf(mesh, draft));
      if (draft.fault == nullptr) continue;
      faulty = k;
      const Vector3d place =
          unit * withUsedVertices(mesh.vertices, draft.triangles).bounds().center();
      vessel.lines.push_back(inputMessage(name, "the hold around (", place.x(), ", ", place.y(),
                                          ", ", place.z(), ") is left out: ", draft.fault));
    }
    if (faulty > 0) {
      for (int& label : labels) {
        if (label == faulty) label = 0;
        if (label > faulty) --label;
      }
      continue;
    }
    if (holds.empty()) return vessel;
    vessel.closed = withUsedVertices(mesh.vertices, drafts[0].triangles);
    if (!isClosed(computeMeshEdges(vessel.closed))) {
      vessel.lines.push_back(
          inputMessage(name, "its holds are left out: lids and walls share edges"));
      vessel.closed = {};
      return vessel;
    }
    vessel.holds = std::move(holds);
    return vessel;
  }
}

double volumeOf(const std::vector<Pool>& pools) {
  double volume = 0;
  for (const Pool& pool : pools) volume += pool.volume;
  return volume;
}

/// Pools, and which way is up for them.
struct Standing {
  Vector3d up = Vector3d::UnitZ();
  std::vector<Pool> pools;
  bool is_tilted = false;
};

Standing standing(const TriangleMesh& mesh, const Vector3d& up, bool is_tilted = false) {
  return {up, findPools(mesh, up), is_tilted};
}

/// The axis with the largest pools; the first one, +z, if they are as large within 1 %.
Standing onLargestPools(const TriangleMesh& mesh) {
  constexpr double kLarger = 1.01;
  Standing best = standing(mesh, Vector3d::UnitZ());
  for (const int axis : {2, 0, 1}) {
    for (const double way : {1.0, -1.0}) {
      if (axis == 2 && way > 0) continue;
      Standing other = standing(mesh, way * Vector3d::Unit(axis));
      if (volumeOf(other.pools) > kLarger * volumeOf(best.pools)) best = std::move(other);
    }
  }
  return best;
}

/// Tilted by 30 degrees to the first of eight sides that has pools; no pools if none has.
Standing tilted(const TriangleMesh& mesh, const Vector3d& up) {
  constexpr double kTilt = kPi / 6, kFirst = 0.2;  // off the axes, along which a mesh has its sides
  constexpr int kSides = 8;
  const Vector3d right = up.unitOrthogonal(), back = up.cross(right);
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * kPi * i / kSides + kFirst;
    const Vector3d side = portable::cos(angle) * right + portable::sin(angle) * back;
    Standing other = standing(mesh, portable::cos(kTilt) * up + portable::sin(kTilt) * side, true);
    if (!other.pools.empty()) return other;
  }
  return {up, {}, true};
}

}  // namespace

Vessel findHolds(const TriangleMesh& mesh, const HoldSearch& search, const std::string& name) {
  if (!search.is_wanted) return {};
  Standing found = search.up ? standing(mesh, *search.up) : onLargestPools(mesh);
  if (found.pools.empty()) found = tilted(mesh, search.up.value_or(Vector3d::UnitZ()));
  if (found.pools.empty()) return {};
  const TriangleNeighbours neighbours(mesh);
  Vessel vessel = spanLids(mesh, neighbours,
                           labelTriangles(mesh, neighbours, found.up, found.pools, found.is_tilted),
                           search.unit, name);
  if (vessel.holds.size() < found.pools.size() && !found.is_tilted) {
    // A rim as uneven as that of a cup of convex hulls has no lid that cuts nothing.
    const LevelRims rims = levelRims(mesh, found.up, found.pools);
    Vessel level =
        spanLids(rims.mesh, TriangleNeighbours(rims.mesh), rims.labels, search.unit, name);
    if (level.holds.size() > vessel.holds.size()) vessel = std::move(level);
  }
  // A corner of three walls has pools when it is tilted, and no hole that would leak as it stands.
  const auto leaks = [](const Hold& hold) { return hold.openings.size() > 1; };
  if (found.is_tilted && !std::all_of(vessel.holds.begin(), vessel.holds.end(), leaks)) return {};
  for (std::size_t i = 0; i < vessel.holds.size(); ++i)
    vessel.holds[i].name = vessel.holds.size() == 1 ? "hold" : "hold " + std::to_string(i + 1);
  return vessel;
}

}  // namespace ambient
