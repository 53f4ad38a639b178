#include "preprocess/mesh/holds/hold_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/pools.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/vessel_meshes.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

double roomOf(const TriangleMesh& mesh) { return tetrahedraVolume(mesh, mesh.bounds().center()); }

/// Flat walls are of few triangles, whose sides are several of their neighbours': the areas add up
/// to 0 all the same.
void expectClosed(const TriangleMesh& mesh) {
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) sum += mesh.twiceArea(t);
  EXPECT_LT(sum.norm(), 1e-13 * mesh.extents().squaredNorm());
}

/// Finds the holds and checks what holds of every vessel: all surfaces are closed, and the volume
/// of the closed vessel is that of walls and holds.
Vessel vesselOf(const TriangleMesh& mesh, const HoldSearch& search = {}) {
  Vessel vessel = findHolds(mesh, search, "mesh");
  if (vessel.holds.empty()) return vessel;
  EXPECT_TRUE(isClosed(computeMeshEdges(vessel.closed)));
  double sum = roomOf(mesh);
  for (const Hold& hold : vessel.holds) {
    const TriangleMesh own = meshOf(hold.surface);
    expectClosed(own);
    EXPECT_GT(hold.volume, 0);
    sum += roomOf(own);
  }
  EXPECT_NEAR(roomOf(vessel.closed), sum, 1e-12 * sum);
  return vessel;
}

std::vector<double> volumesOf(const TriangleMesh& mesh, const HoldSearch& search = {}) {
  std::vector<double> volumes;
  for (const Hold& hold : vesselOf(mesh, search).holds) volumes.push_back(hold.volume);
  return volumes;
}

/// Expects one hold with so many openings; `error` is relative.
void expectHold(const TriangleMesh& mesh, double volume, std::size_t openings, double error = 1e-12,
                const HoldSearch& search = {}) {
  const Vessel vessel = vesselOf(mesh, search);
  ASSERT_EQ(vessel.holds.size(), 1u);
  EXPECT_NEAR(vessel.holds[0].volume, volume, error * volume);
  EXPECT_EQ(vessel.holds[0].openings.size(), openings);
}

/// Volume inside a wall of half an ellipsoid.
double halfBall(double a, double b, double c) { return 2.0 / 3 * kPi * a * b * c; }

TriangleMesh deformed(TriangleMesh mesh, const std::function<Vector3d(const Vector3d&)>& map) {
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v)
    mesh.vertices.col(v) = map(mesh.vertices.col(v));
  return mesh;
}

/// A barge of 2 x 1 x 0.5 m whose cells are solid where its walls are or `is_more` says.
TriangleMesh fitted(GridLines more, const std::function<bool(const Vector3d&)>& is_more,
                    const std::function<bool(const Vector3d&)>& is_cut = nullptr) {
  GridLines lines{{{-1, -.98, .98, 1}, {-.5, -.48, .48, .5}, {0, .02, .5}}};
  for (int axis = 0; axis < 3; ++axis)
    lines[axis].insert(lines[axis].end(), more[axis].begin(), more[axis].end());
  return makeBlocks(lines, [&](const Vector3d& p) {
    if (is_cut && is_cut(p)) return false;
    if (p.z() < 0.5 && (std::abs(p.x()) > .98 || std::abs(p.y()) > .48 || p.z() < .02)) return true;
    return is_more(p);
  });
}

bool nowhere(const Vector3d&) { return false; }

constexpr double kBarge = 1.96 * 0.96 * 0.48;

TEST(HoldSearch, BargeHasItsRoom) {
  const Vessel vessel = vesselOf(makeBarge({}));
  ASSERT_EQ(vessel.holds.size(), 1u);
  const Hold& hold = vessel.holds[0];
  EXPECT_NEAR(hold.volume, kBarge, 1e-14);
  EXPECT_NEAR(roomOf(vessel.closed), 1, 1e-14);
  EXPECT_TRUE(hold.centre.isApprox(Vector3d(0, 0, 0.26), 1e-12));
  ASSERT_EQ(hold.openings.size(), 1u);
  EXPECT_EQ(hold.openings[0].to, -1);
  EXPECT_EQ(hold.openings[0].lid.size(), 6u);
  EXPECT_EQ(hold.surface.triangles.size() / 3, 5 * 2 + 2u);  // of walls and floor, and the lid
  EXPECT_EQ(hold.surface.vertices.size() / 3, 8u);
  EXPECT_EQ(holdText(hold), "hold of 0.9032 m^3, rim 5.84 m round at (0, 0, 0.5)");
}

