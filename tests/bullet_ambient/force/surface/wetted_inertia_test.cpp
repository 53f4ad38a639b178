#include "bullet_ambient/force/surface/wetted_inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/force/kernels/part_sums.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

/// A body and its inertia as a function of the surface plane.
class Wetted {
 public:
  explicit Wetted(const FluidBody& body)
      : body_(std::make_shared<const FluidBody>(body)),
        hull_(body),
        inertia_(makeWettedInertia(body_)) {}

  Immersion at(const Vector3& normal, double height) const {
    Immersion immersion{{normal.normalized(), height, 1000, 9.81}, 0, 0, {}};
    std::tie(immersion.low, immersion.high) = extent(immersion.plane.normal);
    immersion.wet = computeWetVolume(hull_, immersion.plane);
    return immersion;
  }
  /// Immersion of a share of the body's height.
  Immersion immersed(const Vector3& normal, double share) const {
    const auto [low, high] = extent(normal.normalized());
    return at(normal, low + share * (high - low));
  }
  Matrix6 K(const Immersion& immersion) const { return inertia_->inertia(immersion); }
  InertiaGradient gradient(const Immersion& immersion, const Twist& x) const {
    return inertia_->gradient(immersion, x);
  }
  const FluidBody& body() const { return *body_; }

 private:
  std::pair<double, double> extent(const Vector3& s) const {
    if (!(body_->sphere_radius > 0)) return computeExtent(hull_, s);
    const double middle = s.dot(body_->centre_of_volume);
    return {middle - body_->sphere_radius, middle + body_->sphere_radius};
  }

  std::shared_ptr<const FluidBody> body_;
  PackedHull hull_;
  std::shared_ptr<const WettedInertia> inertia_;
};

FluidBody moved(FluidBody body, const Vector3& by) {  // moves F's origin to -by
  for (std::size_t i = 0; i < body.surface.vertices.size(); ++i)
    body.surface.vertices[i] += by[static_cast<Eigen::Index>(i % 3)];
  body.centre_of_volume += by;
  body.added_mass = shiftOrigin(body.added_mass, -by);
  std::vector<AddedMassPart> parts = body.added_mass_parts.all();
  for (AddedMassPart& part : parts) {
    part.centre += by;
    part.inertia = shiftOrigin(part.inertia, -by);
  }
  body.added_mass_parts = parts;
  return body;
}

std::vector<FluidBody> allKinds() {
  return {test::floatingEllipsoid({1, 0.8, 0.6}, 3), test::floatingBall(1, 3),
          test::floatingBox({2, 1, 0.5})};
}

TEST(WettedInertia, IsThatOfTheBodyWhereItIsDeepAndNothingWhereItIsDry) {
  for (const FluidBody& body : allKinds()) {
    const Wetted wetted(moved(body, {0.1, -0.2, 0.3}));
    const Vector3 s(1, 2, 3);
    EXPECT_EQ(wetted.K(wetted.immersed(s, 3.0001)), wetted.body().added_mass);
    EXPECT_EQ(wetted.K(wetted.immersed(s, -0.0001)), Matrix6::Zero());
    const Twist x{{1, 2, 3}, {4, 5, 6}};
    EXPECT_EQ(wetted.gradient(wetted.immersed(s, 3.0001), x).by_height, 0);
    EXPECT_EQ(wetted.gradient(wetted.immersed(s, -0.0001), x).by_height, 0);
  }
}

TEST(WettedInertia, GoesOnWithoutAJumpToThatOfADeepBody) {
  for (const FluidBody& body : allKinds()) {
    const Wetted wetted(body);
    const Matrix6 almost = wetted.K(wetted.immersed({1, 2, 3}, 2.9999999));
    EXPECT_LT((almost - body.added_mass).norm(), 1e-6 * body.added_mass.norm());
    EXPECT_LT(wetted.K(wetted.immersed({1, 2, 3}, 1e-6)).norm(), 1e-3 * body.added_mass.norm());
  }
}

// Parts are rounded to single precision.
constexpr double kSingle = 0x1p-23;

