#pragma once

#include <memory>
#include <mutex>

namespace ambient {

/// Place in a fluid body for the tables that loads make of it: made on first use, shared by all
/// worlds of the process, freed with the fluid body. A copy of the fluid body begins without.
class TablesPlace {
 public:
  TablesPlace() = default;
  TablesPlace(const TablesPlace&) {}
  TablesPlace& operator=(const TablesPlace&) {
    tables_ = nullptr;
    return *this;
  }

  /// Returns the tables; makes empty ones at the first call, by whichever thread comes first.
  template <class Tables>
  Tables& get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!tables_) tables_ = std::make_shared<Tables>();
    return *static_cast<Tables*>(tables_.get());
  }

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<void> tables_;
};

}  // namespace ambient
