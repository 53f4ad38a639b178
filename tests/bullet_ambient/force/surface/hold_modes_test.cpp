#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/surface/hold_shape.h"
#include "bullet_ambient/spatial/rotation.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/vessel_bodies.h"

// Against potential flow: the first frequency and the mass that moves with it, of boxes and
// cylinders (N. Abramson, NASA SP-106) and half balls; of round canals and V's (H. Lamb, Art. 258),
// and by Ritz's method where the comment says so.
namespace ambient::test {
namespace {

constexpr double kPull = 9.81;

Hold holdOf(const Triangulation& mesh) {
  Hold hold;
  double volume = 0;
  Vector3 moment(0, 0, 0);
  for (const Vector3& place : mesh.vertices)
    hold.surface.vertices.insert(hold.surface.vertices.end(), place.data(), place.data() + 3);
  for (const auto& t : mesh.triangles) {
    hold.surface.triangles.own().insert(hold.surface.triangles.end(), {t[0], t[1], t[2]});
    const auto corner = [&](int i) -> const Vector3& {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
    };
    const double part = corner(0).dot(corner(1).cross(corner(2))) / 6;
    volume += part;
    moment += part / 4 * (corner(0) + corner(1) + corner(2));
  }
  hold.volume = volume;
  hold.centre = moment / volume;
  return hold;
}

/// A convex outline in the plane of u and v, counter-clockwise seen against u x v, extruded along
/// that by a length, half to each side.
Hold prism(const std::vector<std::pair<double, double>>& outline, const Vector3& u,
           const Vector3& v, double length) {
  Triangulation mesh;
  const int count = static_cast<int>(outline.size());
  const Vector3 way = length * u.cross(v);
  for (const int side : {-1, 1})
    for (const auto& [a, b] : outline) mesh.vertices.push_back(a * u + b * v + side * way / 2);
  for (int i = 0; i < count; ++i) {
    const int j = (i + 1) % count;
    mesh.triangles.push_back({i, j, count + j});
    mesh.triangles.push_back({i, count + j, count + i});
    if (i == 0 || j == 0) continue;
    mesh.triangles.push_back({0, j, i});
    mesh.triangles.push_back({count, count + i, count + j});
  }
  return holdOf(mesh);
}

/// A round outline of radius 1.
std::vector<std::pair<double, double>> circle() {
  std::vector<std::pair<double, double>> outline;
  for (int i = 0; i < 200; ++i)
    outline.emplace_back(std::cos(2 * kPi * i / 200), std::sin(2 * kPi * i / 200));
  return outline;
}

struct Filled {
  Filled(const Hold& hold, double share, const Vector3& up = {0, 0, 1})
      : plane{up, 0, 1000, kPull},
        shape(hold),
        fill(fillHold(shape, up, share * hold.volume, std::numeric_limits<double>::quiet_NaN())),
        modes(modesOf(shape, fill, plane)) {}

  /// The mode along a direction.
  const SloshMode& along(const Vector3& direction) const {
    const SloshMode& first = modes.modes[0];
    return std::abs(first.axis.dot(direction)) > 0.7 ? first : modes.modes[1];
  }
  double share(const SloshMode& mode) const { return mode.volume / fill.water.volume; }

