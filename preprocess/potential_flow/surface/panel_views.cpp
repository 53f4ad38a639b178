#include "preprocess/potential_flow/surface/panel_views.h"

#include "bullet_ambient/base/lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {
namespace {

using Bits = std::uint64_t __attribute__((vector_size(kRegister)));

/// Sums c[0] + c[1] x + ... by Horner's rule.
template <int kCount>
inline Doubles polynomial(const double (&c)[kCount], const Doubles& x) {
  Doubles sum = Doubles{} + c[kCount - 1];
  for (int i = kCount - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

/// Natural logarithm of the ratio of positive normal numbers, within 2 ulp above 1.5; absolute
/// error 2e-16 below.
inline Doubles logOfRatio(const Doubles& x, const Doubles& y) {
  constexpr double kLog2 = 0x1.62e42fefa2p-1, kLog2Low = 0x1.9ef35793c7673p-41;
  constexpr double kRoot = 1.4142135623730951;
  constexpr double kOddInverses[] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11,
                                     1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21};
  const Bits of_x = (Bits)x, of_y = (Bits)y;
  // x / y = 2^power m / n, in (0.7, 1.42) the quotient. A power in the last bits of 2^52 is a
  // double of that number.
  Doubles power =
      (Doubles)(of_x >> 52 | 0x4330000000000000) - (Doubles)(of_y >> 52 | 0x4330000000000000);
  Doubles m = (Doubles)((of_x & 0xfffffffffffff) | 0x3ff0000000000000);
  Doubles n = (Doubles)((of_y & 0xfffffffffffff) | 0x3ff0000000000000);
  const Mask is_large = m > kRoot * n, is_small = n > kRoot * m;
  power = is_large ? power + 1.0 : is_small ? power - 1.0 : power;
  n = is_large ? n + n : n;
  m = is_small ? m + m : m;
  const Doubles s = (m - n) / (m + n), square = s * s;  // log(m / n) = 2 artanh(s)
  const Doubles rest = 2.0 * s * square * polynomial(kOddInverses, square);
  return power * kLog2 + (2.0 * s + (rest + power * kLog2Low));
}

/// Angle of (x, y), in [-pi, pi], with an absolute error of 4e-16; the sign of a zero y counts.
inline Doubles angleOf(const Doubles& y, const Doubles& x) {
  constexpr double kHalfTurn = 0x1.921fb54442d18p+1;
  constexpr double kSeries[] = {-1.0 / 3, 1.0 / 5,   -1.0 / 7, 1.0 / 9,   -1.0 / 11,
                                1.0 / 13, -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21};
  const Doubles zero = {};
  const Bits sign = (Bits{} + 0x8000000000000000) & (Bits)y;
  const Doubles across = y < zero ? -y : y, along = x < zero ? -x : x;
  const Mask is_steep = across > along;
  const Doubles low = is_steep ? along : across, high = is_steep ? across : along;
  // tan(a - b) = (tan(a) - tan(b)) / (1 + tan(a) tan(b)), b = 0, pi/8 or pi/4.
  const Mask above_first = low > 0.19891236737965801 * high;   // tan(pi/16)
  const Mask above_second = low > 0.66817863791929892 * high;  // tan(3 pi/16)
  const Doubles none = {}, first = none + 0.41421356237309505, one = none + 1.0;
  const Doubles tangent = above_second ? one : above_first ? first : none;
  const Doubles known = above_second  ? none + kHalfTurn / 4
                        : above_first ? none + kHalfTurn / 8
                                      : none;
  const Doubles below = high + tangent * low;
  const Doubles t = (low - tangent * high) / (below > zero ? below : one), square = t * t;
  Doubles angle = known + (t + t * square * polynomial(kSeries, square));
  angle = is_steep ? kHalfTurn / 2 - angle : angle;
  angle = x < zero ? kHalfTurn - angle : angle;
  return (Doubles)((Bits)angle | sign);
}

using Vectors = VectorsOf<Doubles>;

/// A panel seen from one point per lane, as PanelViews, and the distances of the corners.
struct LaneViews {
  Doubles height, solid_angle, corner_distance[3], edge_distance[3], edge_potential[3];
};

inline LaneViews viewFrom(const Vectors& at, const PanelNumbers& panel) {
  const Doubles zero = {}, one = zero + 1.0;
  LaneViews view;
  Vectors d[3];
  Doubles(&r)[3] = view.corner_distance;
  for (int k = 0; k < 3; ++k) {
    d[k] = inAllLanes<Doubles>(panel.corner[k]) - at;
    r[k] = squareRoot(dot(d[k], d[k]));
  }
  for (int k = 0; k < 3; ++k) {
    const Doubles sum = r[k] + r[(k + 1) % 3];
    const Doubles gap = sum - panel.edge_length[k];
    // On the edge itself the logarithm is infinite, but always multiplied by a distance of 0.
    const Mask is_off = gap > zero;
    view.edge_potential[k] =
        logOfRatio(is_off ? sum + panel.edge_length[k] : one, is_off ? gap : one);
    view.edge_distance[k] = dot(d[k], inAllLanes<Doubles>(panel.edge_normal[k]));
  }
  view.height = -dot(d[0], inAllLanes<Doubles>(panel.normal));
  const Doubles denominator =
      r[0] * r[1] * r[2] + dot(d[0], d[1]) * r[2] + dot(d[1], d[2]) * r[0] + dot(d[2], d[0]) * r[1];
  // van Oosterom and Strackee 1983, with the triple product -d0.(d1 x d2) = 2 area height.
  view.solid_angle = 2.0 * angleOf(2 * panel.area * view.height, denominator);
  return view;
}

constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kColumn[6] = {0, 1, 2, 1, 2, 2};  // of PanelTensors

/// a b^T + b a^T by the components of PanelTensors.
inline void setTwiceSymmetricPart(const double (&a)[3], const double (&b)[3], double (&to)[6]) {
  for (int c = 0; c < 6; ++c) to[c] = a[kRow[c]] * b[kColumn[c]] + b[kRow[c]] * a[kColumn[c]];
}

/// Adds the potentials of jumps whose weights at the corners are known.
inline void addWeighted(const Doubles (&weights)[3], const CornerJumps& jumps, int lane,
                        PanelPotentials& potentials) {
  for (int field = 0; field < 7; ++field) {
    double* to = potentials.at[field] + lane;
    const Doubles sum = weights[0] * jumps[0][field] + weights[1] * jumps[1][field];
    store(to, load(to) + (sum + weights[2] * jumps[2][field]));
  }
}

}  // namespace

void AMBIENT_KERNEL(viewPanel)(const PanelNumbers& panel, const PanelPoints& points, int count,
                               PanelViews& views) {
  for (int lane = 0; lane < count; lane += kWidth) {
    const LaneViews view = viewFrom(load(points.at, lane), panel);
    for (int k = 0; k < 3; ++k) {
      store(views.edge_potential[k] + lane, view.edge_potential[k]);
      store(views.edge_distance[k] + lane, view.edge_distance[k]);
    }
    store(views.height + lane, view.height);
    store(views.solid_angle + lane, view.solid_angle);
  }
}

// With R_k the distances of the corners, f_k and d_k potential and distance of edge k, m_k its
// normal, t_k its direction, h the height, O the solid angle, P = sum d_k f_k - h O: eq. (94) is
// P (2 I - n n^T) + h O n n^T + sum [h f_k (n m_k^T + m_k n^T) - d_k f_k m_k m_k^T
// - (R_k+1 - R_k) (t_k m_k^T + m_k t_k^T) / 2].
void AMBIENT_KERNEL(viewStokeslets)(const PanelNumbers& panel, const PanelPoints& points, int count,
                                    PanelTensors& tensors) {
  const double(&n)[3] = panel.normal;
  double across[3][6], bent[3][6], along[3][6], normals[6];
  setTwiceSymmetricPart(n, n, normals);
  for (int k = 0; k < 3; ++k) {
    const double(&m)[3] = panel.edge_normal[k];
    const double t[3] = {n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2],
                         n[0] * m[1] - n[1] * m[0]};
    setTwiceSymmetricPart(m, m, across[k]);
    setTwiceSymmetricPart(n, m, bent[k]);
    setTwiceSymmetricPart(t, m, along[k]);
  }
  for (int lane = 0; lane < count; lane += kWidth) {
    const LaneViews view = viewFrom(load(points.at, lane), panel);
    const Doubles lid = view.height * view.solid_angle;
    Doubles potential = -lid, of_bent[3], of_across[3], of_along[3];
    for (int k = 0; k < 3; ++k) {
      const Doubles by_distance = view.edge_distance[k] * view.edge_potential[k];
      potential += by_distance;
      of_bent[k] = view.height * view.edge_potential[k];
      of_across[k] = 0.5 * by_distance;
      of_along[k] = 0.5 * (view.corner_distance[(k + 1) % 3] - view.corner_distance[k]);
    }
    const Doubles of_normals = 0.5 * (lid - potential);
    for (int c = 0; c < 6; ++c) {
      Doubles sum = of_normals * normals[c];
      if (c < 3) sum += 2.0 * potential;
      for (int k = 0; k < 3; ++k)
        sum += of_bent[k] * bent[k][c] - (of_across[k] * across[k][c] + of_along[k] * along[k][c]);
      store(tensors.at[c] + lane, sum);
    }
  }
}

