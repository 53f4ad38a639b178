#pragma once

#include <functional>

namespace ambient {

/// Spreads work over the threads that a program already has: calls run(item) once for each item in
/// [0, count), in any order and on any threads, and returns when all are done. `run` does not
/// throw. A multithreaded world may call it from several threads at a time.
using TaskRunner = std::function<void(int count, const std::function<void(int item)>& run)>;

}  // namespace ambient
