#include "demos/simulation/scene_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "demos/simulation/motion_interpolation.h"
#include "demos/simulation/trajectory_text.h"
#include "preprocess/builder/elapsed_display.h"

namespace ambient {
namespace {

// A multiple of a decimal step differs from the decimal number by rounding only.
constexpr double kRounding = 1e-9;

std::atomic<bool> interrupted{false};

/// Of the two quaternions of one rotation, the one nearer to the sample before.
MotionSample withContinuousSign(MotionSample sample, const MotionSample& before) {
  if (sample.orientation.dot(before.orientation) < 0) sample.orientation.coeffs() *= -1;
  return sample;
}

/// Hands the samples of successive steps on at the output times.
class Sampler {
 public:
  Sampler(const Scene& scene, OutputFile& file, RunRecord& record)
      : scene_(scene), file_(file), record_(record), times_(outputTimes(scene)) {
    record_.motion.resize(scene.bodies.size());
    file_.write(std::string(kTrajectoryHeader) + "\n");
  }

  void add(const std::vector<MotionSample>& now) {
    const double tolerance = kRounding * scene_.time_step;
    while (next_ < times_.size() && times_[next_] <= now.front().time + tolerance) {
      for (std::size_t i = 0; i < now.size(); ++i) write(i, now[i]);
      ++next_;
    }
    last_ = now;
  }

 private:
  void write(std::size_t body, const MotionSample& now) {
    const double time = times_[next_];
    const bool at_step = std::abs(time - now.time) <= kRounding * scene_.time_step;
    MotionSample sample = at_step ? now : interpolateMotion(last_[body], now, time);
    sample.time = time;
    std::vector<MotionSample>& motion = record_.motion[body];
    if (!motion.empty()) sample = withContinuousSign(sample, motion.back());
    motion.push_back(sample);
    file_.write(trajectoryRow(scene_.bodies[body].name, sample));
  }

  const Scene& scene_;
  OutputFile& file_;
  RunRecord& record_;
  std::vector<double> times_;
  std::vector<MotionSample> last_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<double> outputTimes(const Scene& scene) {
  std::vector<double> times;
  for (double time = 0; time < scene.duration * (1 - kRounding);
       time = static_cast<double>(times.size()) * scene.output_step)
    times.push_back(time);
  times.push_back(scene.duration);
  return times;
}

long long countSteps(const Scene& scene) {
  return static_cast<long long>(std::ceil(scene.duration / scene.time_step * (1 - kRounding)));
}

void interruptRun() noexcept { interrupted = true; }

RunRecord runScene(const Scene& scene, const std::vector<PreparedBody>& bodies, OutputFile& file,
                   bool quiet) {
  using Clock = std::chrono::steady_clock;
  RunRecord record;
  record.steps = countSteps(scene);
  Simulation simulation(scene, bodies);
  Sampler sampler(scene, file, record);
  ElapsedDisplay progress(scene.name + ": simulating", quiet);
  sampler.add(simulation.sample());
  Clock::duration stepping{};
  for (long long i = 0; i < record.steps; ++i) {
    const auto start = Clock::now();
    simulation.step();
    stepping += Clock::now() - start;
    sampler.add(simulation.sample());
    if (interrupted) throw std::runtime_error("interrupted");
    progress.update(static_cast<double>(i + 1) / static_cast<double>(record.steps));
  }
  record.wall_seconds = std::chrono::duration<double>(stepping).count();
  for (std::size_t i = 0; i < bodies.size(); ++i) record.work.push_back(simulation.work(i));
  record.warning = simulation.warning();
  return record;
}

}  // namespace ambient
