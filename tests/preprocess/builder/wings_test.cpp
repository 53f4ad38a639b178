// Wings of a mesh, docs/theory.md section 21.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <sstream>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/body_parts.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/builder/wing_plan.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/wings/wing_search.h"
#include "tests/support/bodies/named_parts.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

using test::box;
using test::built;
using test::Named;
using test::placed;
using test::turnAbout;

/// Expects that an action is refused with these words.
template <class Action>
void expectRefusal(const std::string& words, const Action& action) {
  const std::string said = test::refusalOf(action);
  EXPECT_NE(said.find(words), std::string::npos) << said;
}

/// A rocket along x, nose ahead: d 40 mm, 0.6 m long, four fins of 60 x 60 x 2 mm.
std::vector<Named> rocket() {
  const Matrix3 along = turnAbout(Vector3d::UnitY(), kPi / 2);
  std::vector<Named> parts{
      {"tube", placed(makeCylinderMesh(0.02, 0.58, 600), along, {-0.01, 0, 0})},
      {"nose", makeEllipsoidMesh({0.02, 0.02, 0.02}, 500)}};
  parts[1].mesh.vertices.row(0).array() += 0.28;
  const TriangleMesh fin = box({-0.3001, 0.015, -0.001}, {-0.24, 0.08, 0.001});
  for (int k = 0; k < 4; ++k)
    parts.push_back({"Fin_" + std::to_string(k),
                     placed(fin, turnAbout(Vector3d::UnitX(), (k + 0.5) * kPi / 2), {0, 0, 0})});
  return parts;
}

const FluidBody& builtRocket() {
  static const FluidBody body = built(rocket(), "auto");
  return body;
}

FlowSettings flowOf(LoadPrecision precision) {
  FlowSettings flow;
  flow.precision = precision;
  flow.skin_friction = false;
  return flow;
}

std::shared_ptr<const SurfaceLoads> loadsOn(const FluidBody& body,
                                            LoadPrecision precision = LoadPrecision::kDouble,
                                            double viscosity = 0) {
  return makeSurfaceLoads(std::make_shared<FluidBody>(body), {1.2, viscosity, {}, {}},
                          flowOf(precision));
}

TEST(Wings, OfFourEqualFinsAreEqualAndAsDrawn) {
  const FluidBody& body = builtRocket();
  ASSERT_EQ(body.wings.size(), 4u);
  for (const Wing& fin : body.wings) {
    EXPECT_TRUE(fin.is_joined);
    EXPECT_NEAR(fin.span, 0.06, 2.5e-4);  // the tube is a prism: 0.02 (1 - cos(pi/20))
    EXPECT_NEAR(fin.chord, 0.0601, 1e-4);
    EXPECT_NEAR(fin.thickness, 0.002, 2e-5);
    EXPECT_NEAR(fin.aspect, 2 * fin.span / fin.chord, 1e-9) << "the image in the tube";
    EXPECT_NEAR(fin.body_lift, 1.25, 0.01) << "1 + r/(s + r), Barrowman 1967";
    EXPECT_NEAR(std::abs(fin.facing.x()), 0, 1e-3);
    EXPECT_NEAR(fin.span_axis.dot(fin.centre.normalized()),
                fin.centre.tail<2>().norm() / fin.centre.norm(), 1e-3)
        << "away from the tube";
    const Wing& first = body.wings.front();
    EXPECT_NEAR(fin.span, first.span, 2e-3 * first.span);
    EXPECT_NEAR(fin.aspect, first.aspect, 3e-3 * first.aspect);
    EXPECT_NEAR(fin.body_lift, first.body_lift, 3e-3);
  }
  for (const double share : body.form.wing_shares) EXPECT_GT(share, 0.95);
}

/// Slope of the moment about the origin over the incidence, on the tube's section and metres, with
/// Munk's moment: in flight along x, nose up > 0.
double momentSlope(const FluidBody& body) {
  const double incidence = 2 * kPi / 180, speed = 30, density = 1.2;
  const Vector3 v = speed * Vector3(std::cos(incidence), 0, -std::sin(incidence));
  const Wrench load = loadsOn(body)->load({Vector3::Zero(), v});
  const Vector3 momentum = density * body.added_mass.bottomRightCorner<3, 3>() * v;
  const double moment = load.torque.y() + momentum.cross(v).y();
  return -moment / (density / 2 * speed * speed * kPi * 0.02 * 0.02) / incidence;
}

