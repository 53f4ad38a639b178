#include "preprocess/builder/shared_bodies.h"

#include <exception>
#include <utility>

namespace ambient {

SharedBodies::Body SharedBodies::get(const std::string& key, const std::function<Body()>& make) {
  std::promise<Body> promise;
  std::shared_future<Body> body;
  bool is_new = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto [entry, inserted] = bodies_.try_emplace(key);
    is_new = inserted;
    if (is_new) entry->second = promise.get_future().share();
    body = entry->second;
  }
  if (is_new) {
    try {
      promise.set_value(make());
    } catch (...) {
      forget(key);
      promise.set_exception(std::current_exception());
    }
  }
  return body.get();
}

void SharedBodies::forget(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bodies_.erase(key);
}

}  // namespace ambient
