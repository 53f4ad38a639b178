#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/matrices.h"

// A body small against a wave moves like the water at the surface. For the height a cos(theta),
// theta = k x - omega t, displacement along the wave is -a sin(theta).
namespace ambient::test {
namespace {

constexpr double kWaveGravity = 9.81;
const Vector3 kBuoySize(0.8, 0.6, 0.4);

/// A wave of slope 0.04; its length is a multiple of the box's.
struct LongWave {
  double number, frequency, amplitude;  ///< [1/m], [rad/s], [m]

  explicit LongWave(double boxes)
      : number(2 * kPi / (boxes * kBuoySize.x())),
        frequency(std::sqrt(kWaveGravity * number)),
        amplitude(0.04 / number) {}
  double period() const { return 2 * kPi / frequency; }
};

/// Amplitude over the wave's amplitude, and phase ahead of the water's motion [rad].
struct Response {
  double size, phase;
};
struct Responses {
  Response heave, surge;
};

struct Track {
  double time_step;
  std::vector<double> time;
  std::vector<Vector3> position;
};

/// A box of half the water's density, released at the crest with the water's velocity; its motion
/// from the third to the twelfth period.
Track boxInWave(const LongWave& wave, double time_step) {
  FluidWorld scene;
  scene.world.setGravity({0, 0, bt(-kWaveGravity)});
  FluidRegion sea;
  sea.below = {1000, 1e-3, {0, 0, 0}, {0, 0, 0}};
  sea.above = Medium{};  // a vacuum
  sea.surface = std::make_shared<AiryWaves>(
      CalmSea{}, std::vector<WaveComponent>{{wave.amplitude, wave.period(), {1, 0, 0}, 0}});
  scene.fluid.addRegion(sea);
  BodyDef def;
  def.mass = 500 * kBuoySize.prod();
  const Vector3 q = kBuoySize.cwiseAbs2() * (def.mass / 12);
  def.moments = Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
  def.start.position = {0, 0, wave.amplitude};
  def.start.twist.linear = {wave.amplitude * wave.frequency, 0, 0};
  btRigidBody& body = scene.add(def);
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(floatingBox(kBuoySize));
  attach.flow.law = PressureLaw::kForm;
  scene.fluid.add(body, attach);

  Track track{time_step, {}, {}};
  const auto steps = [&](double periods) {
    return static_cast<int>(std::lround(periods * wave.period() / time_step));
  };
  for (int i = 1; i <= steps(12); ++i) {
    scene.step(time_step);
    if (i <= steps(2)) continue;
    track.time.push_back(i * time_step);
    track.position.push_back(toVector3(body.getWorldTransform().getOrigin()));
  }
  return track;
}

/// Fits place, drift, and cosine and sine of the wave at the drifting place, by least squares.
Responses responsesOf(const Track& track, const LongWave& wave) {
  const auto rows = static_cast<Eigen::Index>(track.time.size());
  Eigen::MatrixXd basis(rows, 4), moved(rows, 2);
  Eigen::MatrixXd fit = Eigen::MatrixXd::Zero(4, 2);
  for (int pass = 0; pass < 3; ++pass) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = track.time[static_cast<std::size_t>(i)];
      const Vector3& p = track.position[static_cast<std::size_t>(i)];
      const double angle = wave.number * (fit(0, 0) + fit(1, 0) * t) - wave.frequency * t;
      basis.row(i) << 1, t, std::cos(angle), std::sin(angle);
      moved.row(i) << p.x(), p.z();
    }
    fit = leastSquares(basis, moved);
  }
  // Phase of time is opposite to theta.
  return {{fit.col(1).tail<2>().norm() / wave.amplitude, std::atan2(fit(3, 1), fit(2, 1))},
          {fit.col(0).tail<2>().norm() / wave.amplitude, std::atan2(fit(2, 0), -fit(3, 0))}};
}

Responses responsesTo(double boxes, double time_step) {
  const LongWave wave(boxes);
  return responsesOf(boxInWave(wave, time_step), wave);
}

// Measured, as in docs/water.md. Surge lags by half a step: the flow of each step is sampled at its
// start.
TEST(LongWave, ASmallBodyMovesAsTheWaterAtTheSurface) {
  for (const double boxes : {40.0, 281.0})
    for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 120}) {
      const Responses response = responsesTo(boxes, step);
      const double step_angle = LongWave(boxes).frequency * step;
      EXPECT_NEAR(response.heave.size, 1, 0.0015) << boxes << ", " << step;
      EXPECT_NEAR(response.surge.size, 0.9925, 0.0025) << boxes << ", " << step;
      EXPECT_NEAR(response.heave.phase, 0, 0.1 * step_angle) << boxes << ", " << step;
      EXPECT_NEAR(response.surge.phase, -0.4 * step_angle, 0.25 * step_angle)
          << boxes << ", " << step;
    }
}

}  // namespace
}  // namespace ambient::test
