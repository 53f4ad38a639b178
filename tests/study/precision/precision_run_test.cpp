#include "tests/study/precision/precision_run.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demos/integrators/integrators.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {
namespace {

class PrecisionRuns : public ::testing::Test {
 protected:
  explicit PrecisionRuns(const char* scene = "underwater_ellipsoid", const char* duration = "0.5")
      : scene_(readScene(std::string(AMBIENT_DATA) + "/scenes/" + scene + ".json",
                         {{"duration", duration}})) {
    SceneBodyCache cache;
    bodies_ = prepareBodies(scene_, cache);
  }

  PrecisionRun run(OwnFlight integrator, double rate, int takes = 1) const {
    const PrecisionMethod method{"", {1e-6, 0, integrator}, 1 / rate};
    return runWithMethod(scene_, bodies_, method, takes);
  }

  Scene scene_;
  std::vector<PreparedBody> bodies_;
};

class FlapRuns : public PrecisionRuns {
 protected:
  FlapRuns() : PrecisionRuns("flap_in_current", "1") {}
};

TEST_F(PrecisionRuns, ErrorShrinksWithTheStep) {
  const PrecisionRun reference = run(flyDormandPrince, 1920);
  const PrecisionError coarse = errorOf(run(flySymplecticEuler, 60), reference);
  const PrecisionError fine = errorOf(run(flySymplecticEuler, 960), reference);
  EXPECT_GT(fine.position, 0);
  EXPECT_LT(fine.position, coarse.position / 12);
  EXPECT_LT(fine.angle, coarse.angle / 12);
  EXPECT_LT(errorOf(run(flyDormandPrince, 60), reference).position, fine.position);
}

TEST_F(FlapRuns, JointsErrToFirstOrderInTheStep) {
  // Measured, as in docs/error_vs_runtime.md; the reference has a sixteenth of the coarse error.
  const PrecisionRun reference = run(nullptr, 3840);
  const PrecisionError coarse = errorOf(run(nullptr, 240), reference);
  const PrecisionError fine = errorOf(run(nullptr, 480), reference);
  EXPECT_NEAR(coarse.position / fine.position, 15.0 / 7, 0.3);
}

TEST_F(PrecisionRuns, ComparesAtSamplesAndCountsTheWork) {
  const PrecisionRun twice = run(flySymplecticEuler, 120, 2);
  EXPECT_EQ(twice.motion.size(), 15U);
  EXPECT_EQ(twice.load_evaluations, 60);
  EXPECT_GT(twice.processor_seconds, 0);
  const PrecisionError none = errorOf(twice, run(flySymplecticEuler, 120));
  EXPECT_EQ(none.position, 0);
  EXPECT_EQ(none.angle, 0);
}

TEST_F(PrecisionRuns, ARunThatBreaksDownIsInfinitelyWrong) {
  const PrecisionRun reference = run(flyDormandPrince, 60);
  scene_.bodies[0].angular_velocity = {0, 3000, 3000};
  const PrecisionRun broken = run(flySymplecticEuler, 30);
  EXPECT_FALSE(broken.finite);
  EXPECT_TRUE(std::isinf(errorOf(broken, reference).position));
}

}  // namespace
}  // namespace ambient
