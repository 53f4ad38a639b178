#pragma once

#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

namespace ambient {

/// Cache of tables, keyed by their source and settings; an entry lives while its table is used.
template <class Source, class Table, class Settings = std::tuple<>>
class SharedTables {
 public:
  /// Returns the table of a source and settings; calls make(), which returns a new one, if none.
  template <class Make>
  std::shared_ptr<const Table> get(const std::shared_ptr<const Source>& source,
                                   const Settings& settings, const Make& make) {
    const std::pair<const Source*, Settings> key{source.get(), settings};
    if (const auto found = entries_.find(key); found != entries_.end())
      if (auto table = found->second.table.lock(); table && found->second.source.lock() == source)
        return table;
    if (entries_.size() >= most_entries_) dropUnused();
    std::shared_ptr<const Table> table = make();
    entries_[key] = {source, table};
    return table;
  }

 private:
  struct Entry {
    std::weak_ptr<const Source> source;  ///< detects a new source at a reused address
    std::weak_ptr<const Table> table;
  };

  // Erases entries of unused tables. The next call comes after the number of entries has doubled.
  void dropUnused() {
    for (auto entry = entries_.begin(); entry != entries_.end();)
      entry = entry->second.table.expired() ? entries_.erase(entry) : std::next(entry);
    most_entries_ = 2 * entries_.size() + 1;
  }

  std::map<std::pair<const Source*, Settings>, Entry> entries_;
  std::size_t most_entries_ = 1;
};

}  // namespace ambient
