#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/preprocess/mesh/mesh_files.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/support/refusal_of.h"
#include "tests/support/refusals.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

ShapeDescription shapeOf(const std::string& text) {
  return readShape(nlohmann::json::parse(text), "folder", "scene.json: body \"b\"");
}

std::string refusal(const nlohmann::json& shape) {
  const std::string message = messageOf([&] { makeShapeMesh(shapeOf(shape.dump())); });
  const std::string source = "scene.json: body \"b\": ";
  EXPECT_EQ(message.substr(0, source.size()), source);
  return message.substr(std::min(message.size(), source.size()));
}

TEST(Shape, SolidsHaveTheVolumeOfTheSmoothBody) {
  const std::vector<std::pair<std::string, double>> cases{
      {R"({"type":"sphere","radius":0.5})", kPi / 6},
      {R"({"type":"box","half_sizes":[1,2,3]})", 48},
      {R"({"type":"box","size":[1,2,3]})", 6},
      {R"({"type":"ellipsoid","semi_axes":[0.5,0.4,0.1]})", 4 * kPi / 3 * 0.02},
      {R"({"type":"cylinder","radius":0.5,"height":0.3})", kPi * 0.25 * 0.3},
      {R"({"type":"capsule","radius":0.5,"height":2})", kPi * 0.25 * (2 + 2.0 / 3)},
      {R"({"type":"cone","radius":0.5,"height":0.3})", kPi * 0.25 * 0.1}};
  for (const auto& [text, volume] : cases) {
    const ShapeDescription shape = shapeOf(text);
    EXPECT_FALSE(isSheet(shape)) << text;
    const TriangleMesh mesh = makeShapeMesh(shape).mesh;
    EXPECT_LE(mesh.triangleCount(), ShapeDescription::kDefaultFaces) << text;
    EXPECT_GT(mesh.triangleCount(), 900) << text;
    EXPECT_NEAR(computeMassProperties(mesh).volume / volume, 1, 1e-13) << text;
    EXPECT_TRUE(requireSound(checkMesh(mesh, text), text).warnings.empty());
  }
}

TEST(Shape, SheetsHaveTheAreaOfTheSmoothSurface) {
  const std::vector<std::pair<std::string, double>> cases{
      {R"({"type":"sheet","size":[0.3,2]})", 0.6},
      {R"({"type":"sheet","semi_axes":[0.3,2]})", kPi * 0.6}};
  for (const auto& [text, area] : cases) {
    const ShapeDescription shape = shapeOf(text);
    EXPECT_TRUE(isSheet(shape)) << text;
    const TriangleMesh mesh = makeShapeMesh(shape).mesh;
    EXPECT_NEAR(computeSheetMassProperties(mesh).area / area, 1, 1e-13) << text;
    EXPECT_TRUE(requireSound(checkMesh(mesh, text, true), text).warnings.empty());
  }
}

TEST(Shape, FacesSetTheResolution) {
  const auto faces = [](const char* number) {
    const std::string text = R"({"type":"sphere","radius":1,"faces":)" + std::string(number) + "}";
    return makeShapeMesh(shapeOf(text)).mesh.triangleCount();
  };
  EXPECT_EQ(faces("500"), 500);
  EXPECT_EQ(faces("20"), 20);
}

TEST(Shape, MeshesAreReadRelativeToTheFileThatNamesThem) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "meshes");
  writeText(folder / "meshes" / "t.obj", objText(unitTetrahedron()));
  writeText(folder / "s.json", R"({"type":"mesh","file":"meshes/t.obj","scale":2})");
  const ShapeDescription shape = readShapeFile(folder / "s.json");
  EXPECT_NEAR(computeMassProperties(makeShapeMesh(shape).mesh).volume, 8.0 / 6, 1e-6);
  EXPECT_EQ(fileOf(shape), folder / "meshes" / "t.obj");
}

TEST(Shape, OpenMeshesAreSheetsOnlyIfCalledSo) {
  const TemporaryFolder folder;
  const auto file = folder / "open.obj";
  writeText(file, objText(makeShapeMesh(shapeOf(R"({"type":"sheet","size":[1,1]})")).mesh));
  const auto read = [&](const std::string& type) {
    return makeShapeMesh(
        readShape({{"type", type}, {"file", "open.obj"}}, folder.path(), "x.json"));
  };
  EXPECT_EQ(messageOf([&] { read("sheet"); }), "no error");
  const std::string message = messageOf([&] { read("mesh"); });
  EXPECT_EQ(message.find(file.string() + ": not watertight: "), 0u) << message;
  EXPECT_NE(message.find("--sheet"), std::string::npos) << message;
}

