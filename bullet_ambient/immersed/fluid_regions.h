#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Priority and number of a region. Among regions that hold a point, the highest rank wins.
using RegionRank = std::pair<int, int>;

/// A region with its number.
struct RegionEntry {
  RegionId id = RegionId::kNone;
  FluidRegion region;
  std::size_t leaf = 0;  ///< place in its tree of RegionIndex

  RegionRank rank() const noexcept { return {region.priority, static_cast<int>(id)}; }
};

/// Region at a point and around it.
struct RegionsAround {
  const RegionEntry* entry = nullptr;  ///< of highest rank at the point; null: none
  /// False: the bounds of a region may cross a cube around the point.
  bool is_alone = true;
};

/// Finds the region of highest rank at a point, by binary trees of bounding boxes. A region that is
/// added makes a tree of one leaf; two trees of the same size become one, so that most additions
/// build small trees only. Holds addresses of regions, which must not move.
class RegionIndex {
 public:
  /// Adds a region. Cost: O(log^2 n) on average over n additions.
  void add(RegionEntry& entry);
  /// Removes a region; its leaf stays empty until half of all leaves are. Cost: O(log n); on
  /// average that of add().
  /// @pre the region was added and has the bounds and rank that it had then.
  void remove(const RegionEntry& entry);

  /// Finds the region of highest rank that holds the point; null: none. Adds the number of tested
  /// boxes to `asked`. Cost: O(log n) where few regions overlap. Allocates nothing.
  const RegionEntry* find(const Vector3& point_W, long long& asked) const noexcept {
    return findAround(point_W, 0, asked).entry;
  }
  /// Finds that region, and whether other ones or none may be within `reach` [m] of the point along
  /// each axis of W.
  RegionsAround findAround(const Vector3& point_W, double reach, long long& asked) const noexcept;
  /// Finds the region with bounds and a surface, of highest rank, that may be within `reach` [m] of
  /// the point along each axis of W; null: none. Cost: O(log n) where few regions are near.
  const RegionEntry* findPool(const Vector3& point_W, double reach,
                              long long& asked) const noexcept;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr RegionRank kNoRank{std::numeric_limits<int>::min(), -1};

  struct Node {
    RegionBounds box{Vector3::Constant(kInfinity), Vector3::Constant(-kInfinity)};  // closed
    RegionRank best = kNoRank;  // of the regions in it
  };
  // A tree over 2^k regions. Node i has the children 2 i and 2 i + 1; the root is node 1, the
  // leaves are nodes count() and above.
  struct Tree {
    std::vector<RegionEntry*> leaves;  // null: removed
    std::vector<Node> nodes;

    std::size_t count() const noexcept { return leaves.size(); }
  };

  static Node leafNode(const RegionEntry* entry) noexcept;
  static Node around(const Node& a, const Node& b) noexcept;
  static Tree makeTree(std::vector<RegionEntry*> leaves);
  static void sortLeaves(RegionEntry** begin, std::size_t count);
  void dropEmptyLeaves();
  // Calls visit(entry) for regions that may meet the cube with its half edge `reach` [m] around a
  // point: in each tree those of higher rank first, and none that ranks below one for which
  // visit() has returned true.
  template <class Visit>
  void forEachNear(const Vector3& point_W, double reach, long long& asked,
                   const Visit& visit) const noexcept;

  std::vector<Tree> trees_;  // of different sizes, the largest first
  std::size_t leaf_count_ = 0, removed_ = 0;
};

/// Properties of a medium on which surface loads depend. Media that differ in velocity only share
/// their loads.
struct FluidKind {
  double density = 0;    ///< [kg/m^3]
  double viscosity = 0;  ///< [Pa s]

  explicit FluidKind(const Medium& medium) : density(medium.density), viscosity(medium.viscosity) {}
  friend bool operator==(const FluidKind& a, const FluidKind& b) {
    return a.density == b.density && a.viscosity == b.viscosity;
  }
  friend bool operator<(const FluidKind& a, const FluidKind& b) {
    return std::tie(a.density, a.viscosity) < std::tie(b.density, b.viscosity);
  }
  /// Returns the medium at rest with these properties.
  Medium medium() const { return {density, viscosity, Vector3::Zero(), Vector3::Zero()}; }
};

/// True if a fluid above a water surface moves, so that it is wind.
inline bool mayBlow(const Medium& medium) { return !medium.velocity.isZero(0); }

/// Properties of the two fluids at a water surface on which the model of a body there depends.
struct SurfaceKind {
  FluidKind below;
  std::optional<FluidKind> above;  ///< unset: unnamedAbove() decides for each body
  bool may_blow;                   ///< true: the region's fluid above may move

