#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::pybullet {

/// Command from PyBullet's executePluginCommand(), such as "water level=0 current=0.5,0,0": a name,
/// and keys with values. Numbers are in the text, because PyBullet rounds `floatArgs` to single
/// precision. Functions throw std::invalid_argument with one line that begins with the command's
/// name.
class Command {
 public:
  /// `integers`: `intArgs` of executePluginCommand().
  Command(const std::string& text, std::vector<int> integers);

  const std::string& name() const { return name_; }
  // The following functions note the key as known, for finish(). `absent`: result without the key.
  bool has(const std::string& key);
  std::string text(const std::string& key, const std::string& absent);
  double number(const std::string& key, double absent);
  Vector3 vector(const std::string& key, const Vector3& absent);
  /// Reads numbers separated by commas, at least `fewest` and at most `most`.
  std::vector<double> numbers(const std::string& key, std::size_t fewest, std::size_t most);
  /// Reads lists separated by semicolons, each with numbers separated by commas. Returns none
  /// without the key.
  std::vector<std::vector<double>> lists(const std::string& key, std::size_t fewest,
                                         std::size_t most);
  /// Returns the value whose name the text gives for a key, out of pairs of value and name;
  /// `absent` without the key.
  template <class Names, class Value>
  Value choose(const std::string& key, const Names& names, Value absent) {
    if (!has(key)) return absent;
    std::string all;
    for (const auto& [value, name] : names) {
      if (name == values_[key]) return value;
      all += (all.empty() ? "" : ", ") + std::string(name);
    }
    fail(key + " is one of: " + all);
  }
  /// Returns the first integer, PyBullet's number of a body.
  int body() const;
  /// Returns the second integer, PyBullet's number of a link.
  int link(int absent) const { return integers_.size() > 1 ? integers_[1] : absent; }
  /// Checks the keys. @throws std::invalid_argument if the text has a key that was not read
  void finish() const;
  /// @throws std::invalid_argument always, with this reason
  [[noreturn]] void fail(const std::string& why) const;

 private:
  std::vector<double> parse(const std::string& key, const std::string& value, std::size_t fewest,
                            std::size_t most) const;

  std::string name_;
  std::vector<int> integers_;
  std::map<std::string, std::string> values_;
  std::set<std::string> known_;
};

}  // namespace ambient::pybullet
