#pragma once

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Fluid bodies by key; may be used by any number of threads.
class SharedBodies {
 public:
  using Body = std::shared_ptr<const FluidBody>;

  /// Returns the body of a key. The first thread that asks calls make(); others wait for it. An
  /// exception of make() goes to all of them; the next caller makes the body again, as the memory
  /// or the file that was missing may be there then.
  Body get(const std::string& key, const std::function<Body()>& make);
  /// Lets go of the body of a key: the next caller makes it again.
  void forget(const std::string& key);

 private:
  std::mutex mutex_;
  std::unordered_map<std::string, std::shared_future<Body>> bodies_;
};

}  // namespace ambient
