#pragma once

namespace ambient {

/// Work on independent items, numbered from 0.
class Task {
 public:
  virtual void run(int item) const noexcept = 0;  ///< works on one item; on any thread

 protected:
  ~Task() = default;
};

/// Spreads work over threads: derive from it to use the scheduler that a program already has.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  /// Runs every item in [0, count) once, in any order and on any threads. Returns when all items
  /// are done. A multithreaded world may call runAll() from several threads at a time.
  virtual void runAll(const Task& task, int count) noexcept = 0;
};

}  // namespace ambient
