#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/resistance/separation.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

constexpr double kLaminarGrowth = 0.45, kLaminarLimit = -0.09;  // Thwaites 1949
constexpr double kTurbulentGrowth = 0.016,
                 kTurbulentLimit = -0.04;  // Buri 1931; the limit is chosen
constexpr double kThickest = 4;  // th2 over the length: nine times a plate's; streamlines that run
                                 // together in a hollow would let it grow without end
constexpr double kRecovery =
    0.4;  // of the dynamic pressure, that a turbulent layer follows in any case
constexpr double kCritical = 205;  // V theta / nu at laminar separation in the crisis
constexpr double kTurbulentShear = 0.0256;
constexpr double kNodeSpeed = 0.02;      // below, the flow is that of a stagnation point
constexpr double kStillSpeed = 1e-3;     // below, it has no direction
constexpr double kFrictionSpeed = 0.05;  // below, friction is left out
constexpr double kRough = 4;             // growth of a rough layer over that of a smooth one

/// Separation of one layer along a streamline.
struct Departure {
  double progress =
      0;  ///< largest value of its criterion so far; 1: it leaves here, above: it has left
  double speed = 0;  ///< of the flow outside where it left; ahead of it the speed here

  bool hasLeft() const { return progress >= 1; }
};

/// Layers at a vertex. Linear means of these are their values between vertices.
struct Layers {
  double laminar = 0;                 ///< th2 of eq. (97)
  std::array<double, 2> turbulent{};  ///< Theta of eq. (98) from the nose, smooth and rough
  double bubble = 0;                  ///< Theta behind laminar separation
  Departure leaves_laminar, leaves_bubble;
  std::array<Departure, 2> leaves_turbulent;
  double thickness = 0;  ///< sqrt(th2) where the laminar layer left
  double largest_speed = 0;
  double edge = 0;  ///< 1: the streamline has crossed a sharp edge
};

double mix(double a, double b, double share) { return a + share * (b - a); }

Departure mix(const Departure& a, const Departure& b, double share) {
  return {mix(a.progress, b.progress, share), mix(a.speed, b.speed, share)};
}

Layers mix(const Layers& a, const Layers& b, double share) {
  Layers m;
  m.laminar = mix(a.laminar, b.laminar, share);
  m.bubble = mix(a.bubble, b.bubble, share);
  m.leaves_laminar = mix(a.leaves_laminar, b.leaves_laminar, share);
  m.leaves_bubble = mix(a.leaves_bubble, b.leaves_bubble, share);
  for (std::size_t i = 0; i < m.turbulent.size(); ++i) {
    m.turbulent[i] = mix(a.turbulent[i], b.turbulent[i], share);
    m.leaves_turbulent[i] = mix(a.leaves_turbulent[i], b.leaves_turbulent[i], share);
  }
  m.thickness = mix(a.thickness, b.thickness, share);
  m.largest_speed = mix(a.largest_speed, b.largest_speed, share);
  m.edge = mix(a.edge, b.edge, share);
  return m;
}

/// The flow at a vertex, along its streamline.
struct Stream {
  double speed = 0;                       ///< U
  double gradient = 0;                    ///< U'
  double divergence = 0;                  ///< div u
  Vector3d direction = Vector3d::Zero();  ///< of u

  explicit Stream(const VertexFlow& flow)
      : speed(flow.velocity.norm()), divergence(flow.stretching.trace()) {
    if (!(speed > 0)) return;
    direction = flow.velocity / speed;
    gradient = direction.dot(flow.stretching * direction);
  }

  /// Rate at which th2 decays in the time of a particle.
  double laminarDecay() const {
    return speed < kNodeSpeed ? 4 * divergence : 4 * gradient + 2 * divergence;
  }
  /// Rate at which Theta decays.
  double turbulentDecay() const {
    return speed < kNodeSpeed ? 2.625 * divergence : 4 * gradient + 1.25 * (divergence - gradient);
  }
};

/// Where the streamline through a vertex comes from: a point of the far edge of one of its
/// triangles.
struct Origin {
  int a = -1, b = -1;   ///< ends of that edge; -1: none of its triangles
  double share = 0;     ///< of b
  double distance = 0;  ///< along the streamline

  bool isFound() const { return a >= 0; }
};

/// One step of a linear equation y' = source - decay y over a time, exact for constant
/// coefficients.
double grown(double y, double decay, double source, double time) {
  constexpr double kLargest = 50;  // keeps what has long separated finite
  const double power = std::min(std::max(-decay * time, -kLargest), kLargest);
  const double response = std::abs(power) > 1e-6 ? portable::expm1(power) / power * time : time;
  return y * portable::exp(power) + source * response;
}

