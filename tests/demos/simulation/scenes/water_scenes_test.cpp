// Bodies in water: the scenes underwater_bunny and ball_on_bottom; buoys and a catamaran. Bits of
// all scenes stand in tests/golden/scenes.txt.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

TEST(UnderwaterBunny, TurnsOverAndScrewsDown) {
  const TemporaryFolder folder;
  const Scene scene = readCoarseScene("underwater_bunny", folder);
  const std::vector<MotionSample> motion = run(scene).motion[0];
  const auto ears = [](const MotionSample& at) -> Vector3 {
    return at.orientation.toRotationMatrix().col(2);
  };
  EXPECT_EQ(ears(motion.front()).z(), 1);
  double lowest = 1;
  for (const MotionSample& sample : motion) lowest = std::min(lowest, ears(sample).z());
  EXPECT_LT(lowest, 0);
  // The final motion is a screw about the vertical: constant tilt and speeds.
  const MotionSample& end = motion.back();
  EXPECT_GT(end.twist.angular.normalized().dot(-Vector3::UnitZ()), 0.999);
  for (const MotionSample& sample : motion) {
    if (sample.time < 0.9 * scene.duration) continue;
    EXPECT_NEAR(ears(sample).z(), ears(end).z(), 0.05);
    EXPECT_NEAR(sample.twist.linear.z(), end.twist.linear.z(), 0.01 * end.twist.linear.norm());
    EXPECT_NEAR(sample.twist.angular.z(), end.twist.angular.z(), 0.05 * end.twist.angular.norm());
  }
}

/// A ball on the bottom of still water, in closed forms: C_D = 1/2.
struct SinkingBall {
  double terminal_speed, time_scale;

  static SinkingBall of(const Scene& scene, const BodyDef& ball) {
    const double radius = std::get<Sphere>(ball.shape.geometry).radius;
    const double density = scene.medium.density;
    const double displaced = density * 4 / 3 * kPi * std::pow(radius, 3);
    const double weight = (ball.mass - displaced) * 9.81;
    const double V = std::sqrt(2 * weight / (density * kPi * radius * radius * 0.5));
    return {V, (ball.mass + displaced / 2) * V / weight};
  }
  /// Speed after falling a height from rest: v^2 = V^2 (1 - exp(-2 h / (V tau))).
  double speedAfter(double height) const {
    return terminal_speed * std::sqrt(1 - std::exp(-2 * height / (terminal_speed * time_scale)));
  }
  /// Height after a start upwards: V tau / 2 ln(1 + v^2 / V^2).
  double heightFrom(double speed) const {
    const double ratio = speed / terminal_speed;
    return terminal_speed * time_scale / 2 * std::log1p(ratio * ratio);
  }
};

TEST(BallOnBottom, SinksBouncesAndRisesByItsClosedForms) {
  const Scene scene = readNamedScene("ball_on_bottom");
  const BodyDef& ball = scene.bodies[1];
  const double radius = std::get<Sphere>(ball.shape.geometry).radius;
  const auto motion = run(scene).motion[1];
  const SinkingBall closed_form = SinkingBall::of(scene, ball);

  std::size_t bounce = 1;
  while (motion[bounce].twist.linear.z() <= 0) ++bounce;
  double fastest = 0, highest = 0, lowest = 1;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    fastest = std::max(fastest, -motion[i].twist.linear.z());
    lowest = std::min(lowest, motion[i].position.z());
    if (i >= bounce) highest = std::max(highest, motion[i].position.z());
  }
  const double impact = closed_form.speedAfter(ball.position.z() - radius);
  EXPECT_NEAR(fastest, impact, 0.005 * impact);
  // Bullet's restitution depends on the penetration at the step that finds the contact: stock
  // Bullet gives 0.80 to 0.98 of 0.8.
  const double rebound = motion[bounce].twist.linear.z();
  EXPECT_GT(rebound, (ball.restitution - 0.02) * impact);
  EXPECT_LT(rebound, impact);
  const double rise = closed_form.heightFrom(rebound);
  EXPECT_NEAR(highest - motion[bounce].position.z(), rise, 0.02 * rise);
  EXPECT_GT(lowest, radius - 0.002);
  EXPECT_NEAR(motion.back().position.z(), radius, 1e-3);
  EXPECT_LT(motion.back().twist.linear.norm(), 0.01);
}

