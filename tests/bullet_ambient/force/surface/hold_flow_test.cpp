#include "bullet_ambient/force/surface/hold_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ambient {
namespace {

constexpr double kGravity = 9.81, kDischarge = 0.6;
const double kFall = kDischarge * std::sqrt(2 * kGravity);

/// A rectangle of corners a, a + u, a + u + v, a + v.
HoldOpening rectangle(const Vector3& a, const Vector3& u, const Vector3& v) {
  HoldOpening opening;
  for (const Vector3& corner : {a, Vector3(a + u), Vector3(a + u + v), Vector3(a + v)})
    opening.outline.insert(opening.outline.end(), {corner.x(), corner.y(), corner.z()});
  opening.lid = {0, 1, 2, 0, 2, 3};
  return opening;
}

/// The rim of a hold of 1.96 x 0.96 m at z = 0.5 m.
OpeningShape rim() {
  return OpeningShape(rectangle({-0.98, -0.48, 0.5}, {1.96, 0, 0}, {0, 0.96, 0}));
}

TEST(HoldFlow, PiecesMakeUpTheOpening) {
  const OpeningShape shape = rim();
  Vector3 round(0, 0, 0);
  double length = 0, area = 0;
  for (const auto& edge : shape.edges()) {
    round += edge.way;
    length += edge.way.norm();
  }
  for (const auto& piece : shape.pieces()) area += piece.area;
  EXPECT_LT(round.norm(), 1e-15);
  EXPECT_NEAR(length, 5.84, 1e-14);
  EXPECT_NEAR(area, 1.96 * 0.96, 1e-14);
}

// Poleni's weir, 2/3 C sqrt(2g) L H^1.5, while the rim is little below, and an orifice, C A
// sqrt(2gH), where it lies deep.
TEST(HoldFlow, RimIsAWeirAndThenAnOrifice) {
  const double shallow = flowThrough(rim(), {}, 0.52, 0);
  EXPECT_NEAR(shallow, 2.0 / 3 * kFall * 5.84 * std::pow(0.02, 1.5), 1e-14);
  EXPECT_NEAR(shallow, 0.029266, 1e-6);
  const double deep = flowThrough(rim(), {}, 1.5, 0);
  EXPECT_NEAR(deep, kFall * 1.96 * 0.96, 1e-12);
  EXPECT_NEAR(deep, 5.0007, 1e-4);
  EXPECT_EQ(flowThrough(rim(), {}, 0.499, 0), 0);
  EXPECT_EQ(flowThrough(rim(), {}, 0, 0.52), -shallow) << "out as in";
}

// A slot from its sill to full cover: C 2/3 sqrt(2g) b (h^1.5 - (h - a)^1.5).
TEST(HoldFlow, HoleInTheSideIsRightAtAnyCover) {
  const OpeningShape hole(rectangle({1, -0.1, 0}, {0, 0.2, 0}, {0, 0, 0.1}));
  for (const double submergence : {0.5, 1.0, 1.5, 3.0}) {
    const double h = 0.1 * submergence, above = std::max(0.0, h - 0.1);
    const double exact = 2.0 / 3 * kFall * 0.2 * (std::pow(h, 1.5) - std::pow(above, 1.5));
    EXPECT_NEAR(flowThrough(hole, {}, h, -1), exact, 1e-3 * exact) << submergence;
  }
}

// A wave at one long side alone: its part of the weir.
TEST(HoldFlow, WaterStandsHigherWhereTheWaveIs) {
  const OpeningShape opening = rim();
  std::vector<double> rises(opening.edges().size(), 0.02);
  EXPECT_NEAR(flowThrough(opening, {}, 0.5, 0, rises.data()), flowThrough(opening, {}, 0.52, 0),
              1e-15);
  EXPECT_NEAR(flowThrough(opening, {}, 1.48, 0, rises.data()), flowThrough(opening, {}, 1.5, 0),
              1e-14);
  for (std::size_t i = 0; i < rises.size(); ++i)
    rises[i] = opening.edges()[i].middle.y() < -0.479 ? 0.02 : -0.1;
  const double side = 2.0 / 3 * kFall * 1.96 * std::pow(0.02, 1.5);
  EXPECT_NEAR(flowThrough(opening, {}, 0.5, 0, rises.data()), side, 1e-14);
}

// Whether its box is above, or its corners alone.
TEST(HoldFlow, OpeningIsAboveWhatIsBelowItsCorners) {
  const OpeningShape opening = rim();
  for (const Vector3& tilted : {Vector3(0, 0, 1), Vector3(0.2, 0, 1), Vector3(-0.1, 0.3, 1)}) {
    const Vector3 normal = tilted.normalized();
    const double lowest = -opening.top(-normal);
    EXPECT_TRUE(opening.isAbove(lowest - 1e-9, normal));
    EXPECT_FALSE(opening.isAbove(lowest + 1e-9, normal));
  }
  const OpeningShape hole(openingOf({{0, 0, 0}, {1, 0, 0}, 0.01}));
  const Vector3 between = Vector3(0, 1, 1).normalized();  // a corner of the box, none of the hole
  EXPECT_TRUE(hole.isAbove(-hole.top(between) - 1e-9, between));
}

// An octagon of the area, which looks out.
TEST(HoldFlow, HoleInAWallHasItsAreaAndDirection) {
  const Vector3 normal = Vector3(1, 2, -2) / 3, place(0.3, -0.2, 0.1);
  const OpeningShape hole(openingOf({place, normal, 0.01}));
  EXPECT_LT((hole.outward() - 0.01 * normal).norm(), 1e-16);
  double area = 0;
  for (const auto& piece : hole.pieces()) {
    area += piece.area;
    EXPECT_NEAR((piece.place - place).dot(normal), 0, 1e-15);
  }
  EXPECT_NEAR(area, 0.01, 1e-16);
  EXPECT_NEAR((hole.corners()[0] - place).norm(), std::sqrt(0.01 / std::sqrt(8)), 1e-15);
}

// Pressure of the air on one side drives water as a head does, and only water flows.
TEST(HoldFlow, AirPressureDrivesWaterThroughALid) {
  const OpeningShape opening = rim();
  EXPECT_NEAR(sealedFlowThrough(opening, {}, 1.5, 1.2, 0.1), kFall * 1.96 * 0.96 * std::sqrt(0.2),
              1e-12);
  EXPECT_NEAR(sealedFlowThrough(opening, {}, 1.5, 1.2, 0.4), -kFall * 1.96 * 0.96 * std::sqrt(0.1),
              1e-12);
  EXPECT_NEAR(sealedFlowThrough(opening, {}, 1.5, 0.4, 0.7), kFall * 1.96 * 0.96 * std::sqrt(0.3),
              1e-12);
  EXPECT_EQ(sealedFlowThrough(opening, {}, 1.5, 0.4, 1.2), 0) << "air, which no opening gives way";
}

TEST(HoldFlow, DrownedWeirSlowsDown) {
  double last = flowThrough(rim(), {}, 0.55, 0);
  for (const double inside : {0.51, 0.53, 0.549}) {
    const double flow = flowThrough(rim(), {}, 0.55, inside);
    EXPECT_LT(flow, last) << inside;
    EXPECT_GT(flow, 0) << inside;
    last = flow;
  }
  EXPECT_EQ(flowThrough(rim(), {}, 0.55, 0.55), 0);
}

TEST(HoldFlow, LevelsMeetAndNeverCrossAtAnyStep) {
  const OpeningShape hole(rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 0.5}));
  for (const double duration : {0.01, 1.0, 100.0}) {
    WaterSide high{0.9, 1, 0.9, 0.1}, low{0.1, 2, 0.2, 1.8};
    double sum = high.volume + low.volume;
    for (int i = 0; i < 2000; ++i) {
      const double q = volumeThrough(hole, {}, high, low, duration);
      EXPECT_GE(q, 0);
      high.height -= q / high.area;
      low.height += q / low.area;
      high.volume -= q;
      low.volume += q;
      EXPECT_GE(high.height, low.height - 1e-12) << duration << ' ' << i;
    }
    EXPECT_NEAR(high.volume + low.volume, sum, 1e-14);
    EXPECT_NEAR(high.height, low.height, 1e-5) << duration;
  }
}

TEST(HoldFlow, NoMoreFlowsThanThereIsWaterOrRoom) {
  const WaterSide dregs{0.9, 1, 1e-3, 1}, full{0.1, 1, 1, 1e-4};
  const OpeningShape hole(rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 0.5}));
  EXPECT_DOUBLE_EQ(volumeThrough(hole, {}, dregs, {}, 10), 1e-3);
  EXPECT_DOUBLE_EQ(volumeThrough(hole, {}, WaterSide{0.9}, full, 10), 1e-4);
  EXPECT_DOUBLE_EQ(volumeThrough(hole, {}, full, WaterSide{0.9}, 10), -1e-4);
}

}  // namespace
}  // namespace ambient