/// The layers of one flow.
class LayerMarch {
 public:
  LayerMarch(const CutSurface& surface, const std::vector<VertexFlow>& flow, const Vector3d& motion)
      : surface_(surface), flow_(flow) {
    const Eigen::RowVectorXd along = motion.transpose() * surface.mesh.vertices;
    thickest_ = kThickest * (along.maxCoeff() - along.minCoeff());
    const std::size_t count = flow.size();
    AMBIENT_ASSERT(count == surface.source.size());
    streams_.reserve(count);
    for (const VertexFlow& at : flow) streams_.emplace_back(at);
    for (std::size_t v = 0; v < count; ++v) origins_.push_back(findOrigin(static_cast<int>(v)));
    layers_.resize(count);
    is_done_.assign(count, false);
    for (const int v : downstream()) {
      layers_[v] = layersAt(v);
      is_done_[v] = true;
    }
  }

  const Layers& layers(int vertex) const { return layers_[vertex]; }
  const Stream& stream(int vertex) const { return streams_[vertex]; }

 private:
  /// Vertices in the order of the potential. At a sharp edge those that the flow reaches come
  /// before those that it leaves.
  std::vector<int> downstream() const {
    std::vector<int> order(flow_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return std::tuple(flow_[a].potential, !origins_[a].isFound(), a) <
             std::tuple(flow_[b].potential, !origins_[b].isFound(), b);
    });
    return order;
  }

  /// Direction of the flow; where it is still, from the neighbour of the lowest potential.
  Vector3d directionAt(int vertex) const {
    if (streams_[vertex].speed > kStillSpeed) return streams_[vertex].direction;
    int lowest = vertex;
    for (const int t : surface_.fans[vertex])
      for (int k = 0; k < 3; ++k) {
        const int other = surface_.mesh.triangles(k, t);
        if (flow_[other].potential < flow_[lowest].potential) lowest = other;
      }
    const Vector3d way = surface_.mesh.vertices.col(vertex) - surface_.mesh.vertices.col(lowest);
    return lowest == vertex ? Vector3d(0, 0, 0) : Vector3d(way.normalized());
  }

  /// Looks back along the streamline, through the triangle in which it lies best: with the largest
  /// smaller barycentric weight. A narrow gap between triangles goes to the nearer one.
  Origin findOrigin(int vertex) const {
    constexpr double kWorst = -0.3;
    const Vector3d p = surface_.mesh.vertices.col(vertex), back = -directionAt(vertex);
    Origin best;
    double quality = kWorst;
    for (const int t : surface_.fans[vertex]) {
      int k = 0;
      while (surface_.mesh.triangles(k, t) != vertex) ++k;
      const int a = surface_.mesh.triangles((k + 1) % 3, t),
                b = surface_.mesh.triangles((k + 2) % 3, t);
      const Vector3d to_a = Vector3d(surface_.mesh.vertices.col(a)) - p,
                     to_b = Vector3d(surface_.mesh.vertices.col(b)) - p;
      const double aa = to_a.squaredNorm(), ab = to_a.dot(to_b), bb = to_b.squaredNorm();
      const double determinant = aa * bb - ab * ab;
      if (!(determinant > 0)) continue;
      const double ra = to_a.dot(back), rb = to_b.dot(back);
      const double x = (bb * ra - ab * rb) / determinant, y = (aa * rb - ab * ra) / determinant;
      if (!(x + y > 0) || !(std::min(x, y) / (x + y) > quality)) continue;
      quality = std::min(x, y) / (x + y);
      const double inside_x = std::max(x, 0.0), inside_y = std::max(y, 0.0);
      best = {a, b, inside_y / (inside_x + inside_y), 1 / (inside_x + inside_y)};
    }
    return best;
  }

  /// Layers that begin at a vertex: a nose.
  Layers noseAt(int vertex) const {
    constexpr double kLeastDecay = 1e-3;
    const Stream& stream = streams_[vertex];
    Layers layers;
    layers.laminar =
        std::min(kLaminarGrowth / std::max(stream.laminarDecay(), kLeastDecay), thickest_);
    const double turbulent =
        kTurbulentGrowth * stream.speed / std::max(stream.turbulentDecay(), kLeastDecay);
    layers.turbulent = {turbulent, kRough * turbulent};
    layers.leaves_laminar.speed = layers.leaves_bubble.speed = stream.speed;
    for (Departure& leaves : layers.leaves_turbulent) leaves.speed = stream.speed;
    layers.thickness = std::sqrt(layers.laminar);
    layers.largest_speed = stream.speed;
    return layers;
  }

  /// Layers behind a sharp edge that the flow has crossed: all have left there.
  Layers beyondEdge(int before) const {
    Layers layers = layers_[before];
    const double speed = streams_[before].speed;
    const auto leave = [&](Departure& leaves) {
      if (!leaves.hasLeft()) leaves = {2, speed};
    };
    leave(layers.leaves_laminar);
    leave(layers.leaves_bubble);
    for (Departure& leaves : layers.leaves_turbulent) leave(leaves);
    layers.edge = 1;
    return layers;
  }

  /// A vertex of the same place whose flow comes over its own side; -1: none.
  int vertexBefore(int vertex) const {
    for (const int other : surface_.copies[vertex])
      if (is_done_[other] && origins_[other].isFound()) return other;
    return -1;
  }

  Layers layersAt(int vertex) const {
    const Origin& origin = origins_[vertex];
    const bool has_a = origin.isFound() && is_done_[origin.a],
               has_b = origin.isFound() && is_done_[origin.b];
    if (!has_a && !has_b) {
      const int before = vertexBefore(vertex);
      return before >= 0 ? beyondEdge(before) : noseAt(vertex);
    }
    const Stream& here = streams_[vertex];
    if (here.speed < kStillSpeed && here.divergence > 0) return noseAt(vertex);
    return followed(vertex, !has_a ? 1 : !has_b ? 0 : origin.share);
  }

  /// Carries a departure on to a vertex where its criterion is `now`.
  /// @return the share of the way after which the layer left, 1 if it has not or had before
  static double carry(Departure& leaves, double now, double speed_before, double speed) {
    constexpr double kMost = 3;
    if (leaves.hasLeft()) return 1;
    if (now <= 1) {
      leaves = {std::max(leaves.progress, now), speed};
      return 1;
    }
    const double share = (1 - leaves.progress) / (now - leaves.progress);
    leaves = {std::min(now, kMost), mix(speed_before, speed, share)};
    return share;
  }

  Layers followed(int vertex, double share) const {
    const Origin& origin = origins_[vertex];
    const Stream &here = streams_[vertex], &a = streams_[origin.a], &b = streams_[origin.b];
    Layers layers = mix(layers_[origin.a], layers_[origin.b], share);
    const double speed_before = mix(a.speed, b.speed, share);
    const double speed = std::max((here.speed + speed_before) / 2, 1e-6),
                 time = origin.distance / speed;
    const double laminar_decay =
        (here.laminarDecay() + mix(a.laminarDecay(), b.laminarDecay(), share)) / 2;
    const double turbulent_decay =
        (here.turbulentDecay() + mix(a.turbulentDecay(), b.turbulentDecay(), share)) / 2;
    layers.largest_speed = std::max(layers.largest_speed, here.speed);
    const double fall = here.speed / std::max(layers.largest_speed, 1e-9),
                 recovered = (1 - fall * fall) / kRecovery;
    const double slowing = here.gradient / std::max(here.speed, 1e-6);  // U'/U

    bool leaves_here = false;
    double left_share = 1;
    if (!layers.leaves_laminar.hasLeft()) {
      const double before = layers.laminar;
      layers.laminar = std::min(grown(before, laminar_decay, kLaminarGrowth, time), thickest_);
      left_share = carry(layers.leaves_laminar, layers.laminar * here.gradient / kLaminarLimit,
                         speed_before, here.speed);
      leaves_here = layers.leaves_laminar.hasLeft();
      layers.thickness = std::sqrt(
          std::max(leaves_here ? mix(before, layers.laminar, left_share) : layers.laminar, 0.0));
    }
    for (std::size_t i = 0; i < layers.turbulent.size(); ++i) {
      const double roughness = i == 0 ? 1 : kRough,
                   relief = i == 0 ? 1 : portable::pow(kRough, 0.7);
      if (layers.leaves_turbulent[i].hasLeft()) continue;
      layers.turbulent[i] =
          grown(layers.turbulent[i], turbulent_decay, roughness * kTurbulentGrowth * speed, time);
      carry(layers.leaves_turbulent[i],
            std::min(layers.turbulent[i] * slowing / kTurbulentLimit, recovered * relief),
            speed_before, here.speed);
    }
    if (layers.leaves_laminar.hasLeft() && !layers.leaves_bubble.hasLeft()) {
      double rest = time;
      if (leaves_here) {
        const double left_speed = layers.leaves_laminar.speed;
        layers.bubble = layers.thickness * layers.thickness / kCritical *
                        std::sqrt(std::sqrt(kCritical * std::max(left_speed, 0.0)));
        rest = (1 - left_share) * time;
      }
      layers.bubble = grown(layers.bubble, turbulent_decay, kTurbulentGrowth * speed, rest);
      carry(layers.leaves_bubble, std::min(layers.bubble * slowing / kTurbulentLimit, recovered),
            speed_before, here.speed);
    } else if (!layers.leaves_laminar.hasLeft()) {
      layers.leaves_bubble.speed = here.speed;
    }
    return layers;
  }

  const CutSurface& surface_;
  const std::vector<VertexFlow>& flow_;
  std::vector<Stream> streams_;
  std::vector<Origin> origins_;
  std::vector<Layers> layers_;
  std::vector<bool> is_done_;
  double thickest_ = 0;  // largest th2
};