TEST(Wings, OfARocketTurnItAsBarrowmanSays) {
  // Barrowman 1967: four fins of span s, chord c beside a tube of diameter d, at c/4; the nose.
  const double s = 0.06, c = 0.06, d = 0.04;
  const double fins =
      (1 + 0.02 / 0.08) * 16 * s * s / (d * d) / (1 + std::sqrt(1 + s * s / (c * c)));
  const double expected = 2 * 0.29 - fins * (0.24 + c / 4);
  EXPECT_NEAR(momentSlope(builtRocket()), expected, 0.12 * -expected);
  EXPECT_GT(momentSlope(built(rocket(), "none")), 0.65 * expected) << "as one part they do little";
}

/// Two boxes, each a wing, without any other part.
FluidBody twoWings(const TriangleMesh& one, const TriangleMesh& other) {
  BuildSettings settings;
  settings.name = "two";
  settings.origin = Vector3d::Zero();
  settings.added_mass = Matrix6::Identity();
  settings.wings.labels.assign(24, 1);
  std::fill(settings.wings.labels.begin() + 12, settings.wings.labels.end(), std::uint8_t{2});
  settings.wings.given.resize(2);
  return makeFluidBody(joinMeshes({one, other}), settings);
}

TEST(Wings, FarApartAreTwoBodies) {
  // So thin that its rims, which count in the moments of a body as a whole, are 3e-4 of its area.
  const TriangleMesh plate = box({-0.5, -1.5, -2e-4}, {0.5, 1.5, 2e-4});
  const Vector3d apart(0, 40, 7);
  const FluidBody two = twoWings(placed(plate, Matrix3::Identity(), apart),
                                 placed(plate, Matrix3::Identity(), -apart));
  ASSERT_EQ(two.wings.size(), 2u);
  EXPECT_FALSE(two.wings[0].is_joined);
  EXPECT_NEAR(two.wings[0].span, 3, 1e-9);
  EXPECT_NEAR(two.wings[0].chord, 1, 1e-9);
  BuildSettings alone;
  alone.name = "one";
  alone.origin = Vector3d::Zero();
  alone.added_mass = Matrix6::Zero();
  (*alone.added_mass)(5, 5) = two.wings[0].plateMass();
  const FluidBody one = makeFluidBody(plate, alone);
  const auto loads = loadsOn(two), of_one = loadsOn(one);
  test::Arbitrary arbitrary(53);
  for (int i = 0; i < 200; ++i) {
    const Vector3 v = arbitrary.vector();
    const Wrench there = of_one->load({Vector3::Zero(), v}),
                 sum = loads->load({Vector3::Zero(), v});
    EXPECT_LT((sum.force - 2 * there.force).norm(), 0.005 * v.squaredNorm());
    EXPECT_LT((sum.torque - 2 * there.torque).norm(), 0.005 * v.squaredNorm());
  }
  // A turn about a point between them moves the two plates opposite ways, w x c.
  const Wrench up = of_one->load({Vector3::Zero(), {0.3, -7, 40}});
  const double turning = loads->load({{1, 0, 0}, {0.3, 0, 0}}).torque.x();
  EXPECT_NEAR(turning, 2 * (40 * up.force.z() - 7 * up.force.y()), 0.01 * std::abs(turning));
}