  SurfacePlane plane;
  HoldShape shape;
  HoldFill fill;
  HoldModes modes;
};

TEST(HoldModes, OfBoxesAreExact) {
  for (const double depth : {0.05, 0.2, 0.5, 1.0}) {
    const Filled box(boxHold({1, 0.7, 2}, {0.3, -0.1, 0.2}), depth / 2);
    for (const int i : {0, 1}) {
      const double length = i == 0 ? 1 : 0.7, k = kPi / length;
      const SloshMode& mode = box.along(Vector3::Unit(i));
      EXPECT_NEAR(mode.square, kPull * k * std::tanh(k * depth), 1e-10) << depth;
      const double exact = 8 * std::tanh(k * depth) / (kPi * kPi * kPi * depth) * length;
      EXPECT_NEAR(box.share(mode), exact, 0.016 * exact) << "pi^2 / 12 for 8 / pi^2";
      // Graham and Rodriguez: the mass moves in a depth of 2 tanh(k d / 2) / k.
      EXPECT_NEAR(mode.bob.z(), -0.8 + depth - 2 / k * std::tanh(k * depth / 2), 1e-12);
      EXPECT_NEAR(mode.pivot.z() - mode.bob.z(), kPull / mode.square, 1e-12);
      // The centroid moves by i / V in a slope of 1, as it does in a tilt.
      EXPECT_NEAR(box.share(mode) * kPull / mode.square, length * length / 12 / depth, 1e-12);
    }
  }
}

TEST(HoldModes, OfCylindersAreNear) {
  constexpr double kRoot = 1.8411838;  // of the derivative of J_1
  for (const double depth : {0.2, 0.5, 1.0, 2.0}) {
    const Filled tub(prism(circle(), {1, 0, 0}, {0, 1, 0}, 4), depth / 4);
    for (const SloshMode& mode : tub.modes.modes) {
      const double exact = kPull * kRoot * std::tanh(kRoot * depth);
      EXPECT_NEAR(std::sqrt(mode.square / exact), 1, 0.015) << depth;
      const double moved = 2 * std::tanh(kRoot * depth) / (kRoot * depth * (kRoot * kRoot - 1));
      EXPECT_NEAR(tub.share(mode), moved, 0.017 * moved);
    }
  }
}

TEST(HoldModes, OfAHalfBallHangsFromItsMiddle) {
  const Filled ball(holdOf(geodesicSphere(4)), 0.5);
  for (const SloshMode& mode : ball.modes.modes) {
    EXPECT_NEAR(std::sqrt(mode.square / (1.5602 * kPull)), 1, 0.015);
    // A ball that turns about its middle does not move the water.
    EXPECT_LT(mode.pivot.norm(), 0.03);
  }
  // Nor does it once it is full: as ice it would have 0.57 of its mass.
  const Filled full(holdOf(geodesicSphere(4)), 0.999);
  EXPECT_LT(full.modes.turning.norm(), 0.04 * full.fill.water.volume);
}

// omega^2 in units of g and the radius, by Ritz's method but for that of half a canal and the V.
TEST(HoldModes, OfCanalsErrBySevenPerCentAtMost) {
  const Vector3 x(1, 0, 0), z(0, 0, 1);
  const auto segment = [](double depth) {
    const double half = std::acos(1 - depth);
    return (half - std::sin(2 * half) / 2) / kPi;
  };
  for (const auto& [depth, exact] :
       {std::pair(0.25, 1.0562), {0.5, 1.1280}, {1.0, 1.3557}, {1.5, 1.8989}}) {
    const Filled canal(prism(circle(), x, z, 30), segment(depth));
    EXPECT_NEAR(std::sqrt(canal.along(x).square / (exact * kPull)), 1, 0.07) << depth;
  }
  for (const auto& [slope, exact] : {std::pair(1.0, 1.0), {2.0, 2.5648}, {0.5, 0.3188}}) {
    const Filled canal(prism({{0, 0}, {2 / slope, 2}, {-2 / slope, 2}}, x, z, 30), 0.25);
    EXPECT_NEAR(std::sqrt(canal.along(x).square / (exact * kPull)), 1, 0.062) << slope;
  }
  for (const auto& [bottom, exact] : {std::pair(0.3, 0.8028), {0.7, 0.9806}, {1.4, 1.0439}}) {
    const Filled canal(prism({{bottom, 0}, {1, 0.5}, {-1, 0.5}, {-bottom, 0}}, x, z, 30), 1 - 1e-9);
    EXPECT_NEAR(std::sqrt(canal.along(x).square / (exact * kPull)), 1, 0.042) << bottom;
  }
}

/// Whether a motion of the vessel has a positive energy, whatever it is.
bool isSemidefinite(const Matrix6& inertia) {
  Vector6 scale;
  for (int i = 0; i < 6; ++i) scale[i] = 1 / std::sqrt(inertia(i, i));
  const Matrix6 unit = scale.asDiagonal() * inertia * scale.asDiagonal();
  return symmetricEigen<6>(unit).values[0] > 0;
}

TEST(HoldModes, LeaveAPositiveInertia) {
  Arbitrary arbitrary(21);
  const Hold ball = holdOf(geodesicSphere(2));
  for (int i = 0; i < 300; ++i) {
    const Vector3 size(arbitrary.between(0.1, 10), arbitrary.between(0.1, 10),
                       arbitrary.between(0.01, 10));
    const Vector3 up = arbitrary.vector().normalized();
    for (const Hold& hold : {boxHold(size, {0, 0, 0}), ball}) {
      const Filled some(hold, arbitrary.between(0.01, 0.99), up);
      HoldModes modes = some.modes;
      for (SloshMode& mode : modes.modes) mode.bob -= modes.centre;
      modes.centre.setZero();
      EXPECT_TRUE(isSemidefinite(carriedInertia(some.fill.water.volume, modes)))
          << size << ' ' << up;
    }
  }
}

TEST(HoldModes, TurnWithTheHold) {
  const Vector3 size(1, 0.6, 0.8);
  const Vector3 up = Vector3(0.3, -0.2, 1).normalized();
  const Filled one(boxHold(size, {0, 0, 0}), 0.4, up);
  Hold turned = boxHold(size, {0, 0, 0});
  const Matrix3 R = rotationFromVector(Vector3(0.4, -1, 0.7)).toRotationMatrix();
  for (std::size_t i = 0; i < turned.surface.vertices.size(); i += 3) {
    Eigen::Map<Vector3> place(&turned.surface.vertices[i]);
    place = (R * place).eval();
  }
  turned.turning_inertia = R * turned.turning_inertia * R.transpose();
  const Filled other(turned, 0.4, R * up);
  const Matrix6 inertia = carriedInertia(one.fill.water.volume, one.modes);
  Matrix6 to_turned = Matrix6::Zero();
  to_turned.topLeftCorner<3, 3>() = to_turned.bottomRightCorner<3, 3>() = R;
  EXPECT_LT((carriedInertia(other.fill.water.volume, other.modes) -
             to_turned * inertia * to_turned.transpose())
                .norm(),
            1e-11 * inertia.norm());
  for (const SloshMode& mode : one.modes.modes) {
    const SloshMode& same = other.along(R * mode.axis);
    EXPECT_NEAR(same.square, mode.square, 1e-10 * mode.square);
    EXPECT_LT((same.pivot - R * mode.pivot).norm(), 1e-10);
  }
}

TEST(HoldModes, AreNoneWithoutASurface) {
  const Hold box = boxHold({1, 0.7, 2}, {0, 0, 0});
  for (const double share : {0.0, 1.0}) {
    const Filled some(box, share);
    for (const SloshMode& mode : some.modes.modes) EXPECT_EQ(mode.volume, 0);
  }
  EXPECT_LT((Filled(box, 1).modes.turning - box.turning_inertia).norm(), 1e-12);
  // A box resists turning as a full one once it is nearly full.
  EXPECT_LT((Filled(box, 1 - 1e-9).modes.turning - box.turning_inertia).norm(), 1e-6);
}

}  // namespace
}  // namespace ambient::test