/// Share of a triangle where a linear function with these values at the corners is above 1.
double shareAbove(std::array<double, 3> values) {
  std::sort(values.begin(), values.end());
  const double a = values[0] - 1, b = values[1] - 1, c = values[2] - 1;
  if (a >= 0) return 1;
  if (c <= 0) return 0;
  return b <= 0 ? c * c / ((c - b) * (c - a)) : 1 - a * a / ((b - a) * (c - a));
}

/// Sums over the triangles of a surface.
class LayerIntegrals {
 public:
  LayerIntegrals(const CutSurface& surface, const LayerMarch& march, const Vector3d& motion)
      : surface_(surface), march_(march), motion_(motion) {
    for (std::size_t t = 0; t < surface.area.size(); ++t)
      front_ += std::abs(surface.triangle_normals[t].dot(motion)) * surface.area[t] / 2;
  }

  /// k of eq. (99): the part of the lee behind separation, times its mean of the squared speed at
  /// separation.
  template <class DepartureOf>
  double wake(const DepartureOf& of) const {
    double area = 0, pressure = 0;
    for (int t = 0; t < count(); ++t) {
      const double part = leftShare(t, of) * lee(t);
      if (!(part > 0)) continue;
      area += part;
      pressure += part * meanOver(
                             t, [&](int v) { return of(v).hasLeft(); },
                             [&](int v) { return of(v).speed * of(v).speed; });
    }
    return area / front_ * pressure / front_;
  }