TEST(WettedInertia, MovesWithTheFrame) {
  Arbitrary arbitrary(1);
  for (const FluidBody& body : allKinds()) {
    const Vector3 by(0.3, -0.5, 0.7);
    const Wetted here(body), there(moved(body, by));
    for (int i = 0; i < 10; ++i) {
      const Vector3 s = arbitrary.vector();
      const double share = arbitrary.between(0.05, 2.5);
      const Matrix6 expected = shiftOrigin(here.K(here.immersed(s, share)), -by);
      EXPECT_LT((there.K(there.immersed(s, share)) - expected).norm(), kSingle * expected.norm());
      const Twist x = arbitrary.twist();
      const Twist at_here{x.angular, x.at(by)};
      const FrameOffset frame{Matrix3::Identity(), by};
      const Immersion a = here.immersed(s, share), b = there.immersed(s, share);
      const Vector6 f = frame.toB(here.gradient(a, at_here).wrench(a.plane)).vector();
      EXPECT_LE((there.gradient(b, x).wrench(b.plane).vector() - f).norm(), 1e-7 * f.norm());
    }
  }
}

TEST(WettedInertia, ScalesAsTheBody) {
  const double factor = 0.01;
  for (const FluidBody& body : allKinds()) {
    const Wetted large(body), small(scaled(body, factor));
    for (const double share : {0.1, 0.5, 1.3}) {
      const Matrix6 expected = scaleShape(large.K(large.immersed({1, 2, 3}, share)), factor);
      const Matrix6 K = small.K(small.immersed({1, 2, 3}, share));
      EXPECT_LT((K - expected).cwiseAbs().maxCoeff(), kSingle * expected.cwiseAbs().maxCoeff());
    }
  }
}

TEST(WettedInertia, HasTheRateThatItsGradientSays) {
  // Twice F_K.x = -x.K' x with the sign of the wrench on the body: power of F_K is the rate of the
  // energy. Terms missing in the gradient are 0 here: the ellipsoid moves along its axes at
  // constant height, and the water's rise beyond 0.85 of it is below 1e-6.
  const Vector3 axes(1, 0.8, 0.6);
  for (const FluidBody& body : {test::floatingEllipsoid(axes, 3), test::floatingBall(1, 3)}) {
    const Wetted wetted(body);
    const Vector3 s(0, 0, 1);
    const Immersion here = wetted.immersed(s, 0.85);
    for (const Vector3& v : {Vector3(0, 0, 1), Vector3(1, 0.5, -0.7)}) {
      const Twist x{Vector3::Zero(), v};
      const double moment = 1e-4;
      const auto energy = [&](double t) {
        const Immersion then = wetted.at(s, here.plane.height - t * s.dot(v));
        return 0.5 * x.vector().dot(wetted.K(then) * x.vector());
      };
      const double rate = (energy(moment) - energy(-moment)) / (2 * moment);
      EXPECT_NEAR(power(wetted.gradient(here, x).wrench(here.plane), x), rate,
                  0.02 * std::abs(rate));
    }
  }
}

TEST(WettedInertia, HasNoHorizontalForceAndNoVerticalTorque) {
  Arbitrary arbitrary(2);
  for (const FluidBody& body : allKinds()) {
    const Wetted wetted(body);
    for (int i = 0; i < 10; ++i) {
      const Immersion at = wetted.immersed(arbitrary.vector(), arbitrary.between(0.1, 1.5));
      const Wrench f = wetted.gradient(at, arbitrary.twist()).wrench(at.plane);
      EXPECT_LT(at.plane.normal.cross(f.force).norm(), 1e-14 * (1 + f.force.norm()));
      EXPECT_NEAR(at.plane.normal.dot(f.torque), 0, 1e-14 * (1 + f.torque.norm()));
    }
  }
}

TEST(WettedInertia, OfABallByPartsIsThatOfItsHalf) {
  // Parts at half immersion: heave 15 % below pi/3, surge 23 % above the image method's 0.577, as
  // in the free_surface prototypes. The table of spheres has the exact values.
  const Wetted parts(test::floatingEllipsoid({1, 1, 1}, 4));
  const Matrix6 K = parts.K(parts.immersed({0, 0, 1}, 0.5));
  EXPECT_NEAR(K(5, 5), 0.851 * kPi / 3, 0.02 * kPi / 3);
  EXPECT_NEAR(K(3, 3), 1.23 * 0.5772, 0.03);
  EXPECT_NEAR(K(0, 0), 0, 1e-3);
  const Wetted ball(test::floatingBall(1, 2));
  // Rise of the water: 0.4 / 256 of the radius.
  const Matrix6 exact = ball.K(ball.at({0, 0, 1}, 0));
  EXPECT_NEAR(exact(5, 5), kPi / 3, 1e-3);
  EXPECT_NEAR(exact(3, 3), 0.5759, 3e-3);
}

