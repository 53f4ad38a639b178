// Bodies in water and a balloon: the scenes underwater_ellipsoid, underwater_bunny, balloon,
// ball_on_bottom, box_pile.
// Scene with regions of fluid: wind_zone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

TEST(UnderwaterEllipsoid, GlidesRocksAndSettlesBroadside) {
  const auto motion = run(readNamedScene("underwater_ellipsoid")).motion[0];
  int turns_back = 0;
  double farthest = 0;
  for (std::size_t i = 1; i < motion.size(); ++i) {
    // Released in a plane of symmetry, the body stays in the plane.
    EXPECT_LE(std::abs(motion[i].position.y()), 1e-4);
    farthest = std::max(farthest, std::abs(motion[i].position.x()));
    const double before = motion[i - 1].twist.angular.y(), now = motion[i].twist.angular.y();
    if (before * now < 0) ++turns_back;
  }
  EXPECT_GT(farthest, 0.03);
  EXPECT_GE(turns_back, 8);
  EXPECT_LT(std::abs((motion.back().orientation * Vector3::UnitX()).z()), 0.02);
}

class UnderwaterBunny : public ::testing::Test {
 protected:
  UnderwaterBunny()
      : scene_(readCoarseScene("underwater_bunny", folder_)),
        bodies_(prepare(scene_)),
        motion_(runPrepared(scene_, bodies_).motion[0]) {}

  static Vector3 earsOf(const MotionSample& sample) {
    return sample.orientation * Vector3::UnitZ();
  }

  TemporaryFolder folder_;
  Scene scene_;
  std::vector<PreparedBody> bodies_;
  std::vector<MotionSample> motion_;
};

TEST_F(UnderwaterBunny, TurnsOverAndScrewsDown) {
  EXPECT_EQ(earsOf(motion_.front()).z(), 1);
  double lowest = 1;
  for (const MotionSample& sample : motion_) lowest = std::min(lowest, earsOf(sample).z());
  EXPECT_LT(lowest, 0);
  // The final motion is a screw about the vertical: constant tilt and speeds.
  const MotionSample& end = motion_.back();
  EXPECT_GT(end.twist.angular.normalized().dot(-Vector3::UnitZ()), 0.999);
  for (const MotionSample& sample : motion_) {
    if (sample.time < 0.9 * scene_.duration) continue;
    EXPECT_NEAR(earsOf(sample).z(), earsOf(end).z(), 0.05);
    EXPECT_NEAR(sample.twist.linear.z(), end.twist.linear.z(), 0.01 * end.twist.linear.norm());
    EXPECT_NEAR(sample.twist.angular.z(), end.twist.angular.z(), 0.05 * end.twist.angular.norm());
  }
}

TEST_F(UnderwaterBunny, EndsAlikeReleasedOnItsHead) {
  // Released on its back, nose up, the bunny finds another screw: 2.5 rad/s and 0.27 m/s.
  Scene on_head = scene_;
  on_head.bodies[0].orientation = Quaternion(0, 1, 0, 0);
  const MotionSample other = runPrepared(on_head, bodies_).motion[0].back();
  const MotionSample& end = motion_.back();
  EXPECT_NEAR(other.twist.linear.z(), end.twist.linear.z(), 0.02 * end.twist.linear.norm());
  EXPECT_NEAR(other.twist.angular.z(), end.twist.angular.z(), 0.05 * end.twist.angular.norm());
}

TEST(Balloon, RisesUnsteadily) {
  const Scene scene = readNamedScene("balloon");
  const auto bodies = prepare(scene);
  const auto motion = runPrepared(scene, bodies).motion[0];
  const double buoyancy = scene.medium.density * bodies[0].fluid_body->volume;
  ASSERT_GT(buoyancy, bodies[0].mass);
  EXPECT_GT(motion.back().position.z(), 5);
  double largest_tilt = 0;
  for (const MotionSample& sample : motion)
    if (sample.time > scene.duration / 2)
      largest_tilt = std::max(largest_tilt, std::acos((sample.orientation * Vector3::UnitZ()).z()));
  EXPECT_GT(largest_tilt, kPi / 6);
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

TEST(BoxPile, StaysInWaterAsItWasBuilt) {
  const Scene scene = readNamedScene("box_pile");
  const RunRecord record = run(scene);
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const MotionSample& end = record.motion[i].back();
    EXPECT_LT((end.position - scene.bodies[i].position).norm(), 2e-3) << scene.bodies[i].name;
    EXPECT_LT(end.twist.linear.norm(), 1e-3) << scene.bodies[i].name;
    EXPECT_LT(end.orientation.angularDistance(scene.bodies[i].orientation), 0.01)
        << scene.bodies[i].name;
  }
}