  /// Friction along the motion where a layer is, on the frontal area.
  template <class BeganAt, class DepartureOf, class StressAt>
  double friction(const BeganAt& began, const DepartureOf& of, const StressAt& stress) const {
    double sum = 0;
    for (int t = 0; t < count(); ++t) {
      const double part = (began(t) - leftShare(t, of)) * surface_.area[t];
      if (!(part > 0)) continue;
      sum +=
          part *
          meanOver(
              t, [&](int v) { return march_.stream(v).speed > kFrictionSpeed && !of(v).hasLeft(); },
              [&](int v) { return -stress(v) * march_.stream(v).direction.dot(motion_); });
    }
    return sum / front_;
  }

  /// Share of a triangle that lies behind separation.
  template <class DepartureOf>
  double leftShare(int t, const DepartureOf& of) const {
    return shareAbove(
        {of(vertex(t, 0)).progress, of(vertex(t, 1)).progress, of(vertex(t, 2)).progress});
  }

  /// Place of the line along which a layer leaves, as in LayerPlaces.
  template <class DepartureOf>
  double placeOf(const DepartureOf& of) const {
    double length = 0, sum = 0;
    for (int t = 0; t < count(); ++t) {
      std::array<Vector3d, 2> ends;
      std::size_t crossed = 0;
      for (int k = 0; k < 3 && crossed < 2; ++k) {
        const int a = vertex(t, k), b = vertex(t, (k + 1) % 3);
        const double before = of(a).progress, behind = of(b).progress;
        if ((before < 1) == (behind < 1)) continue;
        const double share = (1 - before) / (behind - before);
        ends[crossed++] = place(a) + share * (place(b) - place(a));
      }
      if (crossed < 2) continue;
      const double of_line = (ends[1] - ends[0]).norm();
      length += of_line;
      sum += of_line * (ends[0] + ends[1]).dot(motion_) / 2;
    }
    const auto along = (motion_.transpose() * surface_.mesh.vertices).eval();
    const double front = along.maxCoeff(), back = along.minCoeff();
    return length > 0 ? (front - sum / length) / (front - back) : 1;
  }