// docs/theory.md eq. (133): f(1) = 0.1565, f(2) = 0.4512, f(4) = 0.8018, the exact ratios of the
// inertia of an ideal fluid in a closed box to that of a rigid one.
TEST(HoldSearch, TurningInertiaIsThatOfAnIdealFluidInABox) {
  const auto rigid = [](const Vector3d& sides) {
    const Vector3d squares = sides.cwiseAbs2();
    return Matrix3(((Vector3d::Constant(squares.sum()) - squares) / 12).asDiagonal());
  };
  const Vector3d sides(4, 2, 1);
  const Matrix3 inertia = rigid(sides), turning = turningInertia(inertia);
  EXPECT_NEAR(turning(0, 0) / inertia(0, 0), 0.4512, 5e-5);
  EXPECT_NEAR(turning(1, 1) / inertia(1, 1), 0.8018, 5e-5);
  EXPECT_NEAR(turning(2, 2) / inertia(2, 2), 0.4512, 5e-5);
  const Matrix3 cube = rigid({1, 1, 1});
  EXPECT_NEAR(turningInertia(cube)(0, 0) / cube(0, 0), 0.1565, 5e-5);
}

TEST(HoldSearch, BulkheadToTheRimMakesTwoHolds) {
  Barge barge;
  barge.bulkheads = {0.0};
  for (const double volume : volumesOf(makeBarge(barge)))
    EXPECT_NEAR(volume, 0.96 * 0.97 * 0.48, 1e-14);
  EXPECT_EQ(volumesOf(makeBarge(barge)).size(), 2u);
  barge.bulkhead_top = 0.45;  // 90 % of the depth: still two, which meet above it
  const std::vector<Hold> holds = vesselOf(makeBarge(barge)).holds;
  ASSERT_EQ(holds.size(), 2u);
  EXPECT_NEAR(holds[0].volume + holds[1].volume, kBarge - 0.02 * 0.96 * 0.43, 1e-12);
  ASSERT_EQ(holds[0].openings.size(), 2u);
  EXPECT_EQ(holds[0].openings[0].to, -1);
  EXPECT_EQ(holds[0].openings[1].to, 1);
  EXPECT_EQ(holds[1].openings.size(), 1u);
  barge.bulkhead_top = 0.2;  // a baffle
  expectHold(makeBarge(barge), kBarge - 0.02 * 0.96 * 0.18, 1);
}

TEST(HoldSearch, DoorInABulkheadJoinsTwoHolds) {
  const TriangleMesh mesh = fitted({{{-.01, .01}, {-.2, .2}, {.1, .4}}}, [](const Vector3d& p) {
    const bool in_door = std::abs(p.y()) < .2 && p.z() > .1 && p.z() < .4;
    return std::abs(p.x()) < .01 && p.z() < 0.5 && !in_door;
  });
  const Vessel vessel = vesselOf(mesh);
  ASSERT_EQ(vessel.holds.size(), 1u) << "water meets below the bulkhead's top";
  EXPECT_NEAR(vessel.holds[0].volume, kBarge - 0.02 * (0.96 * 0.48 - 0.4 * 0.3), 1e-12);
}

TEST(HoldSearch, HolesAreOpenings) {
  Barge barge;
  barge.hole = {-0.1, 0.1, 0.1, 0.2};
  expectHold(makeBarge(barge), kBarge, 2);
  // In the lowest place: no pool as it stands.
  const TriangleMesh leaking =
      fitted({{{-.05, .05}, {-.05, .05}, {}}}, nowhere,
             [](const Vector3d& p) { return std::abs(p.x()) < .05 && std::abs(p.y()) < .05; });
  expectHold(leaking, kBarge, 2);
}

