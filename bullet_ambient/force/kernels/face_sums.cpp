#include "bullet_ambient/force/kernels/face_sums.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/kernels/double_lanes.h"
#include "bullet_ambient/force/kernels/wing_lanes.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/law/wet_share.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the function.

namespace ambient {
namespace {

constexpr int kLanes = 8;
/// Number of faces per pass; intermediate results of one pass are held on the stack.
constexpr int kBlock = 256;

using Bits = std::uint64_t __attribute__((vector_size(kWidth * sizeof(std::uint64_t))));

inline Vectors load(const double* const columns[3], std::size_t i) {
  return {load(columns[0] + i), load(columns[1] + i), load(columns[2] + i)};
}
inline Vectors broadcast(const double (&v)[3]) { return inAllLanes<Doubles>(v); }

/// Partial sums of a wrench, one per lane.
struct WrenchLanes {
  double lanes[6][kLanes] = {};
};

/// Partial sums of the pressure, and of FaceSums::pitch.
struct PressureLanes : WrenchLanes {
  double pitch[kLanes] = {};
};

/// Sum of a wrench in kWidth of the eight lanes, held in registers during a pass.
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

/// Slip of one pass, from sumPressure() to sumFriction(). One array per component: GCC passes a
/// copied struct of vectors through memory.
struct BlockSlip {
  static constexpr int kSize = kBlock / kLanes;
  Doubles t_x[kSize], t_y[kSize], t_z[kSize];  ///< -u_s
  Doubles speed_sq[kSize];                     ///< |u_s|^2
  Doubles strength[kSize];                     ///< |u_s|^2 A; 0 if the flow is detached
};

/// Returns `strength` if the flow is attached, n.u > cos(alpha) |u|, else 0. Test without a root,
/// by |u|^2 = (n.u)^2 + |u_s|^2: (n.u) |n.u| sin^2(alpha) > cos(alpha) |cos(alpha)| |u_s|^2.
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

/// Returns mu of eq. (43d).
inline Doubles pitchingArm(const FaceMotion& motion, const Vectors& n, const Vectors& c) {
  return dot(broadcast(motion.pitching), cross(c - broadcast(motion.centre), n));
}

/// Returns the wet share of faces, eq. (59).
inline Doubles wetShare(const FaceCut& cut, const Vectors& n, const Vectors& c,
                        const Doubles& area) {
  constexpr double kDisc = 1 / 3.14159265358979323846;
  const Vectors s = broadcast(cut.normal);
  return wetShareOf(cut.height - dot(s, c), dot(s, n), kDisc * area,
                    [](const Doubles& x) { return root(x); });
}

/// Adds the pressure of faces [begin, end) in the kWidth lanes from `lane`, docs/theory.md eq. (12)
/// to (15), (43) to (44). With kKeepSlip, stores their slip for sumFriction().
template <class Law, bool kRightAngle, bool kKeepSlip>
void sumPressure(const FaceColumns& faces, const FaceMotion& motion, std::size_t begin,
                 std::size_t end, int lane, PressureLanes& sums, BlockSlip& slip) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  const WingLanes<Doubles> wings(motion);
  WrenchSum sum(sums, lane);
  Doubles pitch = load(sums.pitch + lane);
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
    const auto speed = [&] {
      const Doubles whole = root(normal_speed * normal_speed + speed_sq);
      if constexpr (!Law::kIsSlender) return whole;
      const Doubles along = dot(wings.slender, t);
      return speedAcross(normal_speed, speed_sq - along * along, whole);
    };
    const auto factors = [&] { return formFactors<double>(load(faces.sharpness + i)); };
    const auto wing = [&](const auto& law) {
      constexpr double kLeast = 1e-200;  // keeps 1 / |u|^2 finite at rest
      const Doubles arm = pitchingArm(motion, n, c);
      const Doubles whole_sq = (normal_speed * normal_speed + kLeast) + speed_sq;
      const WingFlow<PlainArithmetic<Doubles>> flow{dot(wings.facing, u), dot(wings.span, u),
                                                    normal_speed - wings.pitching_rate * arm,
                                                    whole_sq, root(whole_sq)};
      const FacePressure<Doubles> pressure = law(flow, *motion.wing);
      pitch = pitch + pressure.lift * arm;
      return pressure;
    };
    const FaceState state{normal_speed, area, strength, wings.slip_share, speed, factors, wing};
    sum.add(Law::template of<kRightAngle>(state).total * n, c);
    if (kKeepSlip) {
      slip.t_x[k] = t.x;
      slip.t_y[k] = t.y;
      slip.t_z[k] = t.z;
      slip.speed_sq[k] = speed_sq;
      slip.strength[k] = strength;
    }
  }
  sum.storeTo(sums, lane);
  if (Law::kLifts) store(sums.pitch + lane, pitch);
}

/// Adds the friction of the same faces; docs/theory.md eq. (16) and (17). The powers have a loop of
/// their own: each is a long chain of dependent operations, and a short loop lets the processor
/// overlap more of them.
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

/// Partial sums of all faces.
struct LaneSums {
  PressureLanes pressure;
  WrenchLanes friction;
};

/// Adds all faces. @pre faces.size is a multiple of kLanes
template <class Law, bool kRightAngle, bool kFriction>
void sumColumns(const FaceColumns& faces, const FaceMotion& motion, LaneSums& sums) {
  AMBIENT_ASSERT(faces.size % kLanes == 0);
  BlockSlip slip;
  for (std::size_t begin = 0; begin < faces.size; begin += kBlock) {
    const std::size_t end = begin + kBlock < faces.size ? begin + kBlock : faces.size;
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      sumPressure<Law, kRightAngle, kFriction>(faces, motion, begin, end, lane, sums.pressure,
                                               slip);
      if (kFriction) sumFriction(faces, begin, end, lane, sums.friction, slip);
    }
  }
}

/// Last faces, fewer than kLanes, filled up with faces of zeros.
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
  for (int row = 0; row < 6; ++row) wrench[row] = sumLanes(sums.lanes[row]);
}

template <class Law, bool kRightAngle, bool kFriction>
FaceSums sumFaces(const FaceColumns& faces, const FaceMotion& motion) {
  LaneSums lanes;
  FaceColumns whole = faces;
  whole.size -= faces.size % kLanes;
  sumColumns<Law, kRightAngle, kFriction>(whole, motion, lanes);
  if (whole.size != faces.size) {
    const PaddedFaces rest(faces, whole.size);
    sumColumns<Law, kRightAngle, kFriction>(rest.columns(), motion, lanes);
  }
  FaceSums sums;
  sumLanes(lanes.pressure, sums.pressure);
  sumLanes(lanes.friction, sums.friction);
  sums.pitch = sumLanes(lanes.pressure.pitch);
  return sums;
}

template <class Law>
FaceSums sumFaces(const FaceColumns& faces, const FaceMotion& motion, bool with_friction) {
  if (motion.signed_cosine_sq == 0)
    return with_friction ? sumFaces<Law, true, true>(faces, motion)
                         : sumFaces<Law, true, false>(faces, motion);
  return with_friction ? sumFaces<Law, false, true>(faces, motion)
                       : sumFaces<Law, false, false>(faces, motion);
}

}  // namespace

FaceSums AMBIENT_KERNEL(sumFaces)(const FaceColumns& faces, const FaceMotion& motion,
                                  bool with_friction) noexcept {
  return withPressure(motion.law, motion.wing, [&](auto law) {
    return sumFaces<decltype(law)>(faces, motion, with_friction);
  });
}

}  // namespace ambient