TEST(WettedInertia, HasNoLargeNegativeEigenvalue) {
  Arbitrary arbitrary(3);
  const Wetted wetted(test::floatingEllipsoid({1, 0.5, 0.2}, 3));
  for (int i = 0; i < 50; ++i) {
    const Matrix6 K = wetted.K(wetted.immersed(arbitrary.vector(), arbitrary.between(0.05, 1.5)));
    EXPECT_EQ(K, Matrix6(K.transpose()));
    const auto values = symmetricEigen<6>(K).values;
    EXPECT_GT(values[0], -0.03 * values[5]);
  }
}

TEST(WettedSphere, IsADiscWhereItTouches) {
  // Von Karman: 4/3 a^3, a^2 = 2 R d. The table's boundary elements begin at d = 0.02 R.
  const double d = 0.02, a3 = std::pow(2 * d, 1.5);
  EXPECT_NEAR(sphereInertiaAt(d).along, 4 / 3.0 * a3, 0.1 * 4 / 3.0 * a3);
  EXPECT_LT(sphereInertiaAt(d / 4).along, sphereInertiaAt(d).along / 7.9);
}

TEST(WettedSphere, HasTheDerivativesOfItsTable) {
  for (double d = 0.013; d < 7; d *= 1.1) {
    const double h = 1e-6;
    const SphereInertia before = sphereInertiaAt(d - h), after = sphereInertiaAt(d + h);
    const SphereInertia here = sphereInertiaAt(d);
    EXPECT_NEAR((after.along - before.along) / (2 * h), here.along_slope, 1e-5) << d;
    EXPECT_NEAR((after.across - before.across) / (2 * h), here.across_slope, 1e-5) << d;
    EXPECT_GE(here.along_slope, 0);
    EXPECT_GE(here.across_slope, 0);
  }
  EXPECT_EQ(sphereInertiaAt(6).along, 2 * kPi / 3);
}

TEST(PartSums, LeaveOutNoPartInTheWater) {
  const AddedMassParts parts = test::floatingEllipsoid({1, 0.8, 0.6}, 3).added_mass_parts;
  const PartBlocks known = parts.blocks();
  double products[PartBlock::kEntries];
  for (int i = 0; i < PartBlock::kEntries; ++i) products[i] = 0.1 * (i - 7);
  const auto withReach = [&](float reach) {
    std::vector<PartBlock> blocks(known.blocks, known.blocks + known.count);
    for (PartBlock& block : blocks)
      for (float& each : block.reach) each = reach;
    return blocks;
  };
  const std::vector<PartBlock> far = withReach(10), near = withReach(0);
  int missed = 0;
  for (double height = -1; height < 1; height += 0.013) {
    const PartPlane plane{{0.48, 0.6, 0.64}, height, 0.07};
    const auto bitsOf = [&](const PartBlocks& blocks) {
      return std::make_pair(test::bitsOf(kPartKernelBaseline.inertia(blocks, plane)),
                            test::bitsOf(kPartKernelBaseline.gradient(blocks, plane, products)));
    };
    EXPECT_EQ(bitsOf(known), bitsOf({far.data(), far.size(), known.mirrors})) << height;
    if (bitsOf(known) != bitsOf({near.data(), near.size(), known.mirrors})) ++missed;
  }
  EXPECT_GT(missed, 20);
}

Matrix6 arbitrarySymmetric(Arbitrary& arbitrary, double size) {
  Matrix6 matrix;
  for (int i = 0; i < 36; ++i) matrix(i) = size * arbitrary.between(-1, 1);
  return matrix + matrix.transpose();
}

/// Parts in the first octant, one of them on a plane, with all their images.
std::vector<AddedMassPart> partsWithImages(int mirrors) {
  Arbitrary arbitrary(31);
  std::vector<AddedMassPart> parts;
  for (int i = 0; i < 11; ++i) {
    AddedMassPart part;
    for (double& c : part.centre) c = static_cast<float>(arbitrary.between(0.1, 0.5));
    part.spread << 0.02, 0.03, 0.04, 0.01, 0.015, 0.02;
    part.inertia = arbitrarySymmetric(arbitrary, 0.1).cast<float>().cast<double>();
    int apart = mirrors;
    for (int axis = 0; i == 0 && axis < 3; ++axis) {
      if (!(mirrors >> axis & 1)) continue;
      const AddedMassPart image = imageOf(part, 1 << axis);
      part = {(part.centre + image.centre) / 2, (part.spread + image.spread) / 2,
              (part.inertia + image.inertia) / 2};
      apart &= ~(1 << axis);
      break;
    }
    for (int turned = 0; turned < 8; ++turned)
      if ((turned & apart) == turned) parts.push_back(imageOf(part, turned));
  }
  return parts;
}