/// Writes a scene of bodies in 62 waves of 2.5 m and 8 s, across the mirrors of their meshes, and
/// expects of its first body that its z axis tilts by more than `least_tilt` and that it turns
/// about this axis by less than `most_turn` [rad]. `bodies`: members of the scene.
void expectRocksWithoutSpin(const TemporaryFolder& folder, const std::string& bodies,
                            double least_tilt, double most_turn) {
  writeText(folder / "buoy.json",
            R"({"duration": 500, "time_step": 0.016666666666666666, "output_step": 0.1,
    "water": {"level": 0, "waves": [{"amplitude": 1.25, "period": 8, "direction": [0.8, 0.6, 0]}]},)" +
                bodies + "}");
  double turn = 0, tilt = 0, before = 0;
  const RunRecord record = run(readScene(folder / "buoy.json"));
  for (const MotionSample& sample : record.motion[0]) {
    const Vector3 axis = sample.orientation * Vector3::UnitZ();
    turn += axis.dot(sample.twist.angular) * (sample.time - before);
    before = sample.time;
    tilt = std::max(tilt, std::acos(std::min(1.0, axis.z())));
  }
  EXPECT_GT(tilt, least_tilt);
  EXPECT_LT(std::abs(turn), most_turn);
}

// Pressure does not spin a body of revolution about its axis, whatever waves it meets: a float on a
// spar with a plate below. Measured 0.005; by sums over parts 0.16.
TEST(Buoy, DoesNotSpinInWaves) {
  expectRocksWithoutSpin(TemporaryFolder(), R"(
    "bodies": [{"mass": 2.5e5, "position": [0, 0, -2], "centre_of_mass": [0, 0, -2], "skin_friction": false,
      "shape": {"type": "compound", "parts": [
        {"shape": {"type": "cylinder", "radius": 5, "height": 4}},
        {"shape": {"type": "cylinder", "radius": 2, "height": 6}, "position": [0, 0, -4]},
        {"shape": {"type": "cylinder", "radius": 4, "height": 1}, "position": [0, 0, -7]}]}}])",
                         0.2, 0.01);
}

/// Corner of a profile that turns about z.
struct ProfileCorner {
  double radius, height;  // [m]
};

/// Text of an OBJ file: a profile turned into a mesh of many sides. It begins and ends on the axis.
std::string turnedMesh(const std::vector<ProfileCorner>& profile, int sides) {
  std::ostringstream text;
  text.precision(17);
  for (const ProfileCorner& corner : profile)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * kPi * i / sides;
      text << "v " << corner.radius * std::cos(angle) << " " << corner.radius * std::sin(angle)
           << " " << corner.height << "\n";
    }
  const int rings = static_cast<int>(profile.size());
  for (int ring = 0; ring + 1 < rings; ++ring)
    for (int i = 0; i < sides; ++i) {
      const int a = 1 + ring * sides + i, b = 1 + ring * sides + (i + 1) % sides;
      if (ring > 0) text << "f " << a << " " << b << " " << b + sides << "\n";
      if (ring + 2 < rings) text << "f " << a << " " << b + sides << " " << a + sides << "\n";
    }
  return text.str();
}