TEST(WindZone, BlowsWhereItIsAndMoreTheLighterTheBall) {
  const Scene scene = readNamedScene("wind_zone");
  const RunRecord run = runSharing(scene);
  constexpr double kRadius = 0.02;
  double before = 1e9;
  for (std::size_t ball = 1; ball < scene.bodies.size(); ++ball) {
    double entry = 0, exit = 0;  // times
    const auto& motion = run.motion[ball];
    for (std::size_t i = 1; i < motion.size(); ++i) {
      const double height = motion[i - 1].position.z();
      if (entry == 0 && height < 4) entry = motion[i - 1].time;
      if (exit == 0 && height < 2 - kRadius) exit = motion[i - 1].time;  // all of it
      const double gain = motion[i].twist.linear.x() - motion[i - 1].twist.linear.x();
      if (height > 4.1) {
        EXPECT_EQ(gain, 0) << i;
      }
      if (height < 3.9 && height > 2.1) {
        EXPECT_GT(gain, 0) << i;
      }
      if (exit > 0) {
        // Air at rest slows the ball.
        EXPECT_LT(gain, 0) << i;
        break;
      }
      // Falling 1 m takes sqrt(2 / g): air has little effect.
      if (entry > 0) {
        EXPECT_NEAR(entry, std::sqrt(2 / 9.81), 0.02);
      }
    }
    ASSERT_GT(exit, entry);
    const double drift = motion.back().position.x();
    EXPECT_GT(drift, 0);
    EXPECT_LT(drift, before);
    before = drift;
  }
}

// Bodies at the surface of water: the scenes floating_cube, heave_decay, wedge_drop, boat_in_waves,
// duck_dive, barge_floods, diving_bell and pool.

double meanHeight(const std::vector<MotionSample>& motion, double from) {
  double sum = 0, count = 0;
  for (const MotionSample& sample : motion)
    if (sample.time >= from) {
      sum += sample.position.z();
      ++count;
    }
  return sum / count;
}

/// Cosine of the angle between the vertical and the nearest axis of the body.
double uprightness(const MotionSample& sample) {
  return (sample.orientation.conjugate() * Vector3::UnitZ()).cwiseAbs().maxCoeff();
}

// Flat below 0.2113 and above 0.7887 times the density of water, corner up at 0.5. The heaviest
// cube has a small righting moment and rocks for half a minute.
TEST(FloatingCube, SettlesAsItsDensityTells) {
  Scene scene = readNamedScene("floating_cube");
  scene.duration = 40;
  const RunRecord run = runSharing(scene);
  const auto last = [&](std::size_t i) { return uprightness(run.motion[i].back()); };
  EXPECT_GT(last(0), 0.995);
  EXPECT_GT(last(4), 0.995);
  EXPECT_LT(last(2), std::cos(0.7));  // 0.577 corner up, 0.707 edge up
  EXPECT_LT(last(3), 0.98);
  for (std::size_t i : {0U, 4U}) {
    const double gravity = scene.bodies[i].mass / (998 * 0.027);
    EXPECT_NEAR(meanHeight(run.motion[i], 30), 0.3 * (0.5 - gravity), 0.01) << i;
  }
}

// Kramer et al. 2021: period 0.76 s. Linear theory: extremes of -0.866, 0.633, -0.463 of the start.
TEST(HeaveDecay, HasThePeriodAndTheDecayOfLinearTheory) {
  const auto motion = motionOf("heave_decay");
  std::vector<double> extremes, times;
  constexpr double kBalance = -0.0348, kStart = 0.03;
  for (std::size_t i = 1; i + 1 < motion.size() && extremes.size() < 4; ++i) {
    const double before = motion[i - 1].position.z(), now = motion[i].position.z(),
                 after = motion[i + 1].position.z();
    if ((now - before) * (after - now) <= 0 && motion[i].time > 0.1) {
      extremes.push_back((now - kBalance) / kStart);
      times.push_back(motion[i].time);
    }
  }
  ASSERT_GE(extremes.size(), 3U);
  EXPECT_NEAR(extremes[0], -0.866, 0.04);
  EXPECT_NEAR(extremes[1], 0.633, 0.04);
  EXPECT_NEAR(extremes[2], -0.463, 0.04);
  EXPECT_NEAR(times[2] - times[0], 0.763, 0.02 * 0.763);
}

