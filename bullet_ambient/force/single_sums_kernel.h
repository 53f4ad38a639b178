#pragma once

#include "bullet_ambient/force/even_part.h"
#include "bullet_ambient/force/form_pressure.h"
#include "bullet_ambient/force/single_lanes.h"
#include "bullet_ambient/force/single_sums.h"
#include "bullet_ambient/force/wet_share.h"

// Included once by each single_sums_<instruction set>.cpp, which is compiled for that set and names
// the AMBIENT_KERNEL.

namespace ambient {
namespace {

constexpr int kRun = 16;      ///< blocks that are summed in single precision
constexpr int kChoice = 256;  ///< blocks that are chosen from at a time
static_assert(FaceBlock::kFaces == kLanes, "a block has one face per lane");
static_assert(FaceBounds::kBlocks == kLanes, "bounds are those of one block per lane");

/// docs/theory.md eq. (13) without a root, as in face_sums_kernel.h.
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

/// The plane in all lanes.
struct Cuts {
  Vectors normal = {};
  Floats height = {}, disc = {};

  explicit Cuts(const SingleCut* cut) {
    if (!cut) return;
    normal = broadcast(cut->normal);
    height = height + cut->height;
    disc = disc + cut->disc;
  }

  /// Eq. (59).
  Floats wetShare(const Vectors& n, const Vectors& c, Floats area) const {
    return wetShareOf(height - dot(normal, c), dot(normal, n), disc * area,
                      [](Floats x) { return root(x); });
  }
};

/// What the pressure is made of. By the form law the lee is a quadratic form of the motion, which
/// is summed over all faces beforehand: kWindward leaves it out.
enum class Pressure { kPublished, kForm, kWindward };

/// kWidth lanes of a run of chosen blocks; docs/theory.md eq. (12) to (17), (43), (44), (59).
template <Pressure kPressure, bool kRightAngle, bool kFriction, bool kCut>
void sumRun(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
            int lane, WrenchLanes& sums) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  const Cuts cuts(kCut ? motion.cut : nullptr);
  Vectors torque = {}, force = {};
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
    Floats pressure = strength;
    if (kPressure != Pressure::kPublished) {
      const Floats speed = root(plusProduct(speed_sq, normal_speed, normal_speed));
      const FormBlock& form = faces.form[chosen[k]];
      const FormFactors<Floats> factors{load(form.by_normal + lane), load(form.by_speed + lane),
                                        load(form.by_lee + lane)};
      pressure =
          area * (kPressure == Pressure::kForm ? formPressure(normal_speed, speed, factors)
                                               : windwardPressure(normal_speed, speed, factors));
      if (!kRightAngle) pressure = pressure + (normal_speed > Floats{} ? Floats{} : strength);
    }
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
}

/// For each block of some bounds: -1 if a face of it may move into the fluid, else 0.
inline void markAttached(const FaceBounds& bounds, const SingleMotion& motion,
                         std::int32_t (&marks)[kLanes]) {
  const float* const x[2] = {motion.angular, motion.linear};
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    Floats middle = {}, reach = {};
    for (int row = 0; row < 6; ++row) {
      const Floats speed = Floats{} + x[row / 3][row % 3];
      middle = plusProduct(middle, load(bounds.middle[row] + lane), speed);
      reach = plusProduct(reach, load(bounds.reach[row] + lane), speed > 0.0f ? speed : -speed);
    }
    const Ints mark = middle + reach > 0.0f;
    __builtin_memcpy(marks + lane, &mark, sizeof mark);
  }
}

/// Some blocks: first those that the flow may be attached to, and the others if they are asked for.
struct Choice {
  int attached[kChoice], rest[kChoice];
  int count = 0;
};

template <bool kRest>
inline void chooseBlocks(const FaceBounds* bounds, int size, const SingleMotion& motion,
                         Choice& choice) {
  int count = 0;
  for (int first = 0; first < size; first += kLanes) {
    std::int32_t marks[kLanes];
    markAttached(bounds[first / kLanes], motion, marks);
    const int end = size - first < kLanes ? size - first : kLanes;
    for (int i = 0; i < end; ++i) {
      choice.attached[count] = first + i;
      if (kRest) choice.rest[first + i - count] = first + i;
      count -= marks[i];
    }
  }
  choice.count = count;
}

