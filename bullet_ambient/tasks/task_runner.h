#pragma once

namespace ambient {

/// Work on independent items.
class Task {
 public:
  virtual void run(int item) const noexcept = 0;

 protected:
  ~Task() = default;
};

/// Spreads work over threads: derive from it to use the scheduler that a program already has.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  /// Runs every item in [0, count) once, in any order and on any threads, and returns when all are
  /// done. May be called from several threads at a time by a multithreaded world.
  virtual void runAll(const Task& task, int count) noexcept = 0;
};

}  // namespace ambient
