#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/surface/hold_flow.h"
#include "bullet_ambient/motion/surface/hold_exchange.h"

namespace ambient {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFull = 1e-9;    // of a hold: it has no air
constexpr double kEmpty = 1e-12;  // of a hold, that of fillHold()

/// Height from which on a place in a hold is not under its water. The air of a full hold has no
/// height: there it is a little below the hold's top, where openings are.
double airFrom(const HoldsInStep& h, int hold) {
  const double level = h.level(hold);
  if (h.room(hold) > kFull * h.shape(hold).capacity()) return level;
  const auto [low, high] = computeExtent(h.shape(hold).hull(), h.plane_F.normal);
  return level - kFull * (high - low);
}

/// Whether a corner of an opening is above both heights, so that air passes.
bool passesAir(const HoldsInStep& h, const OpeningShape& opening, double from, double to) {
  const double high = std::max(from, to);
  const auto& corners = opening.corners();
  return std::any_of(corners.begin(), corners.end(),
                     [&](const Vector3& corner) { return h.height(corner) > high; });
}

/// Whether an edge of an opening is above a height and the waves there.
bool passesAirOverWaves(const HoldsInStep& h, const OpeningShape& opening,
                        const std::vector<double>& rises, double from) {
  for (std::size_t i = 0; i < rises.size(); ++i) {
    const double height = h.height(opening.edges()[i].middle);
    if (height > h.plane_F.height + rises[i] && height > from) return true;
  }
  return false;
}

/// Whether air passes from outside through an opening of a hold.
bool isVented(const HoldsInStep& h, const HoldShapes::Opening& opening, std::size_t number) {
  const auto passes = [&](double from) {
    return h.step.rises ? passesAirOverWaves(h, opening.shape, (*h.step.rises)[number], from)
                        : passesAir(h, opening.shape, h.plane_F.height, from);
  };
  if (!passes(-kInfinite)) return false;
  return !(h.states[opening.from].volume > kEmpty * h.shape(opening.from).capacity()) ||
         passes(airFrom(h, opening.from));
}

/// Air of a group of holds: products and volumes add up.
SealedAir airOf(const HoldsInStep& h, int group) {
  SealedAir air;
  for (int i = 0; i < h.count(); ++i) {
    if (h.states[i].air_group != group) continue;
    air.product += h.states[i].air;
    air.volume += h.room(i);
  }
  return air;
}

/// Gives a group an amount of air, the same pressure in all its holds.
void setProduct(const HoldsInStep& h, int group, double product) {
  const double volume = airOf(h, group).volume;
  for (int i = 0; i < h.count(); ++i)
    if (h.states[i].air_group == group)
      h.states[i].air = volume > 0 ? product * (h.room(i) / volume) : 0;
}

void joinGroups(const HoldsInStep& h, int one, int two) {
  const auto [low, high] = std::minmax(one, two);
  for (int i = 0; i < h.count(); ++i)
    if (h.states[i].air_group == high) h.states[i].air_group = low;
}

/// Sets the groups: a number for each sealed hold, that of the first with the same air.
void findGroups(const HoldsInStep& h) {
  for (int i = 0; i < h.count(); ++i) h.states[i].air_group = i;
  h.forEach([&](const HoldShapes::Opening& opening, std::size_t number) {
    const int group = h.states[opening.from].air_group;
    if (opening.to < 0 && group >= 0 && isVented(h, opening, number)) joinGroups(h, -1, group);
  });
  if (std::all_of(h.states, h.states + h.count(),
                  [](const HoldState& state) { return state.air_group < 0; }))
    return;
  h.forEach([&](const HoldShapes::Opening& door, std::size_t) {
    if (door.to < 0) return;
    const int one = h.states[door.from].air_group, two = h.states[door.to].air_group;
    if (one != two && passesAir(h, door.shape, airFrom(h, door.from), airFrom(h, door.to)))
      joinGroups(h, one, two);
  });
}

/// Sets what bounds the pressure of the air in a hold by its openings to the sea.
void bound(const HoldsInStep& h, int hold, SealedAir& air) {
  double top = -kInfinite;
  h.forEach([&](const HoldShapes::Opening& opening, std::size_t) {
    if (opening.from == hold && opening.to < 0)
      top = std::max(top, opening.shape.top(h.plane_F.normal));
  });
  if (top == -kInfinite) return;
  const double sea = h.plane_F.height, level = h.level(hold);
  if (top > sea) {
    air.inlet = top;
  } else if (level < top) {
    const Outside outside = h.outside();
    const SurfacePlane covering{h.plane_F.normal, top, 0, 0};
    const double gain =
        computeWetVolume(h.shape(hold).hull(), covering).volume - h.states[hold].filled();
    air.most = outside.atmosphere + outside.weight * (sea - top);
    air.kept = std::max(0.0, air.volume - gain);
  }
}

/// Lets air pass at once where openings to the sea give it way.
void bubbleOut(const HoldsInStep& h) {
  for (int i = 0; i < h.count(); ++i) {
    const int group = h.states[i].air_group;
    if (group < 0) continue;
    SealedAir air = airOf(h, group);
    bound(h, i, air);
    air.kept = 0;
    setProduct(h, group, air.productAfter(0, h.level(i), h.outside()));
  }
}

/// Lets air pass at once from one hold to another one where water over a door does not keep it.
void bubbleThrough(const HoldsInStep& h, const HoldShapes::Opening& door, int from, int to) {
  const int one = h.states[from].air_group, two = h.states[to].air_group;
  const double top = door.shape.top(h.plane_F.normal), submergence = h.level(to) - top;
  if (one == two || !(h.level(from) < top) || !(submergence >= 0)) return;
  const Outside outside = h.outside();
  const SealedAir free{outside.atmosphere * kInfinite, kInfinite};
  const SealedAir here = one < 0 ? free : airOf(h, one), there = two < 0 ? free : airOf(h, two);
  const auto pressure = [&](int group, const SealedAir& air) {
    return group < 0 ? outside.atmosphere : air.product / air.volume;
  };
  const double excess = pressure(one, here) - pressure(two, there) - outside.weight * submergence;
  if (!(excess > 0)) return;
  const double amount = excess / (1 / here.volume + 1 / there.volume);  // of pressure times volume
  if (one >= 0) setProduct(h, one, here.product - amount);
  if (two >= 0) setProduct(h, two, there.product + amount);
}

/// One side of an opening.
struct Side {
  int hold;         ///< -1: the sea
  double level;     ///< [m]
  double area;      ///< by which its level moves [m^2]
  double water;     ///< that it can give [m^3]
  double room;      ///< for more [m^3]
  int group;        ///< of its air; -1: that outside
  SealedAir air{};  ///< where it is sealed