  explicit SurfaceKind(const FluidRegion& region)
      : below(region.below), may_blow(hasFlow(region) || (region.above && mayBlow(*region.above))) {
    if (region.above) above.emplace(*region.above);
  }
  /// Returns the fluid above for a body whose own medium is `own`.
  Medium mediumAbove(const Medium& own) const {
    return above ? above->medium() : unnamedAbove(below.density, own);
  }
  friend bool operator==(const SurfaceKind& a, const SurfaceKind& b) {
    return a.below == b.below && a.above == b.above && a.may_blow == b.may_blow;
  }
  friend bool operator<(const SurfaceKind& a, const SurfaceKind& b) {
    return std::tie(a.below, a.above, a.may_blow) < std::tie(b.below, b.above, b.may_blow);
  }
};

/// A set of fluids of regions, each once.
struct RegionFluids {
  std::vector<FluidKind> media;
  std::vector<SurfaceKind> surfaces;

  bool empty() const noexcept { return media.empty() && surfaces.empty(); }
};

/// Water in a hold of a vessel around another body that is in it, at the start of a step.
struct HoldAround {
  const void* vessel = nullptr;  ///< which it is; not to be followed
  std::size_t hold = 0;
  RegionId region = RegionId::kNone;  ///< where the vessel is
  double size = 0;                    ///< of the vessel [m]
  bool is_dry = true;                 ///< without water
  bool is_awake = false;              ///< the vessel is
  Vector3 normal_W{0, 0, 1};          ///< of the level; unit
  double height = 0;                  ///< of the level along it [m]
  Twist vessel_W;                     ///< motion of the vessel, about its centre of mass
  Vector3 centre_W{0, 0, 0};          ///< that centre [m]
};

/// All regions of one Fluid. Changed between steps only; in a step any thread may read them.
class FluidRegions {
 public:
  using Entry = RegionEntry;

  bool empty() const noexcept { return entries_.empty(); }
  const std::map<RegionId, Entry>& all() const noexcept { return entries_; }
  /// Finds the region that holds a point: the one of highest priority, of equal ones the last
  /// added.
  const RegionIndex& index() const noexcept { return index_; }
  /// @throws std::invalid_argument if there is no such region.
  const FluidRegion& require(RegionId id) const;

  /// Returns the fluids of all regions and further ones, each once.
  RegionFluids fluids(const RegionFluids& further = {}) const;
  /// Returns those fluids of `region` that no region of this object has.
  RegionFluids missing(const FluidRegion& region) const;

  /// Number that the next add() will give.
  RegionId next() const noexcept { return static_cast<RegionId>(next_); }
  /// @pre checkRegion() has passed.
  RegionId add(FluidRegion region);
  void set(RegionId id, FluidRegion region);
  /// Removes a region. Returns false if there is none of that number.
  bool remove(RegionId id);

  /// True if a region has had bounds, a flow, layers or waves, which may make the fluid differ
  /// along a body.
  bool mayDiffer() const noexcept { return may_differ_; }
  /// True if a region has had layers.
  bool haveLayers() const noexcept { return have_layers_; }

  std::vector<HoldAround> in_holds;  ///< of the bodies in holds, by AmbientBody::in_hold
  double time = 0;                   ///< sum of all steps of the world so far [s]
  bool has_changed = false;  ///< true: regions have changed, and sleeping bodies were not woken yet

 private:
  void insert(Entry& entry);
  void withdraw(const Entry& entry);

  std::map<RegionId, Entry> entries_;
  RegionIndex index_;
  // Fluids of all regions, each as often as regions have it.
  std::multiset<FluidKind> media_;
  std::multiset<SurfaceKind> surfaces_;
  int next_ = 0;
  bool may_differ_ = false, have_layers_ = false;
};

/// @throws std::invalid_argument as checkRegion(), beginning with the region's number.
void checkRegion(RegionId id, const FluidRegion& region);

/// Guard object: while it exists, user functions of these regions (flow, surface) run on this
/// thread. Regions and bodies of that fluid must not change meanwhile.
class RegionCall {
 public:
  explicit RegionCall(const FluidRegions& regions) noexcept;
  ~RegionCall();
  RegionCall(const RegionCall&) = delete;
  RegionCall& operator=(const RegionCall&) = delete;

  /// Innermost RegionCall of these regions on this thread; null: none.
  static RegionCall* current(const FluidRegions& regions) noexcept;

  bool was_refused = false;  ///< true: a function has tried to change regions or bodies

 private:
  const FluidRegions& regions_;
  RegionCall* outer_;
};

}  // namespace ambient