// The weight of the corner opposite edge j is l_j / (2 A) (d_j O + h sum_k m_j.m_k f_k).
void AMBIENT_KERNEL(addDoubleLayer)(const PanelNumbers& panel, const CornerJumps& jumps,
                                    const PanelPoints& points, int count,
                                    PanelPotentials& potentials) {
  double cosine[3][3];
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) {
      const double(&a)[3] = panel.edge_normal[j], (&b)[3] = panel.edge_normal[k];
      cosine[j][k] = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
  for (int lane = 0; lane < count; lane += kWidth) {
    const LaneViews view = viewFrom(load(points.at, lane), panel);
    Doubles weights[3];
    for (int corner = 0; corner < 3; ++corner) {
      const int j = (corner + 1) % 3;
      Doubles flux = cosine[j][0] * view.edge_potential[0] + cosine[j][1] * view.edge_potential[1];
      flux += cosine[j][2] * view.edge_potential[2];
      weights[corner] = panel.edge_length[j] / (2 * panel.area) *
                        (view.edge_distance[j] * view.solid_angle + view.height * flux);
    }
    addWeighted(weights, jumps, lane, potentials);
  }
}

void AMBIENT_KERNEL(addPointDipoles)(const PanelNumbers& panel, const PanelNodes& nodes,
                                     const CornerJumps& jumps, const PanelPoints& points, int count,
                                     PanelPotentials& potentials) {
  for (int lane = 0; lane < count; lane += kWidth) {
    const Vectors at = load(points.at, lane);
    Doubles weights[3] = {};
    for (int i = 0; i < PanelNodes::kCount; ++i) {
      const Vectors way = at - inAllLanes<Doubles>(nodes.place[i]);
      const Doubles square = dot(way, way);
      const Doubles kernel = nodes.weight[i] / (square * squareRoot(square));
      for (int corner = 0; corner < 3; ++corner) weights[corner] += nodes.hat[i][corner] * kernel;
    }
    const Doubles height =
        dot(at - inAllLanes<Doubles>(panel.corner[0]), inAllLanes<Doubles>(panel.normal));
    for (Doubles& weight : weights) weight *= panel.area * height;
    addWeighted(weights, jumps, lane, potentials);
  }
}

double AMBIENT_KERNEL(meanInverseDistance)(const PanelNodes& a, const PanelNodes& b) {
  constexpr int kLanes = 8;  // the last ones without weight
  double at[3][kLanes], weights[kLanes], sums[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    const int node = i < PanelNodes::kCount ? i : 0;
    for (int axis = 0; axis < 3; ++axis) at[axis][i] = a.place[node][axis];
    weights[i] = i < PanelNodes::kCount ? a.weight[i] : 0;
  }
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    const Vectors from = load(at, lane);
    Doubles sum = {};
    for (int j = 0; j < PanelNodes::kCount; ++j) {
      const Vectors way = from - inAllLanes<Doubles>(b.place[j]);
      sum += b.weight[j] / squareRoot(dot(way, way));
    }
    store(sums + lane, load(weights + lane) * sum);
  }
  return sumLanes(sums);
}

}  // namespace ambient
