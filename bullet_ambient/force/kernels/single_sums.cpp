#include "bullet_ambient/force/kernels/single_sums.h"

#include <type_traits>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/kernels/single_lanes.h"
#include "bullet_ambient/force/law/face_pressure.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the function.

namespace ambient {
namespace {

constexpr int kRun = 16;      ///< number of blocks summed in single precision
constexpr int kChoice = 256;  ///< number of blocks per pass of chooseBlocks()
static_assert(FaceBlock::kFaces == kLanes, "a block has one face per lane");
static_assert(FaceBoxes::kBlocks == kLanes, "bounds are those of one block per lane");
static_assert(kRun == kLanes, "a run has its own bounds");

/// Partial sums over one run of blocks, one per lane: wrench, and pitch of LoadSums with wings.
struct WrenchLanes {
  float lanes[6][kLanes];
  float pitch[kLanes];

  // Inlined: else the vectors pass through memory.
  [[gnu::always_inline]] void set(const Vectors& torque, const Vectors& force, int lane) {
    store(lanes[0] + lane, torque.x);
    store(lanes[1] + lane, torque.y);
    store(lanes[2] + lane, torque.z);
    store(lanes[3] + lane, force.x);
    store(lanes[4] + lane, force.y);
    store(lanes[5] + lane, force.z);
  }
};

/// Partial sums over all runs, one per lane: wrench, and with `kPitch` the pitch of LoadSums.
template <bool kPitch = false>
struct WrenchTotal {
  static constexpr int kRows = kPitch ? 7 : 6;
  double lanes[kRows][kLanes];

  WrenchTotal() {
    for (double(&row)[kLanes] : lanes)
      for (int lane = 0; lane < kLanes; lane += kWidth) store(row + lane, Doubles{});
  }

  void add(const WrenchLanes& run) {
    for (int row = 0; row < 6; ++row)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[row][lane] += static_cast<double>(run.lanes[row][lane]);
    if constexpr (kPitch)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[6][lane] += static_cast<double>(run.pitch[lane]);
  }

  LoadSums sum() const {
    LoadSums sums;
    for (int row = 0; row < 6; ++row) sums.wrench[row] = sumOf(lanes[row]);
    if constexpr (kPitch) sums.pitch = sumOf(lanes[6]);
    return sums;
  }

 private:
  static double sumOf(const double* row) {
    double folded[8];
    for (int lane = 0; lane < 8; lane += kWidth)
      store(folded + lane, load(row + lane) + load(row + lane + 8));
    return sumLanes(folded);
  }
};

/// Adds the lee side of the form law to the wrench of `sums`: docs/theory.md eq. (43) for u_n <= 0,
/// summed over all faces, as the quadratic map of the twist x in eq. (36). `even`: 6 x 21
/// coefficients, column by column, for the products x_0 x_0, x_0 x_1 to x_5 x_5. No operation is
/// fused.
inline void addQuadraticPart(const double* even, const double (&x)[6], LoadSums& sums) {
  constexpr int kProducts = 21;
  double products[kProducts];
  for (int i = 0, next = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) products[next++] = x[i] * x[j];
  double part[8];
  for (int row = 0; row < 6; row += kWidth) {
    // With kWidth > 2, the load at the last rows also reads the start of the next column. The last
    // column has no next one, and is added below.
    Doubles a = {}, b = {};
    for (int k = 0; k < kProducts - 1; k += 2) {
      a = a + products[k] * load(even + 6 * k + row);
      b = b + products[k + 1] * load(even + 6 * k + 6 + row);
    }
    store(part + row, a + b);
  }
  const double* last = even + 6 * (kProducts - 1);
  for (int row = 0; row < 6; ++row)
    sums.wrench[row] += part[row] + products[kProducts - 1] * last[row];
}

/// Constants of the form law for lifting and slender shapes, the same in all lanes; zero if
/// motion.wing is null.
struct WingLanes {
  Vectors facing = {}, span = {}, slender = {};
  Floats pitching_rate = {}, stalling_share = {};

  // Inlined: else the vectors pass through memory.
  [[gnu::always_inline]] explicit WingLanes(const SingleMotion& motion) {
    if (!motion.wing) return;
    facing = inAllLanes<Floats>(motion.wing->facing);
    span = inAllLanes<Floats>(motion.wing->span);
    slender = inAllLanes<Floats>(motion.wing->slender);
    pitching_rate = pitching_rate + motion.pitching_rate;
    stalling_share = stalling_share + motion.stalling_share;
  }
};

/// Returns `strength` if the flow is attached, n.u > cos(alpha) |u|, else 0. Test without a root,
/// by |u|^2 = (n.u)^2 + |u_s|^2: (n.u) |n.u| sin^2(alpha) > cos(alpha) |cos(alpha)| |u_s|^2.
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

/// SingleCut in all lanes.
struct Cuts {
  Vectors normal = {};
  Floats height = {}, disc = {};

