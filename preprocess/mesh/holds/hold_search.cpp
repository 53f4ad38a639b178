#include "preprocess/mesh/holds/hold_search.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/holds/hold_labels.h"
#include "preprocess/mesh/holds/hold_lids.h"
#include "preprocess/mesh/holds/pools.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

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
  Vessel vessel =
      spanLids(mesh, neighbours,
               labelTriangles(mesh, neighbours, found.up, found.pools, found.is_tilted), name);
  // A corner of three walls has pools when it is tilted, and no hole that would leak as it stands.
  const auto leaks = [](const Hold& hold) { return hold.openings.size() > 1; };
  if (found.is_tilted && !std::all_of(vessel.holds.begin(), vessel.holds.end(), leaks)) return {};
  for (std::size_t i = 0; i < vessel.holds.size(); ++i)
    vessel.holds[i].name = vessel.holds.size() == 1 ? "hold" : "hold " + std::to_string(i + 1);
  return vessel;
}

}  // namespace ambient
