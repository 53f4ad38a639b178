#pragma once

// Flights of many bodies on several threads.

#include <LinearMath/btThreads.h>

#include "bullet_ambient/bullet/core/precision_check.h"

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

AMBIENT_BEGIN

/// Runs tasks by Bullet's own task scheduler, set by btSetTaskScheduler(). If Bullet was built
/// without BT_THREADSAFE, as Debian's is, its scheduler does not work: tasks then run one after
/// another: derive a TaskRunner that uses the threads of the program.
class BulletTaskRunner : public TaskRunner {
 public:
  void runAll(const Task& task, int count) noexcept override {
#if BT_THREADSAFE
    constexpr int kGrainSize = 4;
    const Loop loop(task);
    btParallelFor(0, count, kGrainSize, loop);
#else
    for (int i = 0; i < count; ++i) task.run(i);
#endif
  }

 private:
#if BT_THREADSAFE
  struct Loop : btIParallelForBody {
    explicit Loop(const Task& t) : task(t) {}
    void forLoop(int begin, int end) const override {
      for (int i = begin; i < end; ++i) task.run(i);
    }
    const Task& task;
  };
#endif
};

AMBIENT_END