// In tandem the second one loses e of its lift, eq. (161c): here K/(pi L) [1 + 4/sqrt(4^2 + 3^2)]
// for L = 6, x = 4 chords and half of the span 3. Flying backwards it is the small one that leads.
TEST(Wings, BehindOthersMeetTheirDownwash) {
  const TriangleMesh front = box({-0.5, -3, -2e-4}, {0.5, 3, 2e-4});
  const TriangleMesh tail = box({-4.3, -1, -2e-4}, {-3.7, 1, 2e-4});
  const FluidBody both = twoWings(front, tail);
  const FluidBody apart = twoWings(front, placed(tail, Matrix3::Identity(), {0, 50, 0}));
  ASSERT_EQ(both.wings.size(), 2u);
  const auto loads = loadsOn(both), free = loadsOn(apart);
  EXPECT_TRUE(loads->needsGuard());
  EXPECT_FALSE(free->needsGuard());
  const auto force = [](const auto& on, double along, double up) {
    return on->load({Vector3::Zero(), {along, 0, up}}).force.z();
  };
  const auto slope = [](double aspect) {
    return 2 * kPi * aspect / (2 + std::sqrt(4 + aspect * aspect));
  };
  const double up = 0.01, lost = force(loads, 1, -up) - force(free, 1, -up);
  const double e = slope(6) / (kPi * 6) * (1 + 4 / 5.0);
  const double of_tail = 0.6 * slope(2 / 0.6) * up * 1.2 * 2 / 2;
  EXPECT_NEAR(lost, -e * of_tail, 0.03 * e * of_tail);
  EXPECT_NEAR(force(loads, -1, -up), force(free, -1, -up), 1e-9);
  // At rest, nearly so, and behind a wing that is out of the water, there is none.
  for (const double speed : {0.0, 1e-170})
    EXPECT_EQ(force(loads, speed, -0.01 * speed), force(free, speed, -0.01 * speed)) << speed;
  const WetPart aft{{{1, 0, 0}, -2, 1.2, 9.81}, 0.2};
  const auto wetForce = [&](const FluidBody& body) {
    return makeWaterlineLoads(std::make_shared<FluidBody>(body), {1.2, 0, {}, {}},
                              flowOf(LoadPrecision::kDouble))
        ->wetLoad({Vector3::Zero(), {1, 0, -up}}, aft)
        .force.z();
  };
  EXPECT_NEAR(wetForce(both), wetForce(apart), 1e-9);
}

TEST(Wings, NeverFeedEnergy) {
  test::Arbitrary arbitrary(54);
  for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble})
    for (const double viscosity : {0.0, 1e-4}) {
      const auto loads = loadsOn(builtRocket(), precision, viscosity);
      ASSERT_FALSE(loads->needsGuard());
      for (int i = 0; i < 5000; ++i) {
        const Twist x = arbitrary.twist(arbitrary.between(0, 50), arbitrary.between(0, 5));
        const Wrench f = loads->load(x);
        const double size = f.torque.norm() * x.angular.norm() + f.force.norm() * x.linear.norm();
        ASSERT_LT(power(f, x), 1e-15 * size);
      }
    }
}

TEST(Wings, HaveTheSameLoadsInSingleAndDoublePrecision) {
  const auto in_single = loadsOn(builtRocket(), LoadPrecision::kSingle);
  const auto in_double = loadsOn(builtRocket());
  test::Arbitrary arbitrary(55);
  for (int i = 0; i < 500; ++i) {
    const Twist x = arbitrary.twist(10, 1);
    const Wrench a = in_single->load(x), b = in_double->load(x);
    const double square = x.linear.squaredNorm() + 0.09 * x.angular.squaredNorm();
    EXPECT_LT((a.force - b.force).norm(), 1e-6 * square);
    const Wrench twice = in_double->load({2 * x.angular, 2 * x.linear});
    EXPECT_LT((twice.force - 4 * b.force).norm(), 1e-13 * square) << "degree two";
  }
}

TEST(Wings, ArePartlyWet) {
  const auto loads = makeWaterlineLoads(std::make_shared<FluidBody>(builtRocket()),
                                        {1000, 0, {}, {}}, flowOf(LoadPrecision::kDouble));
  test::Arbitrary arbitrary(56);
  for (int i = 0; i < 50; ++i) {
    const Twist x = arbitrary.twist(10, 1);
    const Wrench whole = loads->load(x);
    const auto wet = [&](double height, double share) {
      return loads->wetLoad(x, {{{0, 0, 1}, height}, share});
    };
    EXPECT_LT((wet(1, 1).force - whole.force).norm(), 1e-9 * whole.force.norm());
    EXPECT_EQ(wet(-1, 0).force.norm(), 0);
    EXPECT_LE(power(wet(0.01, 0.6), x), 0);
  }
}

