#pragma once

// Flights of many bodies on several threads.

#include <LinearMath/btThreads.h>

#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/core/precision_check.h"

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