TEST(HoldSearch, FittingsBelongToTheRoom) {
  expectHold(
      fitted({{{-.1, .1}, {}, {.3, .33}}},  // a bench, free below
             [](const Vector3d& p) { return std::abs(p.x()) < .1 && p.z() > .3 && p.z() < .33; }),
      kBarge - .2 * .96 * .03, 1);
  expectHold(fitted({{{-.5, 0}, {}, {.1, .2}}},  // steps
                    [](const Vector3d& p) {
                      return (p.x() < -.5 && p.z() < .2) || (p.x() < 0 && p.z() < .1);
                    }),
             kBarge - .48 * .96 * .18 - .5 * .96 * .08, 1);
  // A pillar that hangs from a beam ends in the room: an island at its height, no spill.
  expectHold(fitted({{{-.1, .1}, {-.1, .1}, {.2, .4}}},
                    [](const Vector3d& p) {
                      const bool is_beam = std::abs(p.x()) < .1 && p.z() > .4 && p.z() < .5;
                      return is_beam || (std::abs(p.x()) < .1 && std::abs(p.y()) < .1 &&
                                         p.z() > .2 && p.z() < .5);
                    }),
             kBarge - .2 * .96 * .1 - .2 * .2 * .2, 2, 1e-12);
}

TEST(HoldSearch, HandlesDecksAndCounters) {
  const auto isBar = [](const Vector3d& p, double x, double y, double low, double high) {
    return std::abs(p.x()) < x && std::abs(p.y()) < y && p.z() > low && p.z() < high;
  };
  // A mug's handle on its side.
  expectHold(fitted({{{1.15, 1.2}, {-.05, .05}, {.1, .15, .35, .4}}},
                    [&](const Vector3d& p) {
                      return p.x() > 1 && isBar(p, 1.2, .05, .1, .4) &&
                             (p.x() > 1.15 || p.z() < .15 || p.z() > .35);
                    }),
             kBarge, 1);
  // A basket's handle, from the middle of the rim over the lid.
  expectHold(fitted({{{-.995, -.985, .985, .995}, {-.05, .05}, {.75, .8}}},
                    [&](const Vector3d& p) {
                      return isBar(p, .995, .05, .5, .8) && (std::abs(p.x()) > .985 || p.z() > .75);
                    }),
             kBarge, 1);
  // A kayak: the tube of its cockpit is outside.
  expectHold(fitted({{{-.3, .3}, {-.3, .3}, {.48}}},
                    [&](const Vector3d& p) {
                      return p.z() > .48 && (std::abs(p.x()) > .3 || std::abs(p.y()) > .3);
                    }),
             1.96 * .96 * .46, 1);
  // A basin in a counter.
  expectHold(makeBlocks({{{-1, -.25, .25, 1}, {-.5, -.2, .2, .5}, {0, .1, .3}}},
                        [&](const Vector3d& p) { return !isBar(p, .25, .2, .1, .3); }),
             .5 * .4 * .2, 1);
}

TEST(HoldSearch, LowBowIsTheRim) {
  const TriangleMesh landing_craft = fitted({{{}, {}, {.2}}}, nowhere, [](const Vector3d& p) {
    return p.x() > .98 && p.z() > .2 && std::abs(p.y()) < .48;
  });
  const Vessel vessel = vesselOf(landing_craft);
  ASSERT_EQ(vessel.holds.size(), 1u);
  // The lid bends down to the bow, either way.
  EXPECT_NEAR(vessel.holds[0].volume, kBarge, 0.02 * 0.96 * 0.3 + 1e-12);
}

TEST(HoldSearch, BowlsAndCups) {
  expectHold(makeBowl(0.2, 0.005), halfBall(.195, .195, .195), 1, 5e-3);
  expectHold(makeCup(0.05, 0.2, 0.002), kPi * .05 * .05 * .2, 1, 2e-3);
  // Between two polygons the cup's room is exact.
  expectHold(makeCup(0.05, 0.2, 0.002, 6), 3 * std::sqrt(3.0) / 2 * .05 * .05 * .2, 1);
}

