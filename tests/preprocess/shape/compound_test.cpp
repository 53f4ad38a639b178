#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

ShapeDescription compoundOf(const std::string& parts) {
  const std::string text = R"({"type": "compound", "parts": [)" + parts + "]}";
  return readShape(nlohmann::json::parse(text), "folder", "scene.json: body \"b\"");
}

MassDistribution massOf(const std::string& parts, double* volume = nullptr) {
  const CheckedMesh checked = makeShapeMesh(compoundOf(parts));
  EXPECT_TRUE(checked.warnings.empty());
  EXPECT_TRUE(requireSound(checkMesh(checked.mesh, "again"), "again").warnings.empty());
  const MeshProperties properties = computeMassProperties(checked.mesh);
  if (volume != nullptr) *volume = properties.volume;
  return properties.uniform;
}

std::string refusalOf(const std::string& parts) {
  return messageOf([&] { makeShapeMesh(compoundOf(parts)); });
}

TEST(Compound, PartsThatOverlapAreCountedOnce) {
  double volume = 0;
  // An L: 4 x 1 x 1 along x, and 3 x 1 x 1 along y from its end, with one cube in common.
  const Vector3 centre =
      massOf(
          R"({"shape": {"type": "box", "size": [4, 1, 1]}, "position": [2, 0.5, 0.5]},
         {"shape": {"type": "box", "size": [1, 3, 1]}, "position": [0.5, 1.5, 0.5]})",
          &volume)
          .centre;
  EXPECT_NEAR(volume, 6, 1e-6);
  EXPECT_LT((centre - Vector3(1.5, 1, 0.5)).norm(), 1e-6);
}

TEST(Compound, PartsMayTouchOrLieApart) {
  double volume = 0;
  const Vector3 centre = massOf(
                             R"({"shape": {"type": "box", "size": [1, 1, 1]}},
         {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [1, 0, 0]},
         {"shape": {"type": "sphere", "radius": 0.5}, "position": [9, 0, 0]})",
                             &volume)
                             .centre;
  EXPECT_NEAR(volume, 2 + kPi / 6, 1e-5);
  EXPECT_NEAR(centre.x(), (1 + 9 * kPi / 6) / (2 + kPi / 6), 1e-4);
}

TEST(Compound, PartsAreTurned) {
  const Matrix3 inertia = massOf(R"({"shape": {"type": "cylinder", "radius": 0.1, "height": 6},
                                     "orientation": [1, 1, 0, 0]})")
                              .inertia;
  // A rod along y.
  EXPECT_NEAR(inertia(0, 0), 3.0, 0.02);
  EXPECT_NEAR(inertia(2, 2), 3.0, 0.02);
  EXPECT_LT(inertia(1, 1), 0.01);
}

TEST(Compound, WhatCannotBeAPartIsNamed) {
  EXPECT_EQ(refusalOf(R"({"shape": {"type": "sphere", "radius": 1}},
                       {"shape": {"type": "mesh", "file": "a.obj"}})"),
            "scene.json: body \"b\".parts[1]: a part of a compound cannot be a mesh");
  EXPECT_EQ(refusalOf(""), "scene.json: body \"b\": parts is []; must be at least 1 values");
  EXPECT_EQ(refusalOf(R"({"shape": {"type": "sphere", "radius": 0}})"),
            "scene.json: body \"b\": parts[0].shape.radius is 0; must be > 0");
  EXPECT_EQ(refusalOf(R"({"shape": {"type": "sphere", "radius": 1}, "orientation": [0, 0, 0, 0]})"),
            "scene.json: body \"b\".parts[0]: its orientation has length 0");
  EXPECT_NE(refusalOf(R"({"shape": {"type": "box", "size": [1, 1, 1e9]}})").find(".parts[0]: "),
            std::string::npos);
}

}  // namespace
}  // namespace ambient