/// Adds a part without inertia and without an image, so that no plane mirrors the parts.
std::vector<AddedMassPart> withoutMirrors(std::vector<AddedMassPart> parts) {
  parts.push_back({{0.3, 0.2, 0.1}, Vector6::Zero(), Matrix6::Zero()});
  return parts;
}

TEST(MirroredParts, AreKeptOnceAndAreAllThere) {
  for (int mirrors = 0; mirrors < 8; ++mirrors) {
    const std::vector<AddedMassPart> parts = partsWithImages(mirrors);
    const AddedMassParts kept = parts, every = withoutMirrors(parts);
    EXPECT_EQ(kept.blocks().mirrors, mirrors);
    EXPECT_EQ(every.blocks().mirrors, 0);
    EXPECT_EQ(kept.blocks().count, 2u);
    ASSERT_EQ(kept.size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(kept[i].centre, parts[i].centre);
      EXPECT_EQ(kept[i].spread, Vector6(parts[i].spread.cast<float>().cast<double>()));
      EXPECT_EQ(kept[i].inertia, parts[i].inertia);
      EXPECT_EQ(kept.scaled(2)[i].inertia, scaleShape(parts[i].inertia, 2));
    }
    EXPECT_LT((kept.sum() - every.sum()).norm(), 1e-14 * every.sum().norm());
  }
}

TEST(MirroredParts, HaveTheSumsOfAllOfThem) {
  Arbitrary arbitrary(32);
  PoolSides sides;
  sides.count = 1;
  sides.of[0] = {Vector3(0.6, 0.8, 0), {0.1, 0.05, 0}};
  for (int mirrors = 0; mirrors < 8; ++mirrors) {
    FluidBody body = test::floatingBox({1, 1, 1});
    body.added_mass_parts = partsWithImages(mirrors);
    const Wetted kept(body);
    body.added_mass_parts = withoutMirrors(partsWithImages(mirrors));
    const Wetted every(body);
    for (int i = 0; i < 50; ++i) {
      const Twist x = arbitrary.twist(1, 1);
      Immersion at = kept.at(arbitrary.vector(), arbitrary.between(-0.5, 0.5));
      if (i % 2 == 0) at.plane.sides_F = &sides;
      EXPECT_LT((kept.K(at) - every.K(at)).norm(), 1e-13 * body.added_mass.norm());
      const InertiaGradient a = kept.gradient(at, x), b = every.gradient(at, x);
      const double scale = std::abs(b.by_height) + b.by_normal.norm();
      EXPECT_LE(std::abs(a.by_height - b.by_height), 1e-12 * scale);
      EXPECT_LE((a.by_normal - b.by_normal).norm(), 1e-12 * scale);
    }
  }
}

/// An ellipsoid with parts, and a copy with a table of random corrections.
class Tabulated {
 public:
  Tabulated() {
    FluidBody body = test::floatingEllipsoid({1, 0.8, 0.6}, 2);
    plain_ = std::make_shared<const FluidBody>(body);
    body.waterline = {2, {0.1, 0.4, 1, 2}, {}};
    Arbitrary arbitrary(7);
    const double size = 0.05 * body.added_mass.maxCoeff();
    for (int i = 0; i < OctahedralLattice(2).size() * 4; ++i)
      body.waterline.corrections.push_back(arbitrarySymmetric(arbitrary, size));
    tabulated_ = std::make_shared<const FluidBody>(body);
    by_parts = makeWettedInertia(plain_);
    by_table = makeWettedInertia(tabulated_);
  }

  Immersion immersed(const Vector3& normal, double share) const {
    Immersion at{{normal.normalized(), 0, 1000, 9.81}, 0, 0, {}};
    const PackedHull hull(*plain_);
    std::tie(at.low, at.high) = computeExtent(hull, at.plane.normal);
    at.plane.height = at.low + share * at.size();
    at.wet = computeWetVolume(hull, at.plane);
    return at;
  }
  Matrix6 correction(const Vector3& normal, double share) const {
    const Immersion at = immersed(normal, share);
    return by_table->unraisedInertia(at) - by_parts->unraisedInertia(at);
  }
  const FluidBody& body() const { return *tabulated_; }
  const WaterlineTable& table() const { return tabulated_->waterline; }