template <Pressure kPressure, bool kRightAngle, bool kFriction, bool kCut>
void sumChosen(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
               WrenchTotal& total) {
  WrenchLanes run;
  for (int lane = 0; lane < kLanes; lane += kWidth)
    sumRun<kPressure, kRightAngle, kFriction, kCut>(faces, chosen, count, motion, lane, run);
  total.add(run);
}

template <Pressure kPressure, bool kFriction, bool kCut>
void sumRuns(const FaceBlocks& faces, const int* chosen, int count, const SingleMotion& motion,
             WrenchTotal& total) {
  for (int first = 0; first < count; first += kRun)
    sumChosen<kPressure, true, kFriction, kCut>(
        faces, chosen + first, count - first < kRun ? count - first : kRun, motion, total);
}

inline int atMost(std::size_t count, int limit) {
  return count < static_cast<std::size_t>(limit) ? static_cast<int>(count) : limit;
}

/// Beyond a right angle the flow is attached to nearly all. Where a surface cuts the body, the lee
/// is that of its wet faces, and is summed after all.
template <bool kForm, bool kFriction, bool kCut>
LoadSums sumWhereAttached(const FaceBlocks& faces, const SingleMotion& motion) {
  constexpr Pressure kPressure = !kForm ? Pressure::kPublished
                                 : kCut ? Pressure::kForm
                                        : Pressure::kWindward;
  WrenchTotal total;
  Choice choice;
  for (std::size_t begin = 0; begin < faces.count; begin += kChoice) {
    const int size = atMost(faces.count - begin, kChoice);
    const FaceBlocks blocks = faces.from(begin);
    chooseBlocks<kForm && kCut>(faces.bounds + begin / kLanes, size, motion, choice);
    sumRuns<kPressure, kFriction, kCut>(blocks, choice.attached, choice.count, motion, total);
    if (kForm && kCut)
      sumRuns<kPressure, false, kCut>(blocks, choice.rest, size - choice.count, motion, total);
  }
  LoadSums sums = total.sum();
  if (kPressure == Pressure::kWindward) {
    const float(&w)[3] = motion.angular, (&v)[3] = motion.linear;
    const double x[6] = {w[0], w[1], w[2], v[0], v[1], v[2]};
    addEvenPart(faces.lee, x, sums);
  }
  return sums;
}

template <bool kForm, bool kRightAngle, bool kFriction, bool kCut>
LoadSums sumAll(const FaceBlocks& faces, const SingleMotion& motion) {
  static constexpr int kAll[kRun] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  constexpr Pressure kPressure = kForm ? Pressure::kForm : Pressure::kPublished;
  WrenchTotal total;
  for (std::size_t begin = 0; begin < faces.count; begin += kRun)
    sumChosen<kPressure, kRightAngle, kFriction, kCut>(
        faces.from(begin), kAll, atMost(faces.count - begin, kRun), motion, total);
  return total.sum();
}

template <bool kForm, bool kFriction, bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  constexpr std::size_t kFewest = 12;  // to choose from: below, that costs more than it saves
  if (motion.signed_cosine_sq != 0) return sumAll<kForm, false, kFriction, kCut>(faces, motion);
  return faces.count < kFewest ? sumAll<kForm, true, kFriction, kCut>(faces, motion)
                               : sumWhereAttached<kForm, kFriction, kCut>(faces, motion);
}

template <bool kCut>
LoadSums sumBlocks(const FaceBlocks& faces, const SingleMotion& motion) {
  const bool friction = motion.friction > 0;
  if (faces.form)
    return friction ? sumBlocks<true, true, kCut>(faces, motion)
                    : sumBlocks<true, false, kCut>(faces, motion);
  return friction ? sumBlocks<false, true, kCut>(faces, motion)
                  : sumBlocks<false, false, kCut>(faces, motion);
}

}  // namespace

LoadSums AMBIENT_KERNEL(const FaceBlocks& faces, const SingleMotion& motion) noexcept {
  return motion.cut ? sumBlocks<true>(faces, motion) : sumBlocks<false>(faces, motion);
}

}  // namespace ambient