TEST(WedgeDrop, TheWaterStopsIt) {
  const RunRecord run = runSharing(readNamedScene("wedge_drop"));
  for (const auto& motion : run.motion) {
    double fastest = 0, lowest = 0;
    for (const MotionSample& sample : motion) {
      fastest = std::min(fastest, sample.twist.linear.z());
      lowest = std::min(lowest, sample.position.z());
    }
    EXPECT_LT(fastest, -3.9);  // entry at 4 m/s
    EXPECT_GT(lowest, -1);
    EXPECT_LT(std::abs(motion.back().twist.linear.z()), 1);
  }
}

TEST(BoatInWaves, FloatsUprightAndGoesWithTheWaves) {
  const Scene scene = readNamedScene("boat_in_waves");
  const RunRecord run = runSharing(scene);
  for (const auto& motion : run.motion) {
    double highest = -9, lowest = 9;
    for (const MotionSample& sample : motion) {
      if (sample.time < 5) continue;
      highest = std::max(highest, sample.position.z());
      lowest = std::min(lowest, sample.position.z());
      EXPECT_GT((sample.orientation * Vector3::UnitZ()).z(), 0.7);
    }
    // Wave amplitudes of 0.12 and 0.04 m.
    EXPECT_NEAR(highest - lowest, 0.32, 0.12);
    EXPECT_NEAR((highest + lowest) / 2, 0, 0.15);
  }
}

// Jump height exceeds the depth, but not the energy of buoyancy. The heavy ball hardly leaves the
// water.
TEST(DuckDive, LightBallsJump) {
  const RunRecord run = runSharing(readNamedScene("duck_dive", {{"duration", "9"}}));
  const auto highest = [&](std::size_t i) {
    double height = -9;
    for (const MotionSample& sample : run.motion[i]) height = std::max(height, sample.position.z());
    return height;
  };
  EXPECT_GT(highest(0), 0.3);
  EXPECT_GT(highest(0), highest(1));
  EXPECT_LT(highest(2), 0.1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(run.motion[i].back().twist.linear.norm(), 0.5) << i;
}

// Torricelli's law, as in vessel_test: the rim dips after 116.447 s.
TEST(BargeFloods, DipsItsRimInItsTimeAndSinks) {
  const auto motion = run(readNamedScene("barge_floods")).motion[0];
  double dips = 0;
  for (const MotionSample& sample : motion)  // the rim is 0.37 m above the centre of mass
    if (dips == 0 && sample.position.z() < -0.37) dips = sample.time;
  // The air of the scene has some weight; it is told every 0.1 s.
  EXPECT_NEAR(dips, 116.447, 0.004 * 116.447);
  EXPECT_LT(motion.back().position.z(), -1);
}

// Its air is pressed together by Boyle's law; it stands on the ground 5 m deep.
TEST(DivingBell, SinksToTheGround) {
  const auto motion = run(readNamedScene("diving_bell")).motion[1];
  const MotionSample& end = motion.back();
  EXPECT_NEAR(end.position.z(), -5 + 0.05, 0.02) << "its rim is 0.05 m below its centre of mass";
  EXPECT_LT(end.twist.linear.norm(), 1e-3);
  EXPECT_GT((end.orientation * Vector3::UnitZ()).z(), 0.999);
}

TEST(Pool, KeepsItsBoxesAndSinksTheHeavyOnes) {
  const Scene scene = readNamedScene("pool", {{"duration", "6"}});
  const RunRecord run = runSharing(scene);
  for (std::size_t i = 5; i < scene.bodies.size(); ++i) {
    const Vector3 end = run.motion[i].back().position;
    EXPECT_LT(std::max(std::abs(end.x()), std::abs(end.y())), 2.2) << scene.bodies[i].name;
    const bool sinks = scene.bodies[i].mass > 998 * 0.0144;
    if (sinks) {
      EXPECT_LT(end.z(), -0.3) << scene.bodies[i].name;
    } else {
      EXPECT_GT(end.z(), -0.5) << scene.bodies[i].name;
      EXPECT_LT(end.z(), 0.5) << scene.bodies[i].name;
    }
  }
}

// Returns how far a body turns about its z axis, and how far that tilts at most [rad].
struct Turned {
  double about_axis = 0, most_tilt = 0;
};
Turned turnedOf(const std::vector<MotionSample>& motion) {
  Turned turned;
  double before = 0;
  for (const MotionSample& sample : motion) {
    const Vector3 axis = sample.orientation * Vector3::UnitZ();
    turned.about_axis += axis.dot(sample.twist.angular) * (sample.time - before);
    before = sample.time;
    turned.most_tilt = std::max(turned.most_tilt, std::acos(std::min(1.0, axis.z())));
  }
  return turned;
}

const char* const kSwell = R"("time_step": 0.016666666666666666, "output_step": 0.1,
    "water": {"level": 0, "waves": [{"amplitude": 1.25, "period": 8, "direction": [0.8, 0.6, 0]}]},)";

