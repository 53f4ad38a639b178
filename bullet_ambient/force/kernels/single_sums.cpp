#include "bullet_ambient/force/kernels/single_sums.h"

#include <type_traits>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/kernels/even_part.h"
#include "bullet_ambient/force/kernels/single_lanes.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/wet_share.h"

// Compiled once for each instruction set, which AMBIENT_KERNEL() adds to the name.

namespace ambient {
namespace {

constexpr int kRun = 16;      ///< number of blocks summed in single precision
constexpr int kChoice = 256;  ///< number of blocks per pass of chooseBlocks()
static_assert(FaceBlock::kFaces == kLanes, "a block has one face per lane");
static_assert(FaceBounds::kBlocks == kLanes, "bounds are those of one block per lane");

/// Returns `strength` if the flow is attached, else 0; see face_sums.cpp for the test.
template <bool kRightAngle>
inline Floats strengthWhereAttached(Floats normal_speed, Floats strength, Floats speed_sq,
                                    const SingleMotion& motion) {
  const Floats zero = {};
  if (kRightAngle) return normal_speed > zero ? strength : zero;
  const Floats magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Floats excess = plusProduct((normal_speed * magnitude) * motion.sine_sq, speed_sq,
                                    Floats{} + motion.signed_cosine_sq);
  return excess > zero ? strength : zero;
}

/// Plane, the same in all lanes.
struct Cuts {
  Vectors normal = {};
  Floats height = {}, disc = {};

  explicit Cuts(const SingleCut* cut) {
    if (!cut) return;
    normal = broadcast(cut->normal);
    height = height + cut->height;
    disc = disc + cut->disc;
  }

  /// Wet share of faces, eq. (59).
  Floats wetShare(const Vectors& n, const Vectors& c, Floats area) const {
    return wetShareOf(height - dot(normal, c), dot(normal, n), disc * area,
                      [](Floats x) { return root(x); });
  }
};

/// Constants of a shape and its motion, the same in all lanes; zero but for laws that ask for them.
struct Wings {
  Vectors facing = {}, span = {}, slender = {};
  Floats pitching_rate = {}, slip_share = {};

  explicit Wings(const SingleMotion& motion) {
    slip_share = slip_share + motion.slip_share;
    if (!motion.wing) return;
    facing = broadcast(motion.wing->facing);
    span = broadcast(motion.wing->span);
    slender = broadcast(motion.wing->slender);
    pitching_rate = pitching_rate + motion.pitching_rate;
  }
};

/// kWidth lanes of a run of chosen blocks; docs/theory.md eq. (12) to (17), (43) to (44), (59).
template <class Law, bool kRightAngle, bool kFriction, bool kCut>
void sumRun(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
            int lane, WrenchLanes& sums) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  const Cuts cuts(kCut ? motion.cut : nullptr);
  const Wings wings(motion);
  Vectors torque = {}, force = {};
  Floats pitch = {};
  for (int k = 0; k < count; ++k) {
    const FaceBlock& block = faces.blocks[chosen[k]];
    const Vectors n = load(block.normal, lane);
    const Vectors c = load(block.centroid, lane);
    const Vectors u = plusCross(v, w, c);
    const Floats normal_speed = dot(n, u);
    const Vectors t = lessProduct(u, normal_speed, n);
    const Floats speed_sq = dot(t, t);
    Floats area = load(block.area + lane);
    if (kCut) area = area * cuts.wetShare(n, c, area);
    const Floats strength =
        strengthWhereAttached<kRightAngle>(normal_speed, area * speed_sq, speed_sq, motion);
    const auto speed = [&] {
      const Floats whole = root(plusProduct(speed_sq, normal_speed, normal_speed));
      if constexpr (!Law::kIsSlender) return whole;
      const Floats along = dot(wings.slender, t), across_sq = lessProduct(speed_sq, along, along);
      return speedAcross(normal_speed, across_sq, whole);
    };
    const auto factors = [&] {
      const FormBlock& form = faces.form[chosen[k]];
      return FormFactors<Floats>{load(form.by_normal + lane), load(form.by_speed + lane),
                                 load(form.by_lee + lane)};
    };
    const auto wing = [&](const auto& law) {
      const Floats arm = load(faces.pitch[chosen[k]].arm + lane);
      const Floats whole_sq = plusProduct(speed_sq, normal_speed, normal_speed);
      const WingFlow<Floats> flow{dot(wings.facing, u), dot(wings.span, u),
                                  lessProduct(normal_speed, wings.pitching_rate, arm), whole_sq,
                                  inverseRoot(whole_sq)};
      const FacePressure<Floats> pressure = law(flow, *motion.wing);
      pitch = plusProduct(pitch, pressure.lift, arm);
      return pressure;
    };
    const FaceState state{normal_speed, area, strength, wings.slip_share, speed, factors, wing};
    const Floats pressure = Law::template of<kRightAngle>(state).total;
    if (kFriction) {
      const Floats along = (strength * motion.friction) * slipPower(speed_sq);
      const Vectors f = plusProduct(pressure * n, along, t);
      force = force + f;
      torque = plusCross(torque, c, f);
    } else {
      force = plusProduct(force, pressure, n);
      torque = plusProduct(torque, pressure, load(block.moment, lane));
    }
  }
  sums.set(torque, force, lane);
  if (Law::kLifts) store(sums.pitch + lane, pitch);
}

/// Marks blocks of kWidth lanes: -1 if a face of the block may move into the fluid, else 0.
inline Ints mayBeWindward(const FaceBounds& bounds, const float (&angular)[3],
                          const float (&linear)[3], int lane) {
  const float* const x[2] = {angular, linear};
  Floats middle = {}, reach = {};
  for (int row = 0; row < 6; ++row) {
    const Floats speed = Floats{} + x[row / 3][row % 3];
    middle = plusProduct(middle, load(bounds.middle[row] + lane), speed);
    reach = plusProduct(reach, load(bounds.reach[row] + lane), speed > 0.0f ? speed : -speed);
  }
  return middle + reach > 0.0f;
}

/// Marks 16 blocks: -1 if a face of the block may have the pressure of the windward side or the
/// lift of a wing, else 0.
template <bool kLifts>
inline void markAttached(const FaceBounds& bounds, const SingleMotion& motion,
                         std::int32_t (&marks)[kLanes]) {
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    Ints mark = mayBeWindward(bounds, motion.angular, motion.linear, lane);
    if (kLifts)
      mark = mark | mayBeWindward(bounds, motion.pitched_angular, motion.pitched_linear, lane);
    __builtin_memcpy(marks + lane, &mark, sizeof mark);
  }
}

