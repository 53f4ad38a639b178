#include "demos/simulation/scene_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "demos/scene/scene_reader.h"
#include "demos/simulation/output/motion_recorder.h"
#include "demos/simulation/output/run_files.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/demos/scene/scene_text.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using nlohmann::json;

/// A small ball in a vacuum.
json vacuumBall() {
  json scene = ballScene();
  scene["model"] = "vacuum";
  scene["bodies"][0]["shape"]["faces"] = 80;
  return scene;
}

double largestDistance(const std::vector<MotionSample>& a, const std::vector<MotionSample>& b) {
  double largest = a.size() == b.size() ? 0 : 1e300;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, (a[i].position - b[i].position).norm());
  return largest;
}

TEST(SceneRun, WritesOneRowPerBodyAndOutputTime) {
  json text = vacuumBall();
  text["bodies"].push_back(text["bodies"][0]);
  text["bodies"][1]["name"] = "second";
  text["bodies"][1]["position"] = {0, 5, 1};
  text["duration"] = 0.12;
  const Scene scene = sceneFrom(text);
  std::istringstream stream(makeTrajectoryText(scene, run(scene).motion));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  // Rows at 0, 0.05, 0.1 and 0.12 s, the end.
  ASSERT_EQ(lines.size(), 1u + 2 * 4);
  EXPECT_EQ(lines[0], kTrajectoryHeader);
  EXPECT_EQ(lines[1], "0,ball,0,0,1,1,0,0,0,0,0,60,30,0,0");
  EXPECT_EQ(lines[2], "0,second,0,5,1,1,0,0,0,0,0,60,30,0,0");
  EXPECT_EQ(lines[3].rfind("0.050000000000000003,ball,", 0), 0u);
  EXPECT_EQ(lines[7].rfind("0.12,ball,", 0), 0u);
}

TEST(SceneRun, OutputTimesIncludeBothEnds) {
  Scene scene;
  scene.duration = 8;
  scene.output_step = 0.01;
  scene.time_step = 1.0 / 240;
  EXPECT_EQ(outputTimes(scene).size(), 801u);
  EXPECT_EQ(outputTimes(scene).back(), 8);
  EXPECT_EQ(countSteps(scene.duration, scene.time_step), 1920);
  scene.duration = 0.035;
  EXPECT_EQ(outputTimes(scene), (std::vector<double>{0, 0.01, 0.02, 0.03, 0.035}));
  EXPECT_EQ(countSteps(scene.duration, scene.time_step), 9);
}

TEST(SceneRun, RowsBetweenStepsLieOnTheMotion) {
  // Bullet moves a body by v dt with the new v: y = y0 + v0 t - g t (t + dt) / 2.
  json text = vacuumBall();
  text["output_step"] = 0.013;
  const std::vector<MotionSample> motion = run(sceneFrom(text)).motion[0];
  for (const MotionSample& sample : motion) {
    const double t = sample.time;
    EXPECT_NEAR(sample.position.x(), 30 * t, 1e-12);
    // Hermite interpolation between two steps smooths the kink of the stepped motion.
    EXPECT_NEAR(sample.position.z(), 1 - 9.81 / 2 * t * (t + 0.01), 9.81 * 1e-4 / 2);
  }
}

TEST(SceneRun, TheOutputStepDoesNotChangeTheMotion) {
  const Scene coarse = readNamedScene("plate_8cm", {{"duration", "1"}, {"output_step", "0.05"}});
  Scene fine = coarse;
  fine.output_step = 0.025;
  const auto bodies = prepare(coarse);
  const auto few = runPrepared(coarse, bodies).motion[0];
  const auto many = runPrepared(fine, bodies).motion[0];
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].position, many[2 * i].position);
}

TEST(SceneRun, LogsTheAxesOfTheShapeWhateverThePrincipalAxes) {
  // Describes one body twice: inertia in its own axes, and in axes turned by R.
  const Quaternion turn(Eigen::Quaterniond(0.4, -0.2, 0.7, 0.5).normalized());
  const Matrix3 R = turn.toRotationMatrix();
  const Matrix3 moments = Vector3(0.002, 0.003, 0.004).asDiagonal();
  const Matrix3 turned = R * moments * R.transpose();
  Scene plain = sceneFrom(vacuumBall());
  plain.bodies[0].angular_velocity = Vector3(3, 2, 1);
  plain.bodies[0].orientation = Quaternion(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized());
  Scene other = plain;
  plain.bodies[0].inertia = moments;
  other.bodies[0].inertia = turned;
  other.bodies[0].orientation = plain.bodies[0].orientation * turn.conjugate();

  const auto a = run(plain).motion[0];
  const auto b = run(other).motion[0];
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(b[0].orientation.coeffs(), other.bodies[0].orientation.coeffs());
  EXPECT_GT(a.back().orientation.angularDistance(a[0].orientation), 0.1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].orientation.angularDistance(b[i].orientation * turn), 0, 1e-7);
    EXPECT_LE((a[i].twist.angular - b[i].twist.angular).norm(), 1e-11);
  }
}

