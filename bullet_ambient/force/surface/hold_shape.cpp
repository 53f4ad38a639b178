#include "bullet_ambient/force/surface/hold_shape.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

HoldShape::HoldShape(const Hold& hold)
    : hull_(hold.surface), capacity_(hold.volume), turning_inertia_(hold.turning_inertia) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 normal = Vector3::Unit(axis);
    const auto [low, high] = computeExtent(hull_, normal);
    auto& middles = middles_[static_cast<std::size_t>(axis)];
    for (int i = 1; i < kLevels; ++i) {
      const double share = static_cast<double>(i) / kLevels;
      const HoldFill fill = fillHold(*this, normal, share * capacity_, low + share * (high - low));
      middles[static_cast<std::size_t>(i - 1)] = fill.water.waterplane.centroid;
    }
  }
}

double HoldShape::levelNear(const Vector3& normal, double volume) const noexcept {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const double share = volume / capacity_, below = normal[axis] > 0 ? share : 1 - share;
  const auto& middles = middles_[static_cast<std::size_t>(axis)];
  const double place = kLevels * below - 1;
  const auto i = static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, kLevels - 3));
  const Vector3 &low = middles[i], &high = middles[i + 1];
  return normal.dot(low + (place - static_cast<double>(i)) * (high - low));
}

namespace {

/// Moves a level to where its hold has a volume, by a way that is small against the hold.
void moveLevel(const Vector3& normal, double volume, HoldFill& fill) {
  WetVolume& water = fill.water;
  const double more = volume - water.volume, way = more / water.waterplane.area;
  water.moment += more * (water.waterplane.centroid + way / 2 * normal);
  water.depth_integral += way * (water.volume + more / 2);
  water.waterplane.centroid += way * normal;
  water.volume = volume;
  fill.height += way;
}

}  // namespace

HoldFill fillHold(const HoldShape& shape, const Vector3& normal, double volume,
                  double guess) noexcept {
  constexpr double kEmpty = 1e-12, kAccuracy = 1e-12;  // of the hold
  constexpr double kNear = 1e-7;  // of water or air: what Newton's last step leaves is its square
  constexpr int kMostClips = 60;  // bisections alone need fewer
  const double capacity = shape.capacity();
  AMBIENT_ASSERT(isUnit(normal) && capacity > 0);
  HoldFill fill;
  const auto clip = [&](double height) {
    fill.height = height;
    fill.water = computeWetVolume(shape.hull(), {normal, height, 0, 0});
    ++fill.clips;
  };
  double low = 0, high = 0;
  if (volume <= kEmpty * capacity || volume >= (1 - kEmpty) * capacity) {
    std::tie(low, high) = computeExtent(shape.hull(), normal);
    clip(volume <= kEmpty * capacity ? low : high);
    fill.water.waterplane = {};
    return fill;
  }
  double next = std::isnan(guess) ? shape.levelNear(normal, volume) : guess;
  const double near = kNear * std::min(volume, capacity - volume);
  while (fill.clips < kMostClips) {
    clip(next);
    const double error = fill.water.volume - volume, area = fill.water.waterplane.area;
    if (std::abs(error) <= kAccuracy * capacity) break;
    if (area > 0 && std::abs(error) <= near) {
      moveLevel(normal, volume, fill);
      return fill;
    }
    if (fill.clips == 1) std::tie(low, high) = computeExtent(shape.hull(), normal);
    if (low < next && next < high) (error > 0 ? high : low) = next;
    next = area > 0 ? next - error / area : low;
    if (!(low < next && next < high)) next = (low + high) / 2;
  }
  if (fill.water.volume > 0) fill.water.moment *= volume / fill.water.volume;
  fill.water.volume = volume;
  return fill;
}

WetVolume withWaterInside(WetVolume wet, const SurfacePlane& plane, const HoldFill& fill) noexcept {
  const WetVolume& water = fill.water;
  wet.volume -= water.volume;
  wet.moment -= water.moment;
  wet.depth_integral += (fill.height - plane.height) * water.volume - water.depth_integral;
  return wet;
}

namespace {

double tanhOf(double x) {
  const double part = portable::expm1(-2 * x);
  return -part / (2 + part);
}

/// Level of the water in a hold: its principal axes and the box with its moments.
struct Level {
  Level(const Waterplane& section, const Vector3& normal) {
    const PlaneAxes plane(normal);
    const Vector3 &e = plane.first, &f = plane.second;
    const Vector3 of_e = section.spread * e;
    const double xx = e.dot(of_e), xy = f.dot(of_e), yy = f.dot(section.spread * f);
    const double half = (xx - yy) / 2, size = std::sqrt(half * half + xy * xy);
    // From the row of the matrix that does not cancel.
    const double x = half > 0 ? half + size : std::abs(xy);
    const double y = half > 0 ? xy : std::copysign(size - half, xy);
    axis = size > 0 ? Vector3((x * e + y * f).normalized()) : e;
    for (int i = 0; i < 2; ++i) {
      constexpr double kSliver = 1e-12;  // of the area
      moments[i] = std::max(0.0, (xx + yy) / 2 + (i == 0 ? size : -size));
      squares[i] = std::max(12 * moments[i] / section.area, kSliver * section.area);
    }
  }