// Pressure does not spin a body of revolution about its axis, whatever waves it meets: a float on a
// spar with a plate below, 62 waves of 2.5 m and 8 s across the mirrors of its mesh.
TEST(Buoy, DoesNotSpinInWaves) {
  const TemporaryFolder folder;
  writeText(folder / "buoy.json", R"({"duration": 500, )" + std::string(kSwell) + R"(
    "bodies": [{"mass": 2.5e5, "position": [0, 0, -2], "centre_of_mass": [0, 0, -2], "skin_friction": false,
      "shape": {"type": "compound", "parts": [
        {"shape": {"type": "cylinder", "radius": 5, "height": 4}},
        {"shape": {"type": "cylinder", "radius": 2, "height": 6}, "position": [0, 0, -4]},
        {"shape": {"type": "cylinder", "radius": 4, "height": 1}, "position": [0, 0, -7]}]}}]})");
  const Turned turned = turnedOf(run(readScene(folder / "buoy.json")).motion[0]);
  EXPECT_GT(turned.most_tilt, 0.2);              // it does rock
  EXPECT_LT(std::abs(turned.about_axis), 0.01);  // measured 0.005; by sums over parts 0.16
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
  writeText(folder / "buoy.json", R"({"duration": 500, )" + std::string(kSwell) + R"(
    "bodies": [{"mass": 2.5e5, "position": [0, 0, -2], "centre_of_mass": [0, 0, -2], "skin_friction": false,
      "shape": {"type": "mesh", "file": "buoy.obj"}}]})");
  const Turned turned = turnedOf(run(readScene(folder / "buoy.json")).motion[0]);
  EXPECT_GT(turned.most_tilt, 0.2);
  EXPECT_LT(std::abs(turned.about_axis), 0.02);
}

// Waves do not spin a float about its axis that a ball joint holds to a spar.
TEST(Buoy, DoesNotSpinOnAJoint) {
  const TemporaryFolder folder;
  writeText(folder / "buoy.json", R"({"duration": 500, )" + std::string(kSwell) + R"(
    "bodies": [
      {"name": "float", "mass": 725834, "shape": {"type": "cylinder", "radius": 10, "height": 5}},
      {"name": "spar", "mass": 878300, "position": [0, 0, -21], "shape": {"type": "cylinder", "radius": 3, "height": 30}}],
    "joints": [{"bodies": ["float", "spar"], "point": [0, 0, -4]}]})");
  const Turned turned = turnedOf(run(readScene(folder / "buoy.json")).motion[0]);
  EXPECT_GT(turned.most_tilt, 0.05);
  EXPECT_LT(std::abs(turned.about_axis), 0.02);
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
  writeText(folder / "buoy.json", R"({"duration": 500, )" + std::string(kSwell) + R"(
    "robots": [{"urdf": "buoy.urdf"}]})");
  const Turned turned = turnedOf(run(readScene(folder / "buoy.json")).motion[0]);
  EXPECT_GT(turned.most_tilt, 0.05);
  EXPECT_LT(std::abs(turned.about_axis), 0.02);
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
  EXPECT_NEAR(meanHeight(record.motion[0], 10), 0, 0.01);
  EXPECT_GT(uprightness(record.motion[0].back()), 0.999);
  EXPECT_LT(record.motion[1].back().position.z(), -5);
}

}  // namespace
}  // namespace ambient
