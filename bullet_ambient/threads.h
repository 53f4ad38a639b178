#pragma once

// Flights of many bodies on several threads.

#include <LinearMath/btThreads.h>

#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// TaskRunner of Bullet's own task scheduler, set by btSetTaskScheduler(). If Bullet was built
/// without BT_THREADSAFE, as Debian's is, its scheduler does not work: items then run one after
/// another; write a TaskRunner that uses the threads of the program.
inline void runByBullet(int count, const std::function<void(int)>& run) {
#if BT_THREADSAFE
  struct Loop : btIParallelForBody {
    explicit Loop(const std::function<void(int)>& r) : run(r) {}
    void forLoop(int begin, int end) const override {
      for (int i = begin; i < end; ++i) run(i);
    }
    const std::function<void(int)>& run;
  };
  constexpr int kGrainSize = 4;
  btParallelFor(0, count, kGrainSize, Loop(run));
#else
  for (int i = 0; i < count; ++i) run(i);
#endif
}

AMBIENT_END
