#pragma once

#include "bullet_ambient/force/double_lanes.h"
#include "bullet_ambient/force/face_sums.h"
#include "bullet_ambient/force/form_pressure.h"
#include "bullet_ambient/force/skin_friction.h"
#include "bullet_ambient/force/wet_share.h"
#include "bullet_ambient/spatial/ambient_assert.h"

// Included once by each face_sums_<instruction set>.cpp, which is compiled for that set and names
// the AMBIENT_KERNEL.

namespace ambient {
namespace {

constexpr int kLanes = 8;
/// Faces whose intermediate results are held on the stack at a time.
constexpr int kBlock = 256;

using Bits = std::uint64_t __attribute__((vector_size(kWidth * sizeof(std::uint64_t))));

inline Vectors load(const double* const columns[3], std::size_t i) {
  return {load(columns[0] + i), load(columns[1] + i), load(columns[2] + i)};
}
inline Vectors broadcast(const double v[3]) {
  return {Doubles{} + v[0], Doubles{} + v[1], Doubles{} + v[2]};
}

/// Partial sums of a wrench, one per lane.
struct WrenchLanes {
  double lanes[6][kLanes] = {};
};

/// kWidth of the eight lanes, held in registers while a block is summed.
struct WrenchSum {
  Vectors torque, force;

  WrenchSum(const WrenchLanes& sums, int lane)
      : torque{load(sums.lanes[0] + lane), load(sums.lanes[1] + lane), load(sums.lanes[2] + lane)},
        force{load(sums.lanes[3] + lane), load(sums.lanes[4] + lane), load(sums.lanes[5] + lane)} {}

  void add(Vectors f, Vectors position) {
    force = force + f;
    torque = torque + cross(position, f);
  }

  void storeTo(WrenchLanes& sums, int lane) const {
    store(sums.lanes[0] + lane, torque.x);
    store(sums.lanes[1] + lane, torque.y);
    store(sums.lanes[2] + lane, torque.z);
    store(sums.lanes[3] + lane, force.x);
    store(sums.lanes[4] + lane, force.y);
    store(sums.lanes[5] + lane, force.z);
  }
};

/// What the friction of a block needs from its pressure. One array per component: GCC would pass a
/// copied struct of vectors through memory.
struct BlockSlip {
  static constexpr int kSize = kBlock / kLanes;
  Doubles t_x[kSize], t_y[kSize], t_z[kSize];  ///< -u_s
  Doubles speed_sq[kSize];                     ///< |u_s|^2
  Doubles strength[kSize];                     ///< |u_s|^2 A, or 0 where the flow is detached
};

/// Where the flow is attached: n.u > cos(alpha) |u|. With |u|^2 = (n.u)^2 + |u_s|^2 the root drops
/// out: (n.u) |n.u| sin^2(alpha) > cos(alpha) |cos(alpha)| |u_s|^2.
template <bool kRightAngle>
inline Doubles strengthWhereAttached(Doubles normal_speed, Doubles strength, Doubles speed_sq,
                                     const FaceMotion& motion) {
  const Doubles zero = {};
  if (kRightAngle) return normal_speed > zero ? strength : zero;
  const Doubles magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Doubles excess =
      (normal_speed * magnitude) * motion.sine_sq + speed_sq * motion.signed_cosine_sq;
  return excess > zero ? strength : zero;
}

/// Eq. (59).
inline Doubles wetShare(const FaceCut& cut, const Vectors& n, const Vectors& c,
                        const Doubles& area) {
  constexpr double kDisc = 1 / 3.14159265358979323846;
  const Vectors s = broadcast(cut.normal);
  return wetShareOf(cut.height - dot(s, c), dot(s, n), kDisc * area,
                    [](const Doubles& x) { return root(x); });
}

/// Faces [begin, end) of the kWidth lanes from `lane`; docs/theory.md eq. (12) to (15), (43), (44).
template <bool kForm, bool kRightAngle, bool kKeepSlip>
void sumPressure(const FaceColumns& faces, const FaceMotion& motion, std::size_t begin,
                 std::size_t end, int lane, WrenchLanes& sums, BlockSlip& slip) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  WrenchSum sum(sums, lane);
  int k = 0;
  for (std::size_t i = begin + static_cast<std::size_t>(lane); i < end; i += kLanes, ++k) {
    const Vectors n = load(faces.normal, i);
    const Vectors c = load(faces.centroid, i);
    const Vectors u = v + cross(w, c);
    const Doubles normal_speed = dot(n, u);
    const Vectors t = u - normal_speed * n;
    const Doubles speed_sq = dot(t, t);
    Doubles area = load(faces.area + i);
    if (motion.cut) area = area * wetShare(*motion.cut, n, c, area);
    const Doubles strength =
        strengthWhereAttached<kRightAngle>(normal_speed, area * speed_sq, speed_sq, motion);
    if (kForm) {
      const Doubles speed = root(normal_speed * normal_speed + speed_sq);
      const Doubles form =
          formPressure(normal_speed, speed, formFactors<double>(load(faces.sharpness + i)));
      const Doubles zero = {};
      const Doubles lee = kRightAngle ? zero : (normal_speed > zero ? zero : strength);
      sum.add((area * form + lee) * n, c);
    } else {
      sum.add(strength * n, c);
    }
    if (kKeepSlip) {
      slip.t_x[k] = t.x;
      slip.t_y[k] = t.y;
      slip.t_z[k] = t.z;
      slip.speed_sq[k] = speed_sq;
      slip.strength[k] = strength;
    }
  }
  sum.storeTo(sums, lane);
}

/// The friction of the same faces; docs/theory.md eq. (16) and (17). The roots have a loop of their
/// own: they are one long chain of dependent operations each, and the shorter the loop, the more of
/// them a processor has under way.
void sumFriction(const FaceColumns& faces, std::size_t begin, std::size_t end, int lane,
                 WrenchLanes& sums, BlockSlip& slip) {
  const int count = static_cast<int>((end - begin) / kLanes);
  for (int k = 0; k < count; ++k)
    slip.strength[k] = timesSlipPower<Bits>(slip.strength[k], slip.speed_sq[k]);
  WrenchSum sum(sums, lane);
  std::size_t i = begin + static_cast<std::size_t>(lane);
  for (int k = 0; k < count; ++k, i += kLanes) {
    const Vectors t = {slip.t_x[k], slip.t_y[k], slip.t_z[k]};
    sum.add(slip.strength[k] * t, load(faces.centroid, i));
  }
  sum.storeTo(sums, lane);
}

struct LaneSums {
  WrenchLanes pressure, friction;
};

/// @pre faces.size is a multiple of kLanes.
template <bool kForm, bool kRightAngle, bool kFriction>
void sumColumns(const FaceColumns& faces, const FaceMotion& motion, LaneSums& sums) {
  AMBIENT_ASSERT(faces.size % kLanes == 0);
  BlockSlip slip;
  for (std::size_t begin = 0; begin < faces.size; begin += kBlock) {
    const std::size_t end = begin + kBlock < faces.size ? begin + kBlock : faces.size;
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      sumPressure<kForm, kRightAngle, kFriction>(faces, motion, begin, end, lane, sums.pressure,
                                                 slip);
      if (kFriction) sumFriction(faces, begin, end, lane, sums.friction, slip);
    }
  }
}

