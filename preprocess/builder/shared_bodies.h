#pragma once

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Fluid bodies by key, for any number of threads.
class SharedBodies {
 public:
  using Body = std::shared_ptr<const FluidBody>;

  /// The body of that key, made by the first thread that asks; others wait for it. What `make`
  /// throws, all of them get, now and later.
  Body get(const std::string& key, const std::function<Body()>& make);

 private:
  std::mutex mutex_;
  std::unordered_map<std::string, std::shared_future<Body>> bodies_;
};

}  // namespace ambient