TEST(SceneRun, AFluidBodyFileMovesAsTheMeshItWasMadeFrom) {
  const TemporaryFolder folder;
  const Scene mesh = readNamedScene("plate_9cm", {{"duration", "1"}});
  ShapeBuildSettings settings;
  settings.name = "plate";
  writeFluidBody(buildShape(mesh.bodies[0].shape, settings).body, folder / "plate.ambient");
  const json shape = {{"type", "fluid_body"}, {"file", (folder / "plate.ambient").string()}};
  const Scene file =
      readNamedScene("plate_9cm", {{"duration", "1"}, {"bodies.0.shape", shape.dump()}});
  // The file's origin is the centre of volume, 0 to rounding.
  EXPECT_LE(largestDistance(run(mesh).motion[0], run(file).motion[0]), 1e-9);
}

/// A neutrally buoyant body in water at rest.
json waterBody(const json& shape, double mass) {
  json scene = ballScene();
  scene["medium"] = {{"density", 1000}};
  scene["bodies"][0] = {{"name", "float"}, {"shape", shape}, {"mass", mass}};
  return scene;
}

TEST(SceneRun, AMassOffCentreTurnsABallDown) {
  // Buoyancy m g at r from the centre of mass; sphere: added mass m/2 at its centre, so
  // (I + mu (r.r - r r^T)) w = t r x m g up, mu = (m/2) m / (m + m/2).
  const double radius = 0.1, mass = 1000 * 4 * std::acos(-1.0) / 3 * std::pow(radius, 3);
  Scene scene = sceneFrom(waterBody({{"type", "sphere"}, {"radius", radius}}, mass));
  scene.time_step = scene.output_step = 1e-4;
  scene.duration = 1e-3;
  const Vector3 centre(0.03, -0.02, 0.01);
  const Quaternion turn(Eigen::Quaterniond(0.4, -0.2, 0.7, 0.5).normalized());
  const Matrix3 moments = (mass * radius * radius * Vector3(0.3, 0.4, 0.5)).asDiagonal();
  const Matrix3 R = turn.toRotationMatrix();
  scene.bodies[0].centre_of_mass = centre;
  scene.bodies[0].inertia = Matrix3(R * moments * R.transpose());
  scene.bodies[0].orientation = Quaternion(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized());

  const Matrix3 R_WS = scene.bodies[0].orientation.toRotationMatrix();
  const Vector3 r = R_WS * -centre;
  const Matrix3 point = r.dot(r) * Matrix3::Identity() - r * r.transpose();
  const Matrix3 inertia = R_WS * *scene.bodies[0].inertia * R_WS.transpose() + mass / 3 * point;
  const Vector3 torque = r.cross(Vector3(0, 0, mass * 9.81));
  const Vector3 expected = scene.duration * Eigen::Matrix3d(inertia).inverse() * torque;
  const Vector3 spin = run(scene).motion[0].back().twist.angular;
  // Added mass of the mesh has an error of 0.1 %; a tenth of it acts here.
  EXPECT_LE((spin - expected).norm(), 1e-3 * expected.norm());
}

/// A body at rest at a position.
json restingBody(const char* name, const json& shape, const json& position) {
  return {{"name", name}, {"mass", 1}, {"shape", shape}, {"position", position}};
}

TEST(SceneRun, BodiesComeToRestOnAStaticOne) {
  json text = ballScene();
  text["duration"] = 3;
  json floor = restingBody("floor", {{"type", "box"}, {"size", {4, 4, 1}}}, {0, 0, -0.5});
  floor["mass"] = 0;
  json brick = restingBody("brick", {{"type", "box"}, {"size", {0.4, 0.2, 0.1}}, {"faces", 108}},
                           {1, 0, 0.08});
  brick["centre_of_mass"] = {0, 0, -0.02};
  const json ball = {{"type", "sphere"}, {"radius", 0.11}, {"faces", 80}};
  const json drum = {{"type", "cylinder"}, {"radius", 0.1}, {"height", 0.16}, {"faces", 200}};
  const json cone = {{"type", "cone"}, {"radius", 0.1}, {"height", 0.12}, {"faces", 200}};
  const json plate = {{"type", "ellipsoid"}, {"semi_axes", {0.1, 0.1, 0.02}}, {"faces", 320}};
  text["bodies"] = {floor,
                    brick,
                    restingBody("ball", ball, {-1, 0, 0.2}),
                    restingBody("drum", drum, {0, 1, 0.1}),
                    restingBody("cone", cone, {0, -1, 0.1}),
                    restingBody("plate", plate, {0, 0, 0.05})};
  const RunRecord record = run(sceneFrom(text));
  const auto height = [&](int body) { return record.motion[body].back().position.z(); };
  EXPECT_EQ(height(0), -0.5);
  // Measured overlaps of 1e-12 m to 6e-8 m: Bullet's position correction has converged.
  EXPECT_NEAR(height(1), 0.1 / 2 - 0.02, 1e-5);
  EXPECT_NEAR(height(2), 0.11, 1e-5);
  EXPECT_NEAR(height(3), 0.16 / 2, 1e-5);
  // Cone and hull have a margin of 1 % of their size; the cone's centre is at a quarter height.
  EXPECT_NEAR(height(4), 0.12 / 4, 1e-3);
  EXPECT_NEAR(height(5), 0.02, 1e-3);
  // Distance moved in the last half second. Velocities of single steps jump: Bullet loses and finds
  // a contact of the cone at times that depend on rounding.
  for (std::size_t i = 1; i < record.motion.size(); ++i) {
    const std::vector<MotionSample>& motion = record.motion[i];
    std::size_t before = motion.size() - 1;
    while (motion[before].time > motion.back().time - 0.5) --before;
    EXPECT_LE((motion.back().position - motion[before].position).norm(), 2e-3) << i;
  }
}

