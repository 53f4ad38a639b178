#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "demos/scene/scene_reader.h"
#include "demos/simulation/output/motion_recorder.h"
#include "demos/simulation/output/run_files.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

TEST(OutputFolder, VanishesWithItsParentsUnlessKept) {
  const TemporaryFolder folder;
  { const OutputFolder output(folder / "a/b/c"); }
  EXPECT_TRUE(folder.empty());
  {
    OutputFolder output(folder / "a/b/c");
    output.keep();
  }
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
}

TEST(OutputFolder, KeepsAFolderThatWasThere) {
  const TemporaryFolder folder;
  { const OutputFolder output(folder.path()); }
  EXPECT_TRUE(std::filesystem::is_directory(folder.path()));
}

TEST(OutputFolder, CannotBeAFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "x";
  EXPECT_THROW(OutputFolder(folder / "a"), std::runtime_error);
  EXPECT_THROW(OutputFolder(folder / "a/b"), std::runtime_error);
}

TEST(TrajectoryText, RowsCarrySeventeenDigitsInTheOrderOfTheHeader) {
  MotionSample sample;
  sample.time = 0.1;
  sample.position = Vector3(1.0 / 3, 2, -1e-7);
  sample.orientation = Quaternion(0.5, -0.5, 0.5, -0.5);
  sample.twist = {Vector3(4, 5, 6), Vector3(7, 8, 9)};
  EXPECT_STREQ(kTrajectoryHeader, "time,body,px,py,pz,qw,qx,qy,qz,wx,wy,wz,vx,vy,vz");
  EXPECT_EQ(trajectoryRow("plate", sample),
            "0.10000000000000001,plate,0.33333333333333331,2,-9.9999999999999995e-08,"
            "0.5,-0.5,0.5,-0.5,4,5,6,7,8,9\n");
}

TEST(SceneFiles, AreAllValidAndDescribed) {
  const auto files = listScenes({std::filesystem::path(AMBIENT_DATA) / "scenes"});
  EXPECT_GE(files.size(), 8u);
  for (const auto& file : files) {
    const Scene scene = readScene(file);
    EXPECT_FALSE(scene.description.empty()) << file;
    for (const BodyDef& body : scene.bodies) {
      const auto shape_file = fileOf(body.shape);
      EXPECT_TRUE(shape_file.empty() || std::filesystem::exists(shape_file)) << shape_file;
    }
  }
}

using nlohmann::json;

/// A coarse ball on a hinge above a floor; centre of mass off the centre.
json hungBall() {
  json scene = ballScene();
  scene["bodies"][0]["shape"]["faces"] = 80;
  scene["bodies"][0]["centre_of_mass"] = {0.001, 0, -0.002};
  const json floor_shape = {{"type", "box"}, {"half_sizes", {2, 1, 0.5}}};
  scene["bodies"].push_back(
      {{"name", "floor"}, {"shape", floor_shape}, {"mass", 0}, {"position", {0, 0, -3}}});
  scene["joints"] = {{{"bodies", {"ball"}}, {"point", {0, 0, 1.5}}, {"axis", {0, 1, 0}}}};
  scene["medium"]["velocity"] = {0.1, 0, 0};
  return scene;
}

json geometryOf(const json& text) {
  const Scene scene = sceneFrom(text);
  return json::parse(makeGeometryText(scene, prepare(scene)));
}

/// Bounding box of a body's vertices.
struct Box {
  Vector3 low = Vector3::Constant(1e300), high = Vector3::Constant(-1e300);
};

Box boxOf(const json& body) {
  Box box;
  const auto numbers = body["vertices"].get<std::vector<double>>();
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    const Vector3 vertex(numbers[i], numbers[i + 1], numbers[i + 2]);
    box.low = box.low.cwiseMin(vertex);
    box.high = box.high.cwiseMax(vertex);
  }
  return box;
}

TEST(GeometryText, PlacesVerticesAboutTheCentreOfMass) {
  const json ball = geometryOf(hungBall())["bodies"][0];
  EXPECT_EQ(ball["name"], "ball");
  EXPECT_EQ(ball["triangles"].size(), 3u * 80);
  const Box box = boxOf(ball);
  const Vector3 centre = 0.5 * (box.low + box.high);
  // Float has seven digits for lengths of some centimetres.
  EXPECT_LT((centre - Vector3(-0.001, 0, 0.002)).norm(), 1e-8);
}

TEST(GeometryText, TellsSheets) {
  json scene = ballScene();
  scene["bodies"][0]["shape"] = {{"type", "sheet"}, {"semi_axes", {0.1, 0.1}}, {"faces", 60}};
  const json sheet = geometryOf(scene)["bodies"][0];
  EXPECT_EQ(sheet["sheet"], true);
  EXPECT_EQ(boxOf(sheet).low.z(), boxOf(sheet).high.z());
}