TEST(Wings, OfABladeThatTurnsAboutItsRootDoNotStallByTheirPlane) {
  Wing wing;
  wing.span = 2;
  wing.chord = 0.3;
  wing.centre = {0, 1, 0};
  wing.aspect = 6;
  const ShapeFactors factors(wing, 1);
  EXPECT_DOUBLE_EQ(factors.stallingShare({0, 0, 3}, {0, 0, 0}), 0) << "eq. (161)";
  EXPECT_DOUBLE_EQ(factors.stallingShare({0, 0, 0}, {1, 0, 2}), 1);
  EXPECT_DOUBLE_EQ(factors.stallingShare({0, 0, 3}, {6, 0, 0}), 0.5);
}

// Beyond stall the lag (48) feeds a plate that pitches to and fro; blades that turn about their
// root have none of it, eq. (161d).
TEST(Wings, OfABladeThatTurnsAboutItsRootStallWithoutLag) {
  Wing wing;
  wing.span = 2;
  wing.chord = 0.3;
  wing.aspect = 6;
  const ShapeFactors factors(wing, 1);
  LiftedPart blade;
  blade.added_mass = wing.plateMass() * wing.facing * wing.facing.transpose();
  blade.area = 2 * wing.span * wing.chord;
  const FormLift lagging(blade, factors, 4.5), prompt(blade, factors, 0);
  const Vector3 w(0, 0.5, 3), v(2, 0, -0.5);
  const Wrench fixed = lagging.load(w, v, 1), turning = lagging.load(w, v, 1, 1, 0);
  EXPECT_EQ(turning.torque, prompt.load(w, v, 1).torque);
  EXPECT_EQ(turning.force, prompt.load(w, v, 1).force);
  EXPECT_GT((fixed.torque - turning.torque).norm(), 1e-3 * fixed.torque.norm());
  EXPECT_EQ(lagging.load(w, v, 1, 1, 1).torque, fixed.torque);
}

/// Two blades of elliptic sections in one piece, pitched 20 degrees, from tip to tip along x.
TriangleMesh propeller() {
  constexpr int kAround = 16, kAlong = 31;
  TriangleMesh mesh;
  mesh.vertices.resize(3, kAround * kAlong);
  for (int j = 0; j < kAlong; ++j) {
    const double x = 0.09 * (2 * (j + 0.5) / kAlong - 1), pitch = 0.349 * std::tanh(100 * x);
    for (int i = 0; i < kAround; ++i) {
      const double a = 0.011 * std::cos(2 * kPi * i / kAround);
      const double b = 0.002 * std::sin(2 * kPi * i / kAround);
      mesh.vertices.col(kAround * j + i) << x, a * std::cos(pitch) - b * std::sin(pitch),
          a * std::sin(pitch) + b * std::cos(pitch);
    }
  }
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < kAround; ++i) {
    const int j = (i + 1) % kAround, last = kAround * (kAlong - 1);
    for (int row = 0; row < last; row += kAround) {
      triangles.emplace_back(row + i, row + j, row + kAround + j);
      triangles.emplace_back(row + i, row + kAround + j, row + kAround + i);
    }
    if (i > 0 && j > 0) {
      triangles.emplace_back(0, j, i);
      triangles.emplace_back(last, last + i, last + j);
    }
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t)
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return mesh;
}

TEST(Wings, OfAPropellerAreItsEqualBlades) {
  const FluidBody body = built({{"propeller", propeller()}}, "auto");
  ASSERT_EQ(body.wings.size(), 2u);
  for (const Wing& blade : body.wings) {
    EXPECT_TRUE(blade.is_joined);
    EXPECT_EQ(blade.nose, kRoundAtBothEnds);
    EXPECT_NEAR(blade.span, 0.0885, 0.002);
    EXPECT_NEAR(blade.aspect, 8.1, 0.3);
    EXPECT_NEAR(std::abs(blade.facing.z()), std::cos(0.349), 0.02);
  }
  // A turn about the blades' common span is damped, as they turn the fluid.
  const auto loads = loadsOn(body, LoadPrecision::kDouble, 1.8e-5);
  const auto torqueAt = [&](double pitching) {
    return loads->load({{pitching, 0, 190}, {0, 0, 1}}).torque.x();
  };
  EXPECT_LT(torqueAt(2) - torqueAt(-2), 0);
}