/// Indices of blocks with faces that may be attached, and of all others (only if kRest is set).
struct Choice {
  int attached[kChoice], rest[kChoice];
  int count = 0;  ///< number of entries in `attached`
};

template <bool kRest, bool kLifts>
inline void chooseBlocks(const FaceBounds* bounds, int size, const SingleMotion& motion,
                         Choice& choice) {
  int count = 0;
  for (int first = 0; first < size; first += kLanes) {
    std::int32_t marks[kLanes];
    markAttached<kLifts>(bounds[first / kLanes], motion, marks);
    const int end = size - first < kLanes ? size - first : kLanes;
    for (int i = 0; i < end; ++i) {
      choice.attached[count] = first + i;
      if (kRest) choice.rest[first + i - count] = first + i;
      count -= marks[i];
    }
  }
  choice.count = count;
}

template <class Law, bool kRightAngle, bool kFriction, bool kCut>
void sumChosen(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
               WrenchTotal<Law::kLifts>& total) {
  WrenchLanes run;
  for (int lane = 0; lane < kLanes; lane += kWidth)
    sumRun<Law, kRightAngle, kFriction, kCut>(faces, chosen, count, motion, lane, run);
  total.add(run);
}

template <class Law, bool kFriction, bool kCut>
void sumRuns(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
             WrenchTotal<Law::kLifts>& total) {
  for (int first = 0; first < count; first += kRun)
    sumChosen<Law, true, kFriction, kCut>(
        faces, chosen + first, count - first < kRun ? count - first : kRun, motion, total);
}

inline int atMost(std::size_t count, int limit) {
  return count < static_cast<std::size_t>(limit) ? static_cast<int>(count) : limit;
}

/// Beyond a right angle the flow is attached to nearly all. Where a surface cuts the body, the lee
/// is that of its wet faces, and is summed after all.
template <class Law, bool kFriction, bool kCut>
LoadSums sumWhereAttached(const FaceBlocks& faces, const SingleMotion& motion) {
  using Run = std::conditional_t<kCut, Law, typename Law::Windward>;
  constexpr bool kLeeApart = !std::is_same_v<Run, Law>;
  constexpr bool kRest = Law::kPressesLee && !kLeeApart;
  WrenchTotal<Law::kLifts> total;
  Choice choice;
  for (std::size_t begin = 0; begin < faces.count; begin += kChoice) {
    const int size = atMost(faces.count - begin, kChoice);
    const FaceBlocks blocks = faces.from(begin);
    chooseBlocks<kRest, Law::kLifts>(faces.bounds + begin / kLanes, size, motion, choice);
    sumRuns<Run, kFriction, kCut>(blocks, choice.attached, choice.count, motion, total);
    if (kRest) sumRuns<Law, false, kCut>(blocks, choice.rest, size - choice.count, motion, total);
  }
  LoadSums sums = total.sum();
  if (kLeeApart) {
    const float(&w)[3] = motion.angular, (&v)[3] = motion.linear;
    const double x[6] = {w[0], w[1], w[2], v[0], v[1], v[2]};
    addEvenPart(faces.lee, x, sums);
  }
  return sums;
}

template <class Law, bool kRightAngle, bool kFriction, bool kCut>
LoadSums sumAll(const FaceBlocks& faces, const SingleMotion& motion) {
  static constexpr int kAll[kRun] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  WrenchTotal<Law::kLifts> total;
  for (std::size_t begin = 0; begin < faces.count; begin += kRun)
    sumChosen<Law, kRightAngle, kFriction, kCut>(faces.from(begin), kAll,
                                                 atMost(faces.count - begin, kRun), motion, total);
  return total.sum();
}

template <class Law, bool kFriction, bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  constexpr std::size_t kFewest = 12;  // to choose from: below, that costs more than it saves
  if (motion.signed_cosine_sq != 0) return sumAll<Law, false, kFriction, kCut>(faces, motion);
  return faces.count < kFewest ? sumAll<Law, true, kFriction, kCut>(faces, motion)
                               : sumWhereAttached<Law, kFriction, kCut>(faces, motion);
}

template <bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  const bool friction = motion.friction > 0;
  return withPressure(motion.law, motion.wing, [&](auto law) {
    using Law = decltype(law);
    return friction ? sumBlocks<Law, true, kCut>(faces, motion)
                    : sumBlocks<Law, false, kCut>(faces, motion);
  });
}

}  // namespace

LoadSums AMBIENT_KERNEL(sumBlocks)(const FaceBlocks& faces, const SingleMotion& motion) noexcept {
  return motion.cut ? sumBlocks<true>(faces, motion) : sumBlocks<false>(faces, motion);
}

}  // namespace ambient
