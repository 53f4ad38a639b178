#include "preprocess/resistance/known_viscous_flow.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/resistance/resistance_tables.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {
namespace {

std::array<double*, SeparationWay::kNumbers> numbersOf(SeparationWay& way) {
  return {&way.wake_laminar, &way.wake_bubble,      &way.wake_turbulent,  &way.wake_rough,
          &way.thickness,    &way.friction_laminar, &way.friction_bubble, &way.friction_turbulent};
}

/// Layers of an ellipsoid whose axis `k` points along the motion.
SeparationWay ellipsoidLayersAlong(const Vector3& semi_axes, int k) {
  const double ratio =
      std::max(kLargestEllipsoidRatio, semi_axes.maxCoeff() / semi_axes.minCoeff());
  const double wider = portable::log(kLargestRatio) / portable::log(ratio);
  const auto [x, y] = BoxAxis{semi_axes[k], semi_axes[(k + 1) % 3], semi_axes[(k + 2) % 3]}.place();
  SeparationWay way;
  const auto numbers = numbersOf(way);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = ellipsoidLayers()[i](wider * x, wider * wider * (y + 1) - 1);
    *numbers[i] = i < 4 ? std::max(0.0, value * value * value) : portable::exp(value);
  }
  return way;
}

SeparationWay between(SeparationWay a, SeparationWay b, double share) {
  const auto first = numbersOf(a), second = numbersOf(b);
  for (std::size_t i = 0; i < first.size(); ++i) *first[i] += share * (*second[i] - *first[i]);
  return a;
}

CapsuleLayers capsuleLayersOf(double slenderness) {
  const auto& table = capsuleLayers();
  const auto next = std::find_if(table.begin() + 1, table.end() - 1, [&](const CapsuleLayers& row) {
    return row.slenderness >= slenderness;
  });
  const CapsuleLayers &low = *(next - 1), &high = *next;
  const double share =
      std::min(1.0, (slenderness - low.slenderness) / (high.slenderness - low.slenderness));
  return {slenderness, between(low.along, high.along, share),
          between(low.across, high.across, share)};
}

/// Layers that are alike both ways, of a body without edges; way(k) moves along its axis k.
template <class Way>
Separation smoothSeparation(const Matrix6& added_mass, const Way& way) {
  Separation separation;
  separation.axes = translationAxes(added_mass);
  separation.smooth_base = {1, 1, 1};
  for (int j = 0; j < 3; ++j) {
    int axis = 0;
    separation.axes.col(j).cwiseAbs().maxCoeff(&axis);
    separation.ways[2 * static_cast<std::size_t>(j)] =
        separation.ways[2 * static_cast<std::size_t>(j) + 1] = way(axis);
  }
  return separation;
}

KnownViscousFlow roundFlow(const RoundResistance& table, const TablePlace& place,
                           const Vector3& semi_axes, double height) {
  if (!place.isInside()) return {};
  const auto [x, y] = place;
  const Vector6 ellipsoid = ellipsoidResistance(semi_axes);
  Matrix6 R = Matrix6::Zero();
  R(0, 0) = R(1, 1) = ellipsoid[0] * table.w_y(x, y);
  R(2, 2) = ellipsoid[2] * table.w_z(x, y);
  R(3, 3) = R(4, 4) = ellipsoid[3] * table.v_x(x, y);
  R(5, 5) = ellipsoid[5] * table.v_z(x, y);
  if (table.coupling.rows > 0) {
    R(1, 3) = R(3, 1) = ellipsoid[3] * height * table.coupling(x, y);
    R(0, 4) = R(4, 0) = -R(1, 3);
  }
  return {R, {}, true};
}

}  // namespace

KnownViscousFlow ellipsoidViscousFlow(const Vector3& semi_axes, const Matrix6& added_mass) {
  const auto way = [&](int axis) { return ellipsoidLayersAlong(semi_axes, axis); };
  return {ellipsoidResistance(semi_axes).asDiagonal(), smoothSeparation(added_mass, way), true};
}

KnownViscousFlow boxViscousFlow(const Vector3& half_sizes) {
  if (half_sizes.maxCoeff() > kLargestRatio * half_sizes.minCoeff()) return {};
  const Vector3 ends = half_sizes.prod() * half_sizes.cwiseInverse();
  const Vector3 mean_squares =
      (2 * ends / ends.sum()).array() + 1;  // three times, over half_sizes^2
  Vector6 R = ellipsoidResistance(half_sizes.cwiseProduct(mean_squares.cwiseSqrt()));
  for (int k = 0; k < 3; ++k) {
    const auto [x, y] =
        BoxAxis{half_sizes[k], half_sizes[(k + 1) % 3], half_sizes[(k + 2) % 3]}.place();
    R[k] *= boxResistance().rotation(x, y);
    R[3 + k] *= boxResistance().translation(x, y);
  }
  return {Matrix6(R.asDiagonal()), {}, true};
}

KnownViscousFlow cylinderViscousFlow(double radius, double height, const Matrix6& added_mass) {
  const double side = height / (height + radius), ends = radius / (height + radius);
  const double across = radius * std::sqrt(3 * (side / 2 + ends / 4)),
               along = height * std::sqrt(3 * (side / 12 + ends / 4));
  KnownViscousFlow flow = roundFlow(cylinderResistance(), cylinderPlace(radius, height).place,
                                    {across, across, along}, height);
  flow.separation = cylinderSeparation(radius, height, translationAxes(added_mass));
  return flow;
}

KnownViscousFlow capsuleViscousFlow(double radius, double height, const Matrix6& added_mass) {
  KnownViscousFlow flow = roundFlow(capsuleResistance(), capsulePlace(radius, height).place,
                                    {radius, radius, height / 2 + radius}, height);
  const CapsuleLayers layers = capsuleLayersOf(height / (2 * radius));
  flow.separation = smoothSeparation(
      added_mass, [&](int axis) { return axis == 2 ? layers.along : layers.across; });
  return flow;
}

KnownViscousFlow coneViscousFlow(double radius, double height) {
  return roundFlow(coneResistance(), conePlace(radius, height, 0).place,
                   {radius, radius, height / 2}, height);
}

}  // namespace ambient