  /// Inertia of water of a depth below it that resists turning as in a closed box, per unit mass.
  /// `axes`: the principal ones and the normal, in the frame of the result.
  Matrix3 turningBelow(const Vector3 (&axes)[2], const Vector3& normal, double depth) const {
    const double square = depth * depth;
    const Vector3 &e = axes[0], &f = axes[1];
    return boxTurning(squares[1], square) * e * e.transpose() +
           boxTurning(squares[0], square) * f * f.transpose() +
           boxTurning(squares[0], squares[1]) * normal * normal.transpose();
  }

  Vector3 axis;       ///< of the larger moment; the other one is normal x axis
  double moments[2];  ///< of the area along the axes [m^4]
  double squares[2];  ///< of the sides of the box [m^2]
};

}  // namespace

HoldModes modesOf(const HoldShape& shape, const HoldFill& fill, const SurfacePlane& plane_F,
                  const FrameOffset& frame) noexcept {
  HoldModes found;
  const WetVolume& water = fill.water;
  const double volume = water.volume, area = water.waterplane.area;
  if (!(volume > 0)) return found;
  found.height = fill.height;
  const Matrix3& R = frame.rotation;
  const Vector3 centre_F = water.moment / volume, normal = R * plane_F.normal;
  found.centre = R * centre_F + frame.translation;
  const auto turnAsFull = [&](double part) {
    const double share = volume / shape.capacity(), root = portable::cbrt(share);
    return Matrix3(R * (part * share * root * root * shape.turningInertia()) * R.transpose());
  };
  const double mean = area > 0 && plane_F.gravity > 0 ? volume / area : 0;
  const double depth = std::min(mean, 2 * (fill.height - plane_F.normal.dot(centre_F)));
  if (!(depth > 0)) {
    found.turning = turnAsFull(1);
    return found;
  }
  found.middle = R * water.waterplane.centroid + frame.translation;
  const Level level(water.waterplane, plane_F.normal);
  const Vector3 along = R * level.axis, axes[2] = {along, normal.cross(along)};
  // Where the hold narrows above the water, it turns as the full one.
  const double open = depth / mean;
  constexpr double kRounding = 1e-12;
  found.turning = open * volume * level.turningBelow(axes, normal, depth);
  if (1 - open > kRounding) found.turning += turnAsFull(1 - open);
  const double cube = volume + area * std::sqrt(area);
  for (int i = 0; i < 2; ++i) {
    constexpr double kSliver = 1e-6;
    const double square = level.moments[i] / (kSliver * area);
    if (square * square * square < cube * cube) continue;
    SloshMode& mode = found.modes[i];
    const double length = std::sqrt(level.squares[i]), k = kPi / length;
    const double half = tanhOf(k * depth / 2);  // tanh 2x = 2 tanh x / (1 + tanh^2 x)
    const double wave_number_deep = k * 2 * half / (1 + half * half);
    mode.axis = axes[i];
    mode.length = length;
    mode.square = plane_F.gravity * wave_number_deep;
    mode.volume = wave_number_deep * level.moments[i];
    // The rest of the water keeps a positive inertia.
    constexpr double kMost = 0.9;
    const double turning = axes[1 - i].dot(found.turning * axes[1 - i]);
    const double most =
        std::sqrt(kMost * turning * (volume - mode.volume) / (mode.volume * volume));
    const double rise = std::clamp(depth / 2 - 2 / k * half, -most, most);
    mode.bob = found.centre + rise * normal;
    mode.pivot = mode.bob + normal / wave_number_deep;
    const double head = std::min(mean, (shape.capacity() - volume) / area);
    mode.farthest = 2 * head / (length * wave_number_deep);
  }
  return found;
}

Matrix6 carriedInertia(double volume, const HoldModes& modes) noexcept {
  const Vector3& centre = modes.centre;
  Matrix3 turning = modes.turning + volume * (centre.squaredNorm() * Matrix3::Identity() -
                                              centre * centre.transpose());
  Matrix3 coupling = volume * crossMatrix(centre), pushing = volume * Matrix3::Identity();
  for (const SloshMode& mode : modes.modes) {
    if (!(mode.volume > 0)) continue;
    const Vector3 arm = mode.bob.cross(mode.axis), part = mode.volume * mode.axis;
    turning -= arm * (mode.volume * arm).transpose();
    coupling -= arm * part.transpose();
    pushing -= part * mode.axis.transpose();
  }
  Matrix6 inertia;
  inertia.topLeftCorner<3, 3>() = turning;
  inertia.topRightCorner<3, 3>() = coupling;
  inertia.bottomLeftCorner<3, 3>() = coupling.transpose();
  inertia.bottomRightCorner<3, 3>() = pushing;
  return inertia;
}

std::vector<Vector3> cutAt(const Vector3& point, const Vector3& normal, const Surface& surface) {
  std::vector<Vector3> lines;
  for (std::size_t i = 0; i + 2 < surface.triangles.size(); i += 3) {
    Vector3 corners[3];
    double heights[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = vertexOf(surface, surface.triangles[i + k]);
      heights[k] = normal.dot(corners[k] - point);
    }
    const auto crossing = [&](bool goes_down) {
      int from = 0;
      while ((heights[from] > 0) != goes_down || (heights[(from + 1) % 3] > 0) == goes_down) ++from;
      const int to = (from + 1) % 3;
      const double share = heights[from] / (heights[from] - heights[to]);
      return Vector3(corners[from] + share * (corners[to] - corners[from]));
    };
    const auto above = std::count_if(heights, heights + 3, [](double h) { return h > 0; });
    if (above == 0 || above == 3) continue;
    lines.push_back(crossing(true));
    lines.push_back(crossing(false));
  }
  return lines;
}

}  // namespace ambient