  double headAfter(double inflow, double height, const Outside& outside) const {
    return group < 0 ? 0 : air.headAfter(inflow, height, outside);
  }
};

Side airSideOf(const HoldsInStep& h, int hold) {
  if (hold < 0) return {hold, h.plane_F.height, kInfinite, kInfinite, kInfinite, -1};
  Side side{hold,         h.level(hold),           kInfinite, h.states[hold].volume,
            h.room(hold), h.states[hold].air_group};
  if (side.group < 0) return side;
  side.air = airOf(h, side.group);
  bound(h, hold, side.air);
  return side;
}

/// An opening with other air on its two sides: water goes by pressure, and down while air rises.
/// Volumes that pass out of `here` are positive.
class SealedOpening {
 public:
  SealedOpening(const HoldsInStep& holds, const HoldShapes::Opening& opening)
      : h_(holds),
        shape_(opening.shape),
        up_(holds.up()),
        here_(airSideOf(holds, opening.from)),
        there_(airSideOf(holds, opening.to)) {
    const double rise = shape_.outward().dot(up_.normal);
    Side &lower = rise > 0 ? here_ : there_, &upper = rise > 0 ? there_ : here_;
    const double top = shape_.top(up_.normal);
    if (rise == 0 || !(lower.level < top)) return;
    bubbling_ = std::copysign(bubblingFlow(shape_, up_), -rise);
    bubbled_ = kInfinite;
    if (lower.hold < 0) return;
    const SurfacePlane covering{up_.normal, top, 0, 0};
    bubbled_ = std::max(0.0, computeWetVolume(h_.shape(lower.hold).hull(), covering).volume -
                                 h_.states[lower.hold].filled());
    if (lower.group < 0 || upper.hold < 0) return;
    // The air that rises has the volume of the water that comes down.
    lower.air.most = std::min(lower.air.most, lower.air.product / lower.air.volume);
    lower.air.kept = std::max(0.0, lower.air.volume - bubbled_);
    gives_air_ = true;
  }