TEST(SceneRun, OrientationsDoNotJumpToTheOppositeSign) {
  const RunRecord record = run(readNamedScene("plate_8cm"));
  const std::vector<MotionSample>& motion = record.motion[0];
  for (std::size_t i = 1; i < motion.size(); ++i)
    EXPECT_GT(motion[i].orientation.dot(motion[i - 1].orientation), 0.9);
}

TEST(SceneRun, ABodysOwnFluidDensityCounts) {
  json text = vacuumBall();
  const auto fall = run(sceneFrom(text)).motion[0];
  text["model"] = "ambient";
  text["bodies"][0]["fluid_density"] = 0;
  EXPECT_EQ(largestDistance(fall, run(sceneFrom(text)).motion[0]), 0);
  text["bodies"][0].erase("fluid_density");
  EXPECT_GT(largestDistance(fall, run(sceneFrom(text)).motion[0]), 0.1);
}

// A ball that floats on water is as meant, one that would float in air is not.
TEST(SceneRun, InWaterAloneABodyLighterThanAirIsToldOf) {
  json text = ballScene();
  text.erase("medium");
  text["water"] = {{"level", 0}};
  text["duration"] = 0.05;
  json& ball = text["bodies"][0];
  ball["shape"]["radius"] = 3;
  for (const char* motion : {"linear_velocity", "angular_velocity"}) ball.erase(motion);
  const double volume = 36 * 3.14159265358979;
  const auto saidOf = [&](double mass) {
    ball["mass"] = mass;
    return run(sceneFrom(text)).warning;
  };
  EXPECT_EQ(saidOf(0.1 * water().density * volume), "");
  const std::string said = saidOf(8.3);
  EXPECT_NE(said.find("'ball' has a mass of 8.3 kg and displaces 136 kg"), std::string::npos)
      << said;
}

TEST(SceneRun, MassesThatCannotBeNameFileAndBody) {
  json text = ballScene();
  text["bodies"][0]["mass"] = 1e-300;
  const std::string what = test::refusalOf<std::exception>([&] { run(sceneFrom(text)); });
  EXPECT_NE(what.find(".json: body \"ball\": "), std::string::npos) << what;
  EXPECT_NE(what.find("must be at most 2^52 times its own"), std::string::npos) << what;
}

TEST(Summary, HasTheKeysThatProgramsReadAndTheFall) {
  const Scene scene = readNamedScene("plate_10cm", {{"duration", "2"}});
  const auto bodies = prepare(scene);
  const json summary = json::parse(makeSummary(scene, bodies, runPrepared(scene, bodies)));
  EXPECT_EQ(summary["scene"], "plate_10cm");
  EXPECT_EQ(summary["model"], "ambient");
  EXPECT_EQ(summary["steps"], 480);
  EXPECT_EQ(summary["time_step"], 1.0 / 240);
  EXPECT_GT(summary["wall_seconds_simulation"], 0);
  ASSERT_EQ(summary["bodies"].size(), 1u);
  const json& plate = summary["bodies"][0];
  EXPECT_EQ(plate["name"], "plate");
  EXPECT_EQ(plate["fall"]["mode"], "flutter");
  EXPECT_EQ(plate["fluid_body"]["faces"], 980);
  EXPECT_GT(plate["work"]["load_evaluations"], 0);
  EXPECT_EQ(plate["work"]["too_long"], 0);
  EXPECT_EQ(plate["work"]["halted"], 0);
  EXPECT_GT(plate["work"]["energy_removed"], 0);
}

TEST(Summary, ABallIsNotAPlate) {
  const Scene scene = sceneFrom(vacuumBall());
  const auto bodies = prepare(scene);
  const json summary = json::parse(makeSummary(scene, bodies, runPrepared(scene, bodies)));
  EXPECT_TRUE(summary["bodies"][0]["fall"].is_null());
  EXPECT_FALSE(summary["bodies"][0]["path"]["landing"].is_null());
}

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