// What stands on a wing that is most of the body is its rest: the nut of a seed.
TEST(Wings, WithANutAreNoWholeBodies) {
  TriangleMesh nut = makeEllipsoidMesh({0.005, 0.003, 0.002}, 300);
  nut.vertices.row(0).array() -= 0.018;
  const FluidBody body = built(
      {{"seed", box({-0.017, -0.005, -0.0003}, {0.02, 0.005, 0.0003})}, {"nut", nut}}, "auto");
  ASSERT_EQ(body.wings.size(), 1u);
  EXPECT_TRUE(body.wings[0].is_joined);
  EXPECT_NEAR(body.wings[0].span_axis.x(), 1, 0.01);
}

TEST(Wings, ThatAreSweptAreJoinedWhereTheyLeaveTheBody) {
  const Matrix3 along = turnAbout(Vector3d::UnitY(), kPi / 2);
  std::vector<Named> parts{{"hull", placed(makeCylinderMesh(0.1, 1.5, 600), along, {0, 0, 0})}};
  for (const double side : {1.0, -1.0}) {
    TriangleMesh plate = box({-0.07, 0.05, -0.005}, {0.07, 0.55, 0.005});
    for (Eigen::Index v = 0; v < plate.vertexCount(); ++v) {
      plate.vertices(0, v) -= plate.vertices(1, v);
      if (side < 0) plate.vertices(1, v) *= -1;
    }
    if (side < 0) plate.triangles.row(0).swap(plate.triangles.row(1));
    parts.push_back({"wing", plate});
  }
  const FluidBody body = built(parts, "auto");
  ASSERT_EQ(body.wings.size(), 2u);
  for (const Wing& wing : body.wings) {
    EXPECT_TRUE(wing.is_joined);
    EXPECT_NEAR(std::abs(wing.span_axis.y()), 1, 0.01);
    EXPECT_NEAR(wing.chord, 0.14, 0.01);
  }
}

TEST(Wings, OfLowAspectRatioHaveTheSlopeOfASlenderWing) {
  // Jones 1946: pi L/2 along the chord, whatever the order of span and chord.
  Wing wing;
  wing.span = 0.02;
  wing.chord = 1;
  wing.aspect = 0.02;
  const ShapeFactors factors(wing, 1);
  EXPECT_NEAR(factors.slope, kPi / 2 * 0.02, 1e-5);
  const WingFactors<double>& numbers = factors.in_double;
  const auto turned = [&](const Vector3& u) {  // K|y|^2 + (K' - K)(h.u)^2 over k
    const double along = Vector3(numbers.span[0], numbers.span[1], numbers.span[2]).dot(u);
    return (numbers.slope - along * along) * numbers.stall;
  };
  EXPECT_NEAR(turned(Vector3::UnitX()), factors.slope, 1e-12);
  EXPECT_NEAR(turned(Vector3::UnitY()), factors.slope_along, 1e-12);
}

TEST(Wings, AreTheSameInAFile) {
  const FluidBody& body = builtRocket();
  const FluidBody read = decodeFluidBody(encodeFluidBody(body, "rocket"), "rocket");
  EXPECT_EQ(contentHash(read), contentHash(body));
  ASSERT_EQ(read.wings.size(), body.wings.size());
  EXPECT_EQ(read.wings[1].name, body.wings[1].name);
  EXPECT_EQ(read.wings[1].is_joined, body.wings[1].is_joined);
  const Twist x{{0, 3, 1}, {20, 1, 2}};
  EXPECT_EQ(loadsOn(read)->load(x).vector(), loadsOn(body)->load(x).vector());
}