  /// Volume that passes in a duration, eq. (147) [m^3].
  double volumeThrough(double duration) {
    const double first = duration * flow(0);
    if (first == 0 || !std::isfinite(first)) return 0;
    const double end = farthest(first);
    if (end == 0) return 0;
    setAreas(end);
    const auto excess = [&](double q) { return duration * flow(q) - q; };
    const double at_end = excess(end);
    if (at_end == 0 || (at_end > 0) == (first > 0)) return end;
    constexpr double kAccuracy = 1e-12;  // of the explicit step
    return fallingRoot(0, first, end, at_end, kAccuracy * std::abs(first), excess);
  }

  void apply(double passed) {
    if (passed == 0) return;
    const bool rises_there = bubbling_ < 0;  // the air, if it does
    Side &lower = rises_there ? here_ : there_, &upper = rises_there ? there_ : here_;
    const double lost = addWaterTo(lower, rises_there ? -passed : passed);
    if (gives_air_) upper.air.product += lost;
    addWaterTo(upper, rises_there ? passed : -passed);
  }

 private:
  double levelAfter(const Side& side, double inflow) const {
    if (side.hold < 0 || inflow == 0) return side.level;
    const double volume = std::max(0.0, h_.states[side.hold].filled() + inflow);
    return fillHold(h_.shape(side.hold), up_.normal, volume, side.level).height;
  }

  /// Flow at the levels and pressures after a volume [m^3/s]. Falls with it.
  double flow(double q) const {
    const double level = here_.level - q / here_.area, other = there_.level + q / there_.area;
    const double sealed = sealedFlowThrough(shape_, up_, level, other, airHead(q, level, other));
    if (bubbling_ == 0 || std::abs(q) > bubbled_) return sealed;
    // The sea comes over a rim, and what stands on a lid falls through it.
    const bool comes_from_sea = bubbling_ < 0 && there_.hold < 0;
    const double vented = comes_from_sea ? flowThrough(shape_, up_, level, other)
                                         : sealedFlowThrough(shape_, up_, level, other, 0);
    return bubbling_ > 0 ? std::max(sealed, std::min(vented, bubbling_))
                         : std::min(sealed, std::max(vented, bubbling_));
  }

  /// Pressure of the air there less that here, over rho g [m].
  double airHead(double q, double level, double other) const {
    const Outside outside = h_.outside();
    return there_.headAfter(q, other, outside) - here_.headAfter(-q, level, outside);
  }

  /// Goes from no volume to `most` until no head drives the flow on, and returns where [m^3].
  template <class Head>
  static double untilStill(double most, const Head& head) {
    const double first = head(0), last = head(most);
    if (first == 0 || (first > 0) != (most > 0)) return 0;
    if (last == 0 || (last > 0) == (most > 0)) return most;
    constexpr double kAccuracy = 1e-12;  // of the head
    return fallingRoot(0, first, most, last, kAccuracy * std::abs(first), head);
  }