TEST(Shape, BrokenMeshesAreWrappedUnlessStrict) {
  const TemporaryFolder folder;
  writeText(folder / "t.obj", objText(withoutTriangle(unitTetrahedron(), 0)));
  const auto read = [&](const nlohmann::json& strict) {
    return makeShapeMesh(readShape({{"type", "mesh"}, {"file", "t.obj"}, {"strict", strict}},
                                   folder.path(), "x.json"));
  };
  EXPECT_NEAR(6 * computeMassProperties(read(false).mesh).volume, 1, 0.03);
  EXPECT_EQ(read(false).warnings.size(), 1u);
  const std::string message = messageOf([&] { read(true); });
  EXPECT_EQ(message.find((folder / "t.obj").string() + ": not watertight: "), 0u) << message;
}

TEST(Shape, WhatCannotBeIsRefused) { expectRefusals(AMBIENT_SHAPE_REFUSALS, "shapes", refusal); }

TEST(Refusals, AreOfWholeMessagesUnlessDotsStandForTheRest) {
  EXPECT_TRUE(isMessage("abc", "abc") && isMessage("abc", "ab...") && isMessage("abc", "...bc"));
  EXPECT_TRUE(isMessage("abc", "...b...") && isMessage("", ""));
  EXPECT_FALSE(isMessage("abc", "ab") || isMessage("abc", "bc") || isMessage("abc", ""));
  EXPECT_FALSE(isMessage("abc", "b...") || isMessage("abc", "...b") || isMessage("abc", "...d..."));
}

TEST(Shape, FilesThatAreNotJsonAreRefused) {
  const TemporaryFolder folder;
  const auto refusalOf = [&](const std::string& text) {
    const auto file = folder / "s.json";
    writeText(file, text);
    const std::string message = messageOf([&] { readShapeFile(file); });
    EXPECT_EQ(message.find(file.string() + ": "), 0u) << message;
    return message.substr(file.string().size() + 2);
  };
  expectRefusals(AMBIENT_SHAPE_REFUSALS, "texts", refusalOf);
  const std::string deep(100000, '[');
  EXPECT_EQ(refusalOf(deep), "is nested deeper than 100 levels");
  EXPECT_EQ(messageOf([&] { readShapeFile(folder / "no.json"); }),
            (folder / "no.json").string() + ": no such file");
}

// JsonSchema ignores unknown keywords: the schema must contain none.
TEST(Shape, TheSchemasUseKnownKeywordsOnly) {
  const std::set<std::string> known{"$schema",
                                    "$id",
                                    "$ref",
                                    "title",
                                    "description",
                                    "type",
                                    "enum",
                                    "required",
                                    "items",
                                    "minItems",
                                    "maxItems",
                                    "minLength",
                                    "minimum",
                                    "maximum",
                                    "exclusiveMinimum",
                                    "allOf",
                                    "if",
                                    "then",
                                    "const",
                                    "properties",
                                    "definitions",
                                    "additionalProperties"};
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& schema) {
    for (const auto& [keyword, value] : schema.items()) {
      EXPECT_EQ(known.count(keyword), 1u) << keyword;
      if (keyword == "properties" || keyword == "definitions" || keyword == "allOf")
        for (const auto& part : value) visit(part);
      if (keyword == "items" || keyword == "if" || keyword == "then") visit(value);
    }
  };
  for (const char* name : {"shape.schema.json", "scene.schema.json"})
    visit(nlohmann::json::parse(readText(std::filesystem::path(AMBIENT_SCHEMAS) / name)));
}

// Types listed in the schema and definitions of shapes must be equal sets.
TEST(Shape, TheSchemaDefinesTheTypesItLists) {
  for (const auto& type : shapeSchema()["properties"]["type"]["enum"]) {
    const auto& definition = shapeSchema()["definitions"][type.get<std::string>()];
    EXPECT_FALSE(definition["additionalProperties"].get<bool>()) << type;
  }
}

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