TEST(Wings, ThatNoBodyHasAreRefused) {
  const auto expectRefused = [](const std::string& words, const auto& change) {
    FluidBody body = builtRocket();
    change(body);
    expectRefusal(words, [&] { checkFluidBody(body, "rocket"); });
  };
  EXPECT_NO_THROW(checkFluidBody(builtRocket(), "rocket"));
  expectRefused("9", [](FluidBody& b) { b.part_of_triangle[0] = 9; });
  expectRefused("a body with wings has 0 triangles", [](FluidBody& b) {
    b.surface.triangles.own().clear();
    b.part_of_triangle.clear();
  });
  expectRefused("a sphere has wings", [](FluidBody& b) { b.sphere_radius = 1; });
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 200);
  BuildSettings settings;
  settings.sphere_radius = 1;
  settings.wings.labels.assign(static_cast<std::size_t>(ball.triangleCount()), 1);
  settings.wings.given.resize(1);
  expectRefusal("a sphere has no wings", [&] { makeFluidBody(ball, settings); });
}

TEST(Wings, AreNotSoughtInAFluidBody) {
  const TemporaryFolder folder;
  writeFluidBody(builtRocket(), folder / "rocket.ambient");
  ShapeDescription shape;
  shape.geometry = FluidBodyFile{folder / "rocket.ambient"};
  ShapeBuildSettings settings;
  settings.wings = "auto";
  expectRefusal("a fluid body keeps the wings that it has", [&] { buildShape(shape, settings); });
}

TEST(Wings, GrowWithTheBody) {
  const FluidBody& body = builtRocket();
  const FluidBody large = scaled(body, 3);
  const Twist x{{0, 3, 1}, {20, 1, 2}}, of_large{x.angular / 3, x.linear};
  const Wrench load = loadsOn(body)->load(x), on_large = loadsOn(large)->load(of_large);
  EXPECT_LT((on_large.force - 9 * load.force).norm(), 1e-9 * on_large.force.norm());
  EXPECT_LT((on_large.torque - 27 * load.torque).norm(), 1e-9 * on_large.torque.norm());
}

TEST(Wings, AreTheSameInAnyAttitudeAndDivision) {
  const Matrix3 rotation = turnAbout({1, 2, 3}, 1.1);
  std::vector<Named> turned = rocket();
  for (Named& part : turned) part.mesh.vertices = rotation * part.mesh.vertices;
  const FluidBody body = built(turned, "auto", 4000);
  ASSERT_EQ(body.wings.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Wing &fin = body.wings[i], &same = builtRocket().wings[i];
    EXPECT_NEAR(fin.span, same.span, 1e-3 * same.span);
    EXPECT_NEAR(fin.chord, same.chord, 1e-3 * same.chord);
    EXPECT_NEAR(fin.body_lift, same.body_lift, 5e-3);
    EXPECT_LT((fin.centre - rotation * same.centre).norm(), 1e-4);
  }
}

TEST(Wings, OfABodyThatIsOnePartLeaveItsBits) {
  const std::vector<Named> plate{{"wing", box({-0.5, -1.5, -0.015}, {0.5, 1.5, 0.015})}};
  const FluidBody body = built(plate, "auto");
  EXPECT_TRUE(body.wings.empty());
  EXPECT_EQ(contentHash(body), contentHash(built(plate, "none")));
}

TEST(Wings, WithoutNamesAreFoundByTheirShape) {
  std::vector<Named> nameless = rocket();
  for (Named& part : nameless) part.name = "part";
  const FluidBody body = built(nameless, "auto");
  ASSERT_EQ(body.wings.size(), 4u);
  for (const Wing& fin : body.wings) {
    EXPECT_TRUE(fin.is_joined);
    EXPECT_NEAR(fin.span, 0.06, 1e-3);
    EXPECT_NEAR(fin.chord, 0.0601, 1e-3);
    EXPECT_NEAR(fin.aspect, 2, 0.05);
    EXPECT_NEAR(fin.body_lift, 1.25, 0.01);
  }
}