// A mesh of 24 sides of that float, spar and plate, which is round to its added mass and to
// pressure.
TEST(Buoy, DoesNotSpinInWavesAsAMesh) {
  const TemporaryFolder folder;
  writeText(
      folder / "buoy.obj",
      turnedMesh({{0, -7.5}, {4, -7.5}, {4, -6.5}, {2, -6.5}, {2, -2}, {5, -2}, {5, 2}, {0, 2}},
                 24));
  expectRocksWithoutSpin(folder, R"(
    "bodies": [{"mass": 2.5e5, "position": [0, 0, -2], "centre_of_mass": [0, 0, -2], "skin_friction": false,
      "shape": {"type": "mesh", "file": "buoy.obj"}}])",
                         0.2, 0.02);
}

// Waves do not spin a float about its axis that a ball joint holds to a spar.
TEST(Buoy, DoesNotSpinOnAJoint) {
  expectRocksWithoutSpin(TemporaryFolder(), R"(
    "bodies": [
      {"name": "float", "mass": 725834, "shape": {"type": "cylinder", "radius": 10, "height": 5}},
      {"name": "spar", "mass": 878300, "position": [0, 0, -21], "shape": {"type": "cylinder", "radius": 3, "height": 30}}],
    "joints": [{"bodies": ["float", "spar"], "point": [0, 0, -4]}])",
                         0.05, 0.02);
}

// Waves do not spin the float of a robot about its axis, on a rail along a spar that hangs below.
TEST(Buoy, DoesNotSpinOnTheRailOfARobot) {
  const TemporaryFolder folder;
  writeText(folder / "buoy.urdf", R"(<robot name="buoy">
    <link name="float"><inertial><mass value="725834"/>
      <inertia ixx="2e7" ixy="0" ixz="0" iyy="2e7" iyz="0" izz="3.6e7"/></inertial>
      <collision><geometry><cylinder radius="10" length="5"/></geometry></collision></link>
    <link name="spar"><inertial><origin xyz="0 0 -33"/><mass value="1078300"/>
      <inertia ixx="9.4e7" ixy="0" ixz="0" iyy="9.4e7" iyz="0" izz="2.8e7"/></inertial>
      <collision><origin xyz="0 0 -22"/><geometry><cylinder radius="3" length="30"/></geometry></collision></link>
    <joint name="rail" type="prismatic"><parent link="float"/><child link="spar"/><axis xyz="0 0 1"/>
      <limit lower="-8" upper="8" effort="1e9" velocity="100"/></joint></robot>)");
  expectRocksWithoutSpin(folder, R"("robots": [{"urdf": "buoy.urdf"}])", 0.05, 0.02);
}

// Two pontoons under a deck float up to their axes with the mass of half of the water that they
// could displace; a ball of lead falls through the gap between them.
TEST(Catamaran, FloatsOnItsPontoonsAndLetsABallThrough) {
  const TemporaryFolder folder;
  writeText(folder / "catamaran.json", R"({
    "duration": 20, "time_step": 0.016666666666666666, "water": {"level": 0, "density": 1000},
    "bodies": [
      {"mass": 1130.97, "position": [0, 0, 0.1], "centre_of_mass": [0, 0, 0], "shape": {"type": "compound", "parts": [
        {"shape": {"type": "cylinder", "radius": 0.3, "height": 4}, "position": [-1, 0, 0], "orientation": [1, 1, 0, 0]},
        {"shape": {"type": "cylinder", "radius": 0.3, "height": 4}, "position": [1, 0, 0], "orientation": [1, 1, 0, 0]},
        {"shape": {"type": "box", "size": [2.6, 1, 0.2]}, "position": [0, 0, 0.35]}]}},
      {"mass": 380, "position": [0, 1.3, 1], "shape": {"type": "sphere", "radius": 0.2}}]})");
  const RunRecord record = run(readScene(folder / "catamaran.json"));
  const MotionSample& end = record.motion[0].back();
  EXPECT_NEAR(end.position.z(), 0, 0.01);
  EXPECT_GT((end.orientation * Vector3::UnitZ()).z(), 0.999);
  EXPECT_LT(record.motion[1].back().position.z(), -5);
}

}  // namespace
}  // namespace ambient