TEST(HoldSearch, RoundRimIsMetOnItsCrest) {
  constexpr double kRadius = 0.2, kWall = 0.02;
  Profile profile;
  constexpr int kRings = 24, kRim = 8;
  for (int i = 0; i <= kRings; ++i)
    profile.emplace_back(i == 0 ? 0 : kRadius * std::sin(kPi / 2 * i / kRings),
                         -kRadius * std::cos(kPi / 2 * i / kRings));
  for (int i = 1; i < kRim; ++i)
    profile.emplace_back(kRadius - kWall / 2 + kWall / 2 * std::cos(kPi * i / kRim),
                         kWall / 2 * std::sin(kPi * i / kRim));
  for (int i = kRings; i >= 0; --i)
    profile.emplace_back(i == 0 ? 0 : (kRadius - kWall) * std::sin(kPi / 2 * i / kRings),
                         -(kRadius - kWall) * std::cos(kPi / 2 * i / kRings));
  // Between the half ball and what reaches up to the crest.
  expectHold(makeLathe(profile, 64), (halfBall(.18, .18, .18) + 0.01329) / 2, 1, 0.05);
}

// A bowl whose rim goes up to a spout, of which one triangle belongs to the room: its lower edge is
// no edge of the lid, though it would cut off the ear of best shape.
TEST(HoldSearch, LidKeepsOffEdgesOfTheMesh) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 7);
  mesh.vertices << -.5, .5, .5, 0, -.5, 0, 0,    //
      -.8, -.8, 0, std::sqrt(.75), 0, -.3, -.2,  //
      0, 0, 0, .1, 0, -.15, -1;
  mesh.triangles.resize(3, 10);
  mesh.triangles.col(0) << 2, 3, 4;
  constexpr int kRoom[] = {0, 1, 2, 4}, kRim[] = {0, 1, 2, 3, 4};
  for (int i = 0; i < 4; ++i) mesh.triangles.col(1 + i) << kRoom[i], kRoom[(i + 1) % 4], 5;
  for (int i = 0; i < 5; ++i) mesh.triangles.col(5 + i) << kRim[(i + 1) % 5], kRim[i], 6;
  const std::vector<double> volumes = volumesOf(mesh);
  ASSERT_EQ(volumes.size(), 1u);
  EXPECT_GT(volumes[0], .8 * .15 / 3);
  EXPECT_LT(volumes[0], .8 * .15 / 3 + .1 * (.8 + std::sqrt(.75) / 2));
}

TEST(HoldSearch, WhichWayIsUp) {
  const TriangleMesh bowl = makeBowl(0.2, 0.01, 24, 8);
  HoldSearch search;
  search.up = -Vector3d::UnitZ();
  EXPECT_TRUE(vesselOf(bowl, search).holds.empty());
  search.up = Vector3d(0.5, 0, 0.9).normalized();
  EXPECT_EQ(vesselOf(bowl, search).holds.size(), 1u);
  TriangleMesh lying = bowl;
  lying.vertices =
      Eigen::AngleAxisd(-kPi / 2, Vector3d::UnitX()).toRotationMatrix() * bowl.vertices;
  EXPECT_EQ(vesselOf(lying).holds.size(), 1u) << "its room opens to +y";
  search.is_wanted = false;
  EXPECT_TRUE(findHolds(bowl, search, "bowl").holds.empty());
}

TEST(HoldSearch, WhatHoldsNoWaterHasNoHold) {
  const TriangleMesh catamaran =
      makeBlocks({{{-1, 1}, {-.5, -.3, .3, .5}, {0, .3, .35}}},
                 [](const Vector3d& p) { return p.z() > .3 || std::abs(p.y()) > .3; });
  const TriangleMesh table =
      makeBlocks({{{-.5, -.4, .4, .5}, {-.5, -.4, .4, .5}, {0, .7, .75}}}, [](const Vector3d& p) {
        return p.z() > .7 || (std::abs(p.x()) > .4 && std::abs(p.y()) > .4);
      });
  const TriangleMesh corner =
      makeBlocks({{{0, .02, 1}, {0, .02, 1}, {0, .02, 1}}},
                 [](const Vector3d& p) { return p.x() < .02 || p.y() < .02 || p.z() < .02; });
  const TriangleMesh tube = makeLathe({{0.1, 0}, {0.12, 0}, {0.12, 0.5}, {0.1, 0.5}, {0.1, 0}}, 24);
  const TriangleMesh welded = weldVertices(tube, 1e-9);
  for (const TriangleMesh& mesh : {catamaran, table, corner, welded, makeBoxMesh({1, 1, 1}, 12),
                                   makeEllipsoidMesh({1, 2, 3}, 320)}) {
    ASSERT_TRUE(isClosed(computeMeshEdges(mesh)));
    EXPECT_TRUE(vesselOf(mesh).holds.empty());
  }
}