/// The last faces, fewer than kLanes, filled up with faces without normal and area.
struct PaddedFaces {
  double values[8][kLanes] = {};

  PaddedFaces(const FaceColumns& faces, std::size_t begin) {
    const double* const columns[8] = {faces.normal[0],   faces.normal[1],   faces.normal[2],
                                      faces.centroid[0], faces.centroid[1], faces.centroid[2],
                                      faces.area,        faces.sharpness};
    for (int column = 0; column < (faces.sharpness ? 8 : 7); ++column)
      for (std::size_t i = begin; i < faces.size; ++i)
        values[column][i - begin] = columns[column][i];
  }
  FaceColumns columns() const {
    return {{values[0], values[1], values[2]},
            {values[3], values[4], values[5]},
            values[6],
            kLanes,
            values[7]};
  }
};

void sumLanes(const WrenchLanes& sums, double wrench[6]) {
  for (int row = 0; row < 6; ++row) {
    const double* l = sums.lanes[row];
    wrench[row] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
  }
}

template <bool kForm, bool kRightAngle, bool kFriction>
FaceSums sumFaces(const FaceColumns& faces, const FaceMotion& motion) {
  LaneSums lanes;
  FaceColumns whole = faces;
  whole.size -= faces.size % kLanes;
  sumColumns<kForm, kRightAngle, kFriction>(whole, motion, lanes);
  if (whole.size != faces.size) {
    const PaddedFaces rest(faces, whole.size);
    sumColumns<kForm, kRightAngle, kFriction>(rest.columns(), motion, lanes);
  }
  FaceSums sums;
  sumLanes(lanes.pressure, sums.pressure);
  sumLanes(lanes.friction, sums.friction);
  return sums;
}

template <bool kForm>
FaceSums sumFaces(const FaceColumns& faces, const FaceMotion& motion, bool with_friction) {
  if (motion.signed_cosine_sq == 0)
    return with_friction ? sumFaces<kForm, true, true>(faces, motion)
                         : sumFaces<kForm, true, false>(faces, motion);
  return with_friction ? sumFaces<kForm, false, true>(faces, motion)
                       : sumFaces<kForm, false, false>(faces, motion);
}

}  // namespace

FaceSums AMBIENT_KERNEL(const FaceColumns& faces, const FaceMotion& motion,
                        bool with_friction) noexcept {
  return faces.sharpness ? sumFaces<true>(faces, motion, with_friction)
                         : sumFaces<false>(faces, motion, with_friction);
}

}  // namespace ambient
