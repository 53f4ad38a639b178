#include "demos/simulation/sweep.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

#include "preprocess/base/parallel_for.h"

namespace ambient {
namespace {

/// State shared by the threads of one sweep.
class RunningSweep {
 public:
  RunningSweep(const std::vector<Scene>& scenes, const SweepSettings& settings)
      : scenes_(scenes),
        settings_(settings),
        fluid_bodies_(settings.fluid_bodies, settings.threads, settings.report) {}

  /// Runs all scenes while this thread calls watch(). Without another thread runs them first.
  SweepFailures run() {
    const auto run_all = [this] {
      parallelFor(threadCount(settings_.threads), count(),
                  [this](std::ptrdiff_t i) { tryOne(static_cast<int>(i)); });
    };
    std::thread worker;
    try {
      worker = std::thread(run_all);
    } catch (const std::system_error&) {
      run_all();
    }
    try {
      watch();
    } catch (...) {
      is_stopped_ = true;
      if (worker.joinable()) worker.join();
      throw;
    }
    if (worker.joinable()) worker.join();
    return std::move(failures_);
  }

 private:
  int count() const { return static_cast<int>(scenes_.size()); }

  void tryOne(int i) noexcept {
    if (is_stopped_) return;
    std::string failure;
    try {
      runOne(i);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure.empty() && !is_stopped_) failures_.emplace(i, failure);
    ++ended_;
    changed_.notify_one();
  }

  void runOne(int i) {
    const Scene& scene = scenes_[static_cast<std::size_t>(i)];
    const std::vector<PreparedBody> bodies = prepare(scene);
    const RunRecord record = runScene(scene, bodies, [this](double) { return !is_stopped_; });
    settings_.take({i, scene, bodies, record});
  }

  /// Prepares the bodies of one scene at a time: the solver uses all cores itself.
  std::vector<PreparedBody> prepare(const Scene& scene) {
    const std::lock_guard<std::mutex> lock(preparing_);
    std::vector<PreparedBody> bodies = prepareBodies(scene, fluid_bodies_);
    fluid_bodies_.save();
    return bodies;
  }

  void watch() {
    constexpr std::chrono::milliseconds kInterval(100);
    std::unique_lock<std::mutex> lock(mutex_);
    for (int ended = -1; ended < count();) {
      changed_.wait_for(lock, kInterval, [&] { return ended_ == count(); });
      ended = ended_;
      lock.unlock();
      if (!settings_.watch(ended)) throw RunStopped();
      lock.lock();
    }
  }

  const std::vector<Scene>& scenes_;
  const SweepSettings& settings_;
  std::mutex preparing_;
  SceneBodyCache fluid_bodies_;
  std::atomic<bool> is_stopped_{false};
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  int ended_ = 0;
  SweepFailures failures_;
};

}  // namespace

SweepFailures runSweep(const std::vector<Scene>& scenes, const SweepSettings& settings) {
  return RunningSweep(scenes, settings).run();
}

}  // namespace ambient