  /// The volume at which pressure or, while bubbles rise, a difference of levels does not drive a
  /// flow any more, by exact levels; or what there is of water and room, or the flow itself if that
  /// is less [m^3].
  double farthest(double flow) {
    const bool is_out = flow > 0;
    const Side &from = is_out ? here_ : there_, &to = is_out ? there_ : here_;
    const double most = std::min({std::abs(flow), from.water, to.room});
    const double most_sealed =
        to.group >= 0 && to.air.product > 0 ? std::min(most, (1 - kFull) * to.air.volume) : most;
    const double sealed = untilStill(is_out ? most_sealed : -most_sealed, [&](double q) {
      const double level = levelAfter(here_, -q), other = levelAfter(there_, q);
      return level - other - airHead(q, level, other);
    });
    if (bubbling_ == 0 || (bubbling_ > 0) != is_out) return sealed;
    const double most_bubbled = std::min(most, bubbled_);
    const double bubbled = untilStill(is_out ? most_bubbled : -most_bubbled, [&](double q) {
      return levelAfter(here_, -q) - levelAfter(there_, q);
    });
    bubbled_ = std::abs(bubbled);
    return is_out ? std::max(sealed, bubbled) : std::min(sealed, bubbled);
  }

  /// Sets the mean areas on the way to an end.
  void setAreas(double end) {
    for (Side* side : {&here_, &there_}) {
      const double inflow = side == &here_ ? -end : end;
      const double rise = levelAfter(*side, inflow) - side->level;
      side->area = rise * inflow > 0 ? inflow / rise : kInfinite;
    }
  }

  /// Gives a side water [m^3]. Returns what its air has lost, pressure times volume [J].
  double addWaterTo(const Side& side, double inflow) {
    if (side.hold < 0) return 0;
    addWater(inflow, h_.states[side.hold]);
    if (side.group < 0) return 0;
    const double after = side.air.productAfter(inflow, h_.level(side.hold), h_.outside());
    setProduct(h_, side.group, after);
    return side.air.product - after;
  }

  const HoldsInStep& h_;
  const OpeningShape& shape_;
  Upward up_;
  Side here_, there_;
  double bubbling_ = 0;     ///< flow down while air rises; negative: from `there`; 0: none [m^3/s]
  bool gives_air_ = false;  ///< what the lower side loses comes into the upper one
  double bubbled_ = 0;      ///< what can pass before water covers the opening on both sides [m^3]
};

}  // namespace

void addWater(double volume, HoldState& state) noexcept {
  if (volume == 0) return;
  state.volume = std::max(0.0, state.volume + volume);
  state.level = std::numeric_limits<double>::quiet_NaN();
}

void sealHolds(const HoldsInStep& h) noexcept {
  findGroups(h);
  bool is_any = false;
  for (int i = 0; i < h.count(); ++i) {
    HoldState& state = h.states[i];
    const bool was_sealed = state.is_sealed;
    state.is_sealed = state.air_group >= 0;
    is_any = is_any || state.is_sealed;
    if (!state.is_sealed) {
      state.air = 0;
    } else if (!was_sealed) {
      state.air = h.step.atmosphere * h.room(i);
    }
  }
  if (!is_any) return;
  for (int i = 0; i < h.count(); ++i) shareAir(h, i);
  bubbleOut(h);
}

void shareAir(const HoldsInStep& h, int group) noexcept {
  if (group >= 0) setProduct(h, group, airOf(h, group).product);
}

void exchangeSealed(const HoldsInStep& h, const HoldShapes::Opening& opening) noexcept {
  if (opening.to >= 0) {
    bubbleThrough(h, opening, opening.from, opening.to);
    bubbleThrough(h, opening, opening.to, opening.from);
  }
  SealedOpening sealed(h, opening);
  const double passed = sealed.volumeThrough(h.step.duration);
  sealed.apply(passed);
  if (opening.to < 0) h.states[opening.from].inflow -= passed;
}

}  // namespace ambient