  explicit Cuts(const SingleCut* cut) {
    if (!cut) return;
    normal = inAllLanes<Floats>(cut->normal);
    height = height + cut->height;
    disc = disc + cut->disc;
  }

  /// Returns the wet share of faces, eq. (59).
  Floats wetShare(const Vectors& n, const Vectors& c, Floats area) const {
    return wetShareOf(height - dot(normal, c), dot(normal, n), disc * area,
                      [](Floats x) { return squareRoot(x); });
  }
};

/// Returns |u|^2 + 1e-30, whose inverse is finite at rest.
inline Floats squareOf(const Vectors& u) {
  constexpr float kLeast = 1e-30f;
  return plusProduct(plusProduct(plusProduct(Floats{} + kLeast, u.x, u.x), u.y, u.y), u.z, u.z);
}

/// Constants of a run of blocks, the same in all lanes.
struct RunMotion {
  const FaceBlocks& faces;
  const SingleMotion& motion;
  Vectors angular, linear;
  Cuts cuts;
  WingLanes wings;
  int lane;

  [[gnu::always_inline]] RunMotion(const FaceBlocks& blocks, const SingleMotion& all,
                                   const SingleCut* cut, int first)
      : faces(blocks),
        motion(all),
        angular(inAllLanes<Floats>(all.angular)),
        linear(inAllLanes<Floats>(all.linear)),
        cuts(cut),
        wings(all),
        lane(first) {}
};

/// Flow at kFloatWidth faces of a block.
struct LaneFlow {
  Vectors velocity;     ///< u
  Floats normal_speed;  ///< n.u
  Floats slip_sq;       ///< |t|^2
  Floats strength;      ///< |t|^2 A where the flow is attached, else 0
  Floats pressure;      ///< q A
};

/// Finds the sides of the water's surface on which all faces of blocks lie: 1 in the water, -1
/// above it, 0 not known. @pre size is at most kChoice
inline void findSides(const FaceBoxes* boxes, int size, const SingleCut& cut,
                      std::int32_t (&sides)[kChoice]) {
  const Cuts cuts(&cut);
  const auto magnitude = [](const Floats& x) { return x > 0.0f ? x : -x; };
  const Vectors& s = cuts.normal;
  const Vectors slope = {magnitude(s.x), magnitude(s.y), magnitude(s.z)};
  for (int first = 0; first < size; first += kLanes)
    for (int lane = 0; lane < kLanes; lane += kFloatWidth) {
      const FaceBoxes& at = boxes[first / kLanes];
      const Floats depth = cuts.height - dot(s, load(at.centre, lane));
      const Floats reach = dot(slope, load(at.half, lane)) + load(at.radius + lane);
      const Ints dry = depth<-reach, wet = depth> reach, side = dry - wet;
      __builtin_memcpy(sides + first + lane, &side, sizeof side);
    }
}

/// Returns the areas in the fluid of kFloatWidth faces of a block, eq. (59). `side`: that of the
/// block.
[[gnu::always_inline]] inline Floats wetArea(const RunMotion& run, const FaceBlock& block,
                                             std::int32_t side) {
  const Floats area = load(block.area + run.lane);
  if (side > 0) return area;
  return area *
         run.cuts.wetShare(load(block.normal, run.lane), load(block.centroid, run.lane), area);
}

/// Returns the flow at kFloatWidth faces of a block with the given areas, docs/theory.md eq. (12)
/// to (15), (43) to (44). Adds q_L A mu of wings to `pitch`.
template <class Law, bool kRightAngle>
[[gnu::always_inline]] inline LaneFlow flowOn(const RunMotion& run, int block, const Floats& area,
                                              Floats& pitch) {
  const int lane = run.lane;
  const FaceBlock& geometry = run.faces.blocks[block];
  const Vectors n = load(geometry.normal, lane), c = load(geometry.centroid, lane);
  const WingLanes& wings = run.wings;
  const Vectors u = plusCross(run.linear, run.angular, c);
  const Floats normal_speed = dot(n, u), whole_sq = squareOf(u);
  const Vectors t = lessProduct(u, normal_speed, n);
  const Floats slip_sq =
      Law::kLifts ? positivePart(lessProduct(whole_sq, normal_speed, normal_speed)) : dot(t, t);
  const Floats strength =
      strengthWhereAttached<kRightAngle>(normal_speed, area * slip_sq, slip_sq, run.motion);
  const auto speed = [&] {
    const Floats whole = squareRoot(plusProduct(slip_sq, normal_speed, normal_speed));
    if constexpr (!Law::kIsSlender) return whole;
    const Floats along = dot(wings.slender, t), across_sq = lessProduct(slip_sq, along, along);
    return speedAcross(normal_speed, across_sq, whole);
  };
  const auto factors = [&] {
    return formFactors<float>(load(run.faces.sharpness[block].of + lane));
  };
  const auto wing = [&](const auto& law) {
    const Floats arm = load(run.faces.arms[block].of + lane);
    const Floats facing = dot(wings.facing, u);
    const Floats stalling = Law::kIsPart ? wings.stalling_share * facing : facing;
    const WingFlow<FusedArithmetic> flow{facing,
                                         stalling,
                                         dot(wings.span, u),
                                         lessProduct(normal_speed, wings.pitching_rate, arm),
                                         whole_sq,
                                         squareRoot(whole_sq)};
    const FacePressure<Floats> pressure = law(flow, *run.motion.wing);
    pitch = plusProduct(pitch, pressure.lift, arm);
    return pressure;
  };
  const FaceState state{normal_speed, area, strength, speed, factors, wing};
  return {u, normal_speed, slip_sq, strength, Law::of(state).total};
}

/// Returns `block` as a reference that the compiler cannot identify with it, so that normals and
/// centroids are read from memory again. Otherwise the compiler keeps them in registers, of which
/// there are too few.
inline const FaceBlock& reread(const FaceBlock& block) {
  const FaceBlock* again = &block;
  asm("" : "+r"(again));
  return *again;
}

/// Returns the force on faces by pressure and friction, eq. (15) to (17), without -rho/2.
template <class Law>
[[gnu::always_inline]] inline Vectors forceOf(const LaneFlow& flow, const Vectors& n,
                                              const SingleMotion& motion) {
  const Floats along = (flow.strength * motion.friction) * slipPower(flow.slip_sq);
  if (Law::kLifts)
    return plusProduct(lessProduct(flow.pressure, along, flow.normal_speed) * n, along,
                       flow.velocity);
  return plusProduct(flow.pressure * n, along, lessProduct(flow.velocity, flow.normal_speed, n));
}

/// Blocks to be summed. `sides`: those of the blocks, by their numbers; not read if none is cut.
struct Chosen {
  const int* blocks;
  int count;
  const std::int32_t* sides;
};

/// Sums the kFloatWidth lanes from `lane` of chosen blocks.
template <class Law, bool kRightAngle, bool kFriction, bool kCut>
void sumRun(const FaceBlocks& faces, const Chosen& chosen, const SingleMotion& motion, int lane,
            WrenchLanes& sums) {
  const RunMotion run(faces, motion, kCut ? motion.cut : nullptr, lane);
  Vectors torque = {}, force = {};
  Floats pitch = {};
  for (int k = 0; k < chosen.count; ++k) {
    const int number = chosen.blocks[k];
    const std::int32_t side = kCut ? chosen.sides[number] : 1;
    if (side < 0) continue;  // dry faces add nothing
    const FaceBlock& block = faces.blocks[number];
    const Floats area = wetArea(run, block, side);
    if (side == 0 && !anyOf(area > 0.0f)) continue;
    const LaneFlow flow = flowOn<Law, kRightAngle>(run, number, area, pitch);
    const FaceBlock& again = Law::kLifts ? reread(block) : block;
    if (kFriction) {
      const Vectors f = forceOf<Law>(flow, load(again.normal, lane), motion);
      force = force + f;
      torque = plusCross(torque, load(again.centroid, lane), f);
    } else {
      force = plusProduct(force, flow.pressure, load(again.normal, lane));
      torque = plusProduct(torque, flow.pressure, load(again.moment, lane));
    }
  }
  sums.set(torque, force, lane);
  if (Law::kLifts) store(sums.pitch + lane, pitch);
}

/// Marks blocks of kFloatWidth lanes: -1 if a face of the block may move into the fluid, else 0.
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

/// Marks 16 blocks: -1 if a face of the block may have pressure of the windward side or lift, else
/// 0.
template <bool kLifts>
inline void markAttached(const FaceBounds& bounds, const SingleMotion& motion,
                         std::int32_t (&marks)[kLanes]) {
  for (int lane = 0; lane < kLanes; lane += kFloatWidth) {
    Ints mark = mayBeWindward(bounds, motion.angular, motion.linear, lane);
    if (kLifts)
      mark = mark | mayBeWindward(bounds, motion.pitched_angular, motion.pitched_linear, lane);
    __builtin_memcpy(marks + lane, &mark, sizeof mark);
  }
}

/// Indices of marked blocks, and with kRest of all others.
struct Choice {
  int attached[kChoice], rest[kChoice];
  int count = 0;  ///< number of entries in `attached`
};

/// Sorts the first `size` blocks by their marks.
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

/// Sums a run of at most kRun chosen blocks.
template <class Law, bool kRightAngle, bool kFriction, bool kCut>
void sumChosen(const FaceBlocks& faces, const Chosen& chosen, const SingleMotion& motion,
               WrenchTotal<Law::kLifts>& total) {
  WrenchLanes run;
  for (int lane = 0; lane < kLanes; lane += kFloatWidth)
    sumRun<Law, kRightAngle, kFriction, kCut>(faces, chosen, motion, lane, run);
  total.add(run);
}

/// Sums chosen blocks at a separation angle of pi/2, in runs.
template <class Law, bool kFriction, bool kCut>
void sumRuns(const FaceBlocks& faces, const Chosen& chosen, const SingleMotion& motion,
             WrenchTotal<Law::kLifts>& total) {
  for (int first = 0; first < chosen.count; first += kRun) {
    const int left = chosen.count - first;
    sumChosen<Law, true, kFriction, kCut>(
        faces, {chosen.blocks + first, left < kRun ? left : kRun, chosen.sides}, motion, total);
  }
}

inline int atMost(std::size_t count, int limit) {
  return count < static_cast<std::size_t>(limit) ? static_cast<int>(count) : limit;
}

/// Sums at a separation angle of pi/2: only blocks with faces that may be attached. The form law
/// also has pressure on the lee side: for a whole body by its quadratic map, for a body cut by the
/// water surface by summing its other blocks.
template <class Law, bool kFriction, bool kCut>
LoadSums sumWhereAttached(const FaceBlocks& faces, const SingleMotion& motion) {
  using Run = std::conditional_t<kCut, Law, typename Law::Windward>;
  constexpr bool kLeeApart = !std::is_same_v<Run, Law>;
  constexpr bool kRest = Law::kPressesLee && !kLeeApart;
  WrenchTotal<Law::kLifts> total;
  Choice choice;
  std::int32_t sides[kChoice];  // of the blocks, if the water cuts the body
  for (std::size_t begin = 0; begin < faces.count; begin += kChoice) {
    const int size = atMost(faces.count - begin, kChoice);
    const FaceBlocks blocks = faces.from(begin);
    if (kCut) findSides(faces.boxes + begin / kLanes, size, *motion.cut, sides);
    chooseBlocks<kRest, Law::kLifts>(faces.bounds + begin / kLanes, size, motion, choice);
    sumRuns<Run, kFriction, kCut>(blocks, {choice.attached, choice.count, kCut ? sides : nullptr},
                                  motion, total);
    if (kRest)
      sumRuns<Law, false, kCut>(blocks, {choice.rest, size - choice.count, kCut ? sides : nullptr},
                                motion, total);
  }
  LoadSums sums = total.sum();
  if (kLeeApart) {
    const float(&w)[3] = motion.angular, (&v)[3] = motion.linear;
    const double x[6] = {w[0], w[1], w[2], v[0], v[1], v[2]};
    addQuadraticPart(faces.lee, x, sums);
  }
  return sums;
}

/// Sums all blocks.
template <class Law, bool kRightAngle, bool kFriction, bool kCut>
LoadSums sumAll(const FaceBlocks& faces, const SingleMotion& motion) {
  static constexpr int kAll[kRun] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  WrenchTotal<Law::kLifts> total;
  std::int32_t sides[kChoice];
  for (std::size_t begin = 0; begin < faces.count; begin += kRun) {
    const int size = atMost(faces.count - begin, kRun);
    if (kCut) findSides(faces.boxes + begin / kLanes, size, *motion.cut, sides);
    sumChosen<Law, kRightAngle, kFriction, kCut>(
        faces.from(begin), {kAll, size, kCut ? sides : nullptr}, motion, total);
  }
  return total.sum();
}

template <class Law, bool kFriction, bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  if constexpr (Law::kHasFriction) {
    // Beyond a right angle the flow is attached to nearly all faces.
    if (motion.signed_cosine_sq != 0) return sumAll<Law, false, kFriction, kCut>(faces, motion);
  }
  return faces.count < FaceBlocks::kFewestChosen
             ? sumAll<Law, true, kFriction, kCut>(faces, motion)
             : sumWhereAttached<Law, kFriction, kCut>(faces, motion);
}

template <bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  return withPressure(motion.law, motion.wing, [&](auto law) {
    using Law = decltype(law);
    if constexpr (Law::kHasFriction) {
      if (motion.friction > 0) return sumBlocks<Law, true, kCut>(faces, motion);
    }
    return sumBlocks<Law, false, kCut>(faces, motion);
  });
}

}  // namespace

LoadSums AMBIENT_KERNEL(sumBlocks)(const FaceBlocks& faces, const SingleMotion& motion) noexcept {
  return motion.cut ? sumBlocks<true>(faces, motion) : sumBlocks<false>(faces, motion);
}

}  // namespace ambient