 private:
  std::shared_ptr<const FluidBody> plain_, tabulated_;

 public:
  std::shared_ptr<const WettedInertia> by_parts, by_table;
};

TEST(WettedTable, AddsTheCorrectionsAtTheirNodes) {
  const Tabulated body;
  const OctahedralLattice lattice(body.table().subdivisions);
  for (int node = 0; node < lattice.size(); ++node)
    for (std::size_t i = 0; i < 4; ++i) {
      const Matrix6& expected = body.table().corrections[4 * node + i];
      const Matrix6 found = body.correction(lattice.direction(node), body.table().immersions[i]);
      EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm()) << node << ", " << i;
    }
}

TEST(WettedTable, IsThatOfTheBodyWhereItIsDeepAndNothingWhereItIsDry) {
  const Tabulated body;
  const Vector3 s(1, -2, 3);
  EXPECT_EQ(body.by_table->inertia(body.immersed(s, 3.0001)), body.body().added_mass);
  EXPECT_EQ(body.by_table->inertia(body.immersed(s, -1e-4)), Matrix6::Zero());
  const double size = body.body().added_mass.norm();
  EXPECT_LT(body.correction(s, 2.9999).norm(), 1e-6 * size) << "the slope is 0 as well";
  EXPECT_LT(body.correction(s, 1e-6).norm(), 1e-4 * size);
}

TEST(WettedTable, GrowsWithTheSquareOfTheDepthFromTheTouchOn) {
  const Tabulated body;
  const Vector3 s(1, -2, 3);
  const double first = body.table().immersions.front();
  const Matrix6 there = body.by_table->unraisedInertia(body.immersed(s, first));
  const Matrix6 half = body.by_table->unraisedInertia(body.immersed(s, first / 2));
  EXPECT_LT((4 * half - there).norm(), 1e-13 * there.norm());  // a few roundings
  const Matrix6 above = body.by_table->unraisedInertia(body.immersed(s, first * (1 + 1e-9)));
  EXPECT_LT((above - there).norm(), 1e-6 * there.norm());
}

// Continuity in random directions, including borders between faces of the octahedron.
TEST(WettedTable, HasNoJumps) {
  const Tabulated body;
  Arbitrary arbitrary(3);
  const double size = body.body().added_mass.norm();
  for (int i = 0; i < 300; ++i) {
    Vector3 s = arbitrary.vector().normalized();
    if (i % 3 == 0) s[i % 9 / 3] = 0;
    const double share = i % 2 == 0 ? 1 : arbitrary.between(0.01, 2.9);
    const Matrix6 here = body.correction(s, share);
    const Vector3 aside = (s + 1e-8 * arbitrary.vector()).normalized();
    EXPECT_LT((body.correction(aside, share) - here).norm(), 1e-5 * size);
    EXPECT_LT((body.correction(s, share * (1 + 1e-8)) - here).norm(), 1e-5 * size);
  }
}

TEST(WettedTable, ItsGradientIsThatOfTheEnergyOverTheDepth) {
  const Tabulated body;
  Arbitrary arbitrary(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3 s = arbitrary.vector();
    const double share = arbitrary.between(1.05, 2.95);  // planes without the rise of the water
    const Twist x = arbitrary.twist();
    const Vector6 v = x.vector();
    const double size = body.immersed(s, share).size(), step = 1e-5;
    const Matrix6 change = body.correction(s, share + step) - body.correction(s, share - step);
    const double expected = 0.5 * v.dot(change * v) / (2 * step * size);
    const Immersion at = body.immersed(s, share);
    const InertiaGradient with = body.by_table->gradient(at, x),
                          without = body.by_parts->gradient(at, x);
    const double scale = v.squaredNorm() * body.body().added_mass.norm();
    EXPECT_NEAR(with.by_height - without.by_height, expected, 1e-7 * scale);
    const Vector3 torque = at.plane.normal.cross(with.by_normal - without.by_normal);
    const Vector3 arm = at.wet.moment / at.wet.volume;
    EXPECT_LT((torque + expected * at.plane.normal.cross(arm)).norm(), 1e-6 * scale);
  }
}

}  // namespace
}  // namespace ambient