TEST(HoldSearch, SpoonThroughTheLidLeavesTheHoldOut) {
  const TriangleMesh mesh = fitted({{{-.1, .1}, {-.1, .1}, {.9}}}, [](const Vector3d& p) {
    return std::abs(p.x()) < .1 && std::abs(p.y()) < .1;
  });
  const Vessel vessel = vesselOf(mesh);
  EXPECT_TRUE(vessel.holds.empty());
  ASSERT_EQ(vessel.lines.size(), 1u);
  EXPECT_EQ(vessel.lines[0],
            "mesh: the hold around (0, 0, 0.46) is left out: the mesh passes through its lid");
  const Vessel scaled = findHolds(mesh, {true, std::nullopt, 0.5}, "mesh");  // 1 is half a metre
  ASSERT_EQ(scaled.lines.size(), 1u);
  EXPECT_EQ(scaled.lines[0],
            "mesh: the hold around (0, 0, 0.23) is left out: the mesh passes through its lid");
}

// As people publish them: round bottoms, sheer, flanges, fittings, and noise of 1 mm.
TEST(HoldSearch, MeshesLikeThosePeoplePublish) {
  const double ball = halfBall(.19, .19, .19);
  const TriangleMesh bowl = makeBowl(0.2, 0.01, 48, 16);
  const auto stretched = [&](const Vector3d& by) {
    return deformed(bowl, [&](const Vector3d& p) -> Vector3d { return by.cwiseProduct(p); });
  };
  expectHold(stretched({4, 1.5, 2}), 12 * ball, 1, 0.01);  // a bathtub
  // A canoe: ends that taper and rise.
  const TriangleMesh canoe = deformed(bowl, [](const Vector3d& p) {
    const double x = p.x() / 0.2;
    return Vector3d(12 * p.x(), p.y() * (2 - x * x), 1.5 * p.z() + 0.2 * x * x);
  });
  EXPECT_EQ(vesselOf(canoe).holds.size(), 1u);
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0, 0.001);
  const TriangleMesh noisy = deformed(makeBowl(0.2, 0.02, 48, 16), [&](const Vector3d& p) {
    const double x = noise(generator), y = noise(generator), z = noise(generator);
    return Vector3d(p + Vector3d(x, y, z));
  });
  expectHold(noisy, halfBall(.18, .18, .18), 1, 0.02);
  // A soup plate with a flange that rises to its edge.
  const TriangleMesh plate = makeLathe({{0, 0},
                                        {.06, 0},
                                        {.08, .02},
                                        {.12, .03},
                                        {.118, .033},
                                        {.078, .023},
                                        {.058, .004},
                                        {0, .004}},
                                       48);
  EXPECT_EQ(vesselOf(plate).holds.size(), 1u);
  // A funnel keeps no water, however it is tilted by 30 degrees.
  const TriangleMesh funnel = weldVertices(
      makeLathe({{.01, 0}, {.012, 0}, {.012, .05}, {.1, .13}, {.098, .132}, {.01, .055}, {.01, 0}},
                32),
      1e-9);
  EXPECT_TRUE(vesselOf(funnel).holds.empty());
}

TEST(HoldSearch, PoolsAreThoseOfRain) {
  const std::vector<Pool> pools = findPools(makeBarge({}), Vector3d::UnitZ());
  ASSERT_EQ(pools.size(), 1u);
  EXPECT_NEAR(pools[0].volume, kBarge, 1e-12);
  EXPECT_NEAR(pools[0].depth, 0.48, 1e-12);
  // Far from the origin, turned: the same.
  TriangleMesh far = makeBarge({});
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 3).normalized());
  far.vertices = (turn.toRotationMatrix() * far.vertices).colwise() + Vector3d(1000, -2000, 500);
  const std::vector<Pool> same = findPools(far, turn * Vector3d::UnitZ());
  ASSERT_EQ(same.size(), 1u);
  EXPECT_NEAR(same[0].depth, 0.48, 1e-9);
}

}  // namespace
}  // namespace ambient