TEST(Wings, LowOnASlenderHullAreFoundOnBothSides) {
  const FluidBody body = built({{"hull", makeEllipsoidMesh({0.5, 0.06, 0.06}, 800)},
                                {"plate", box({-0.05, -0.45, -0.045}, {0.07, 0.45, -0.025})}},
                               "auto");
  ASSERT_EQ(body.wings.size(), 2u);
  for (const Wing& wing : body.wings) {
    EXPECT_TRUE(wing.is_joined);
    EXPECT_NEAR(wing.span, 0.4, 0.01) << "the hull hides 5 cm of 45";
    EXPECT_NEAR(wing.chord, 0.12, 0.005);
  }
}

TEST(Wings, ThatMeetInAHubHaveTheirSpansAlongTheArms) {
  std::vector<Named> arms;
  const TriangleMesh arm =
      placed(makeBoxMesh({0.25, 0.06, 0.008}, 600), Matrix3::Identity(), {0.25, 0, 0});
  for (int k = 0; k < 3; ++k)
    arms.push_back({"part", placed(arm, turnAbout(Vector3d::UnitZ(), k * 2 * kPi / 3), {0, 0, 0})});
  const FluidBody body = built(arms, "auto");
  ASSERT_EQ(body.wings.size(), 3u);
  for (const Wing& wing : body.wings) {
    EXPECT_NEAR(wing.span, 0.48, 0.02) << "a third of the hub belongs to each";
    EXPECT_NEAR(wing.chord, 0.12, 0.005);
    EXPECT_GT(wing.span_axis.dot(wing.centre.normalized()), std::cos(10 * kPi / 180))
        << "samples share the hub out: its joints lie within half a chord of its middle";
  }
}

TEST(Wings, OfAMeshWithAHoleKeepTheirSections) {
  std::vector<Named> open = rocket();
  open[1].mesh.triangles.conservativeResize(3, open[1].mesh.triangleCount() - 1);
  const FluidBody body = built(open, "auto");
  ASSERT_EQ(body.wings.size(), 4u);
  for (const Wing& fin : body.wings) EXPECT_NEAR(fin.thickness, 0.002, 2e-5);
}

TEST(Wings, AreNotFoundOnBodiesWithoutOnes) {
  const std::vector<TriangleMesh> bodies{
      makeEllipsoidMesh({1, 1, 1}, 500),  makeEllipsoidMesh({3, 1, 0.8}, 500),
      makeBoxMesh({1, 1, 1}, 12),         makeBoxMesh({1, 2, 4}, 12),
      makeBoxMesh({5, 1.5, 0.5}, 300),    makeCylinderMesh(0.5, 4, 300),
      makeCapsuleMesh(0.5, 3, 400),       makeConeMesh(1, 2, 300),
      makeCylinderMesh(1, 1, 300),        makeBoxMesh({0.5, 1.5, 0.015}, 12),
      makeEllipsoidMesh({1, 3, 0.1}, 500)};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (const std::uint8_t label : findWings(bodies[i])) ASSERT_EQ(label, 1) << i << ": no part";
}

TEST(Wings, AreListedInAFile) {
  const TemporaryFolder folder;
  const auto list = [&](const std::string& text) {
    writeText(folder / "wings.json", text);
    return (folder / "wings.json").string();
  };
  const FluidBody one =
      built(rocket(), list(R"({"wings": [{"node": "fin_2", "name": "top", "aspect": 3}]})"));
  ASSERT_EQ(one.wings.size(), 1u);
  EXPECT_EQ(one.wings[0].name, "top");
  EXPECT_EQ(one.wings[0].aspect, 3);
  const FluidBody boxed = built(
      rocket(), list(R"({"wings": [{"box": [[-1, 0.021, -1], [1, 1, 1]]}], "rest": "auto"})"));
  EXPECT_EQ(boxed.wings.size(), 4u) << "two fins by the box, two by their names";
  const auto expectRefused = [&](const std::string& words, const std::string& text) {
    expectRefusal(words, [&] { built(rocket(), list(text)); });
  };
  expectRefused("wings[0] has no triangles", R"({"wings": [{"node": "keel"}]})");
  expectRefused("unknown key \"nodes\"", R"({"wings": [{"nodes": "fin*"}]})");
  expectRefused("span = -1", R"({"wings": [{"node": "fin*", "span": -1}]})");
}

}  // namespace
}  // namespace ambient
