#include "demos/sweep/sweep.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

namespace ambient {
namespace {

/// State shared by the threads of one sweep.
class RunningSweep {
 public:
  RunningSweep(const std::vector<Scene>& scenes, const SweepSettings& settings)
      : scenes_(scenes),
        settings_(settings),
        fluid_bodies_(settings.fluid_bodies, settings.threads) {}

  /// Starts the threads, calls watch() and joins the threads. Without threads does the work itself.
  SweepFailures run() {
    std::vector<std::thread> threads = startThreads();
    try {
      if (threads.empty()) work();
      watch();
    } catch (...) {
      is_stopped_ = true;
      for (std::thread& thread : threads) thread.join();
      throw;
    }
    for (std::thread& thread : threads) thread.join();
    return std::move(failures_);
  }

 private:
  int count() const { return static_cast<int>(scenes_.size()); }

  int threadCount() const {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return std::min(settings_.threads > 0 ? settings_.threads : cores, count());
  }

  /// Starts the threads; fewer if the system refuses more.
  std::vector<std::thread> startThreads() {
    std::vector<std::thread> threads;
    try {
      for (int i = 0; i < threadCount(); ++i) threads.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
    }
    return threads;
  }

  void work() noexcept {
    for (int i = next_++; i < count() && !is_stopped_; i = next_++) {
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
    if (!settings_.fluid_bodies.empty()) fluid_bodies_.save();
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
  std::atomic<int> next_{0};
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