TEST(GeometryText, HasStaticBodiesJointsAndTheFlow) {
  const json geometry = geometryOf(hungBall());
  const json& floor = geometry["bodies"][1];
  EXPECT_EQ(floor["mass"], 0);
  EXPECT_EQ(floor["sheet"], false);
  const Box box = boxOf(floor);
  EXPECT_EQ(box.low, Vector3(-2, -1, -0.5));
  EXPECT_EQ(box.high, Vector3(2, 1, 0.5));
  ASSERT_EQ(geometry["joints"].size(), 1u);
  EXPECT_EQ(geometry["joints"][0]["bodies"], json({"ball"}));
  EXPECT_EQ(geometry["joints"][0]["point"], json({0, 0, 1.5}));
  EXPECT_EQ(geometry["joints"][0]["axis"], json({0, 1, 0}));
  EXPECT_FLOAT_EQ(geometry["medium_velocity"][0].get<float>(), 0.1f);
}

TEST(GeometryText, HasTheWaterWithItsWaves) {
  json scene = hungBall();
  EXPECT_TRUE(geometryOf(scene)["water"].is_null());
  scene["water"] = json::parse(R"({"level": 0.5,
    "waves": [{"amplitude": 0.1, "period": 2, "direction": [0, 3, 1], "phase": 0.25}],
    "bounds": {"lowest": [-1, -2, null], "highest": [1, 2, null]}})");
  const json water = geometryOf(scene)["water"];
  EXPECT_EQ(water["level"], 0.5);
  EXPECT_EQ(water["bounds"]["lowest"], json({-1, -2, nullptr}));
  const json& wave = water["waves"][0];
  EXPECT_EQ(wave["direction"], json({0, 1, 0}));
  EXPECT_EQ(wave["phase"], 0.25);
  EXPECT_NEAR(wave["frequency"].get<double>(), 3.14159265, 1e-6);
  EXPECT_NEAR(wave["wave_number"].get<double>(), 3.14159265 * 3.14159265 / 9.81, 1e-6);
}

/// Sample of a body on a curved path that turns about a turning axis: q = Rz(a t) Rx(b
/// t).
MotionSample motionAt(double t) {
  const double a = 3, b = 20;
  MotionSample sample;
  sample.time = t;
  sample.position = Vector3(std::sin(2 * t), std::cos(3 * t), t * t * t);
  sample.twist.linear = Vector3(2 * std::cos(2 * t), -3 * std::sin(3 * t), 3 * t * t);
  const Eigen::Quaterniond about_z(Eigen::AngleAxisd(a * t, Eigen::Vector3d::UnitZ()));
  sample.orientation = about_z * Eigen::AngleAxisd(b * t, Eigen::Vector3d::UnitX());
  sample.twist.angular = a * Vector3::UnitZ() + b * (about_z * Eigen::Vector3d::UnitX());
  return sample;
}

struct PoseError {
  double position = 0;
  double angle = 0;
};

PoseError largestError(double step) {
  PoseError largest;
  for (const double share : {0.2, 0.5, 0.7}) {
    const double t = 0.4 + share * step;
    const MotionSample exact = motionAt(t);
    const MotionSample between = interpolateMotion(motionAt(0.4), motionAt(0.4 + step), t);
    largest.position = std::max(largest.position, (between.position - exact.position).norm());
    largest.angle = std::max(largest.angle, between.orientation.angularDistance(exact.orientation));
  }
  return largest;
}

TEST(MotionInterpolation, PosesAreOfFourthOrderAtLeast) {
  const PoseError coarse = largestError(0.04);
  const PoseError fine = largestError(0.02);
  EXPECT_GE(std::log2(coarse.position / fine.position), 3.8);
  EXPECT_GE(std::log2(coarse.angle / fine.angle), 3.8);
}

TEST(MotionInterpolation, EndsAreTheSamplesThemselves) {
  const MotionSample from = motionAt(1), to = motionAt(1.01);
  EXPECT_EQ(interpolateMotion(from, to, 1).position, from.position);
  EXPECT_EQ(interpolateMotion(from, to, 1.01).orientation.coeffs(), to.orientation.coeffs());
}

TEST(MotionInterpolation, AnEvenSpinOfMoreThanHalfATurnPerStepGoesAllTheWay) {
  const double spin = 264;  // golf ball [rad/s]
  for (const double step : {0.005, 0.015, 0.03}) {
    MotionSample from, to;
    from.twist.angular = to.twist.angular = Vector3(0, spin, 0);
    to.time = step;
    to.orientation = Eigen::AngleAxisd(spin * step, Eigen::Vector3d::UnitY());
    const MotionSample between = interpolateMotion(from, to, 0.3 * step);
    const Quaternion expected(Eigen::AngleAxisd(0.3 * spin * step, Eigen::Vector3d::UnitY()));
    EXPECT_NEAR(between.orientation.angularDistance(expected), 0, 1e-7) << step;
  }
}

}  // namespace
}  // namespace ambient