  /// Area of a triangle that is seen from behind.
  double lee(int t) const {
    return std::max(-surface_.triangle_normals[t].dot(motion_), 0.0) * surface_.area[t];
  }

  /// Mean of a function over those corners of a triangle that count; 0 if none does.
  template <class Counts, class ValueAt>
  double meanOver(int t, const Counts& counts, const ValueAt& value_at) const {
    double sum = 0;
    int corners = 0;
    for (int k = 0; k < 3; ++k) {
      const int v = vertex(t, k);
      if (!counts(v)) continue;
      sum += value_at(v);
      ++corners;
    }
    return corners > 0 ? sum / corners : 0;
  }

  int count() const { return static_cast<int>(surface_.area.size()); }

 private:
  int vertex(int t, int k) const { return surface_.mesh.triangles(k, t); }
  Vector3d place(int v) const { return surface_.mesh.vertices.col(v); }

  const CutSurface& surface_;
  const LayerMarch& march_;
  const Vector3d& motion_;
  double front_ = 0;
};

/// c_f sqrt(Re) of Thwaites' layer, on the speed of the body.
double laminarStress(const Layers& layers, const Stream& stream) {
  const double lambda = layers.laminar * stream.gradient,
               shear = std::max(lambda - kLaminarLimit, 0.0);
  return 2 * stream.speed * portable::pow(shear, 0.62) / std::sqrt(std::max(layers.laminar, 1e-9));
}

/// c_f Re^(1/5) of Buri's layer with Blasius' friction.
double turbulentStress(double theta, double speed) {
  return kTurbulentShear * speed * speed / portable::pow(std::max(speed * theta, 1e-9), 0.2);
}

}  // namespace

LayerSums followLayers(const CutSurface& surface, const std::vector<VertexFlow>& flow,
                       const Vector3d& motion) {
  const LayerMarch march(surface, flow, motion);
  const LayerIntegrals integrals(surface, march, motion);
  const auto laminar = [&](int v) { return march.layers(v).leaves_laminar; };
  const auto bubble = [&](int v) { return march.layers(v).leaves_bubble; };
  const auto turbulent = [&](int v) { return march.layers(v).leaves_turbulent[0]; };
  const auto rough = [&](int v) { return march.layers(v).leaves_turbulent[1]; };
  const auto everywhere = [](int) { return 1.0; };

  LayerSums sums;
  sums.leaves_at = {integrals.placeOf(laminar), integrals.placeOf(turbulent)};
  SeparationWay& way = sums.way;
  way.wake_laminar = integrals.wake(laminar);
  way.wake_bubble = integrals.wake(bubble);
  way.wake_turbulent = integrals.wake(turbulent);
  way.wake_rough = integrals.wake(rough);
  way.friction_laminar = integrals.friction(
      everywhere, laminar, [&](int v) { return laminarStress(march.layers(v), march.stream(v)); });
  way.friction_turbulent = integrals.friction(everywhere, turbulent, [&](int v) {
    return turbulentStress(march.layers(v).turbulent[0], march.stream(v).speed);
  });
  way.friction_bubble = integrals.friction(
      [&](int t) { return integrals.leftShare(t, laminar); }, bubble,
      [&](int v) {
        return laminar(v).hasLeft() ? turbulentStress(march.layers(v).bubble, march.stream(v).speed)
                                    : 0;
      });
  for (double* friction : {&way.friction_laminar, &way.friction_bubble, &way.friction_turbulent}) {
    sums.is_resolved = sums.is_resolved && *friction >= 0;
    *friction = std::max(*friction, 0.0);
  }

  double thickness = 0, thickest = 0;
  for (int t = 0; t < integrals.count(); ++t) {
    const double part = integrals.leftShare(t, laminar) * integrals.lee(t);
    const auto always = [](int) { return true; };
    const auto has_left = [&](int v) { return laminar(v).hasLeft(); };
    thickest = std::max(
        thickest, integrals.meanOver(t, always, [&](int v) { return march.layers(v).thickness; }));
    if (!(part > 0)) continue;
    sums.base += part;
    sums.smooth_base +=
        part * integrals.meanOver(t, has_left, [&](int v) { return 1 - march.layers(v).edge; });
    thickness +=
        part * integrals.meanOver(t, has_left, [&](int v) { return march.layers(v).thickness; });
  }
  way.thickness = sums.base > 0 ? thickness / sums.base : thickest;
  return sums;
}

}  // namespace ambient
