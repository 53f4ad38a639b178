#include <gtest/gtest.h>

#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/refusal_of.h"

namespace ambient {
namespace {

/// A box of 0.4 x 0.5 x 0.6 m at a corner, open on top.
Hold boxHold() {
  Hold hold;
  hold.name = "hold";
  for (int i = 0; i < 8; ++i)
    hold.surface.vertices.insert(hold.surface.vertices.end(),
                                 {0.4 * (i & 1), 0.5 * (i >> 1 & 1), 0.6 * (i >> 2)});
  hold.surface.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                            2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  hold.volume = 0.4 * 0.5 * 0.6;
  hold.centre = {0.2, 0.25, 0.3};
  hold.turning_inertia = Vector3(0.1, 0.2, 0.3).asDiagonal();
  hold.openings = {{{0, 0, 0.6, 0.4, 0, 0.6, 0.4, 0.5, 0.6, 0, 0.5, 0.6}, {0, 1, 2, 0, 2, 3}, -1}};
  return hold;
}

FluidBody vessel() {
  FluidBody body = test::exampleBody();
  body.holds = {boxHold()};
  return body;
}

TEST(Hold, ComesBackFromAFileOfVersion4) {
  const std::string bytes = encodeFluidBody(vessel(), "a");
  EXPECT_EQ(bytes[8], 4);
  const FluidBody back = decodeFluidBody(bytes, "a");
  ASSERT_EQ(back.holds.size(), 1u);
  const Hold &hold = back.holds[0], expected = boxHold();
  EXPECT_EQ(hold.name, expected.name);
  EXPECT_EQ(hold.surface.vertices, expected.surface.vertices);
  EXPECT_EQ(hold.surface.triangles, expected.surface.triangles);
  EXPECT_EQ(hold.volume, expected.volume);
  EXPECT_EQ(hold.centre, expected.centre);
  EXPECT_EQ(hold.turning_inertia, expected.turning_inertia);
  ASSERT_EQ(hold.openings.size(), 1u);
  EXPECT_EQ(hold.openings[0].outline, expected.openings[0].outline);
  EXPECT_EQ(hold.openings[0].lid, expected.openings[0].lid);
  EXPECT_EQ(hold.openings[0].to, -1);
  EXPECT_EQ(contentHash(back), contentHash(vessel()));
}

TEST(Hold, BodiesWithoutHoldsKeepVersionHashAndMemory) {
  const std::string bytes = encodeFluidBody(test::exampleBody(), "a");
  EXPECT_EQ(bytes[8], 1);
  const FluidBody back = decodeFluidBody(bytes, "a");
  EXPECT_EQ(back.holds.capacity(), 0u);
  EXPECT_EQ(scaled(back, 2).holds.capacity(), 0u);
  EXPECT_NE(contentHash(back), contentHash(vessel()));
}

TEST(Hold, WhatIsNoClosedRoomIsRefusedInOneLine) {
  const auto refusal = [](const auto& spoil) {
    FluidBody body = vessel();
    spoil(body.holds[0]);
    return test::refusalOf([&] { encodeFluidBody(body, "a.ambient"); });
  };
  EXPECT_EQ(refusal([](Hold& h) { h.volume = 0.13; }),
            "a.ambient: the triangles of a hold enclose 0.12 m^3, but its volume is 0.13");
  EXPECT_EQ(refusal([](Hold& h) { h.volume = -1; }),
            "a.ambient: volume of a hold is -1, but must be positive");
  EXPECT_EQ(refusal([](Hold& h) { h.openings[0].to = 1; }),
            "a.ambient: an opening leads to hold 1, but there are 1");
  EXPECT_EQ(refusal([](Hold& h) { h.openings[0].lid[0] = 4; }),
            "a.ambient: triangle 0 refers to vertex 4, but there are 4 vertices");
  EXPECT_EQ(refusal([](Hold& h) { h.openings[0].lid.clear(); }),
            "a.ambient: an opening of a hold has 4 corners and 0 triangles, but must have at least "
            "3 and 1");
  FluidBody many = vessel();
  many.holds.assign(5, boxHold());
  EXPECT_EQ(test::refusalOf([&] { encodeFluidBody(many, "a.ambient"); }),
            "a.ambient: the holds have 0.6 m^3, but the whole body has 0.5");
}

TEST(Hold, GrowsWithItsBody) {
  const FluidBody large = scaled(vessel(), 2);
  const Hold& hold = large.holds[0];
  EXPECT_DOUBLE_EQ(hold.volume, 8 * 0.12);
  EXPECT_TRUE(hold.centre.isApprox(Vector3(0.4, 0.5, 0.6)));
  EXPECT_DOUBLE_EQ(hold.turning_inertia(2, 2), 32 * 0.3);
  EXPECT_DOUBLE_EQ(hold.openings[0].outline[2], 1.2);
  EXPECT_NO_THROW(checkFluidBody(large, "large"));
}

}  // namespace
}  // namespace ambient
