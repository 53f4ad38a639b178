#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::pybullet {

/// A command as text: "water level=0 current=0.5,0,0" is a name, and keys with values. Numbers are
/// text, since PyBullet rounds `floatArgs` to float. Errors are std::invalid_argument with one line
/// that begins with the command's name.
class Command {
 public:
  /// `integers`: those of executePluginCommand().
  Command(const std::string& text, std::vector<int> integers);

  const std::string& name() const { return name_; }
  bool has(const std::string& key);
  std::string text(const std::string& key, const std::string& absent);
  double number(const std::string& key, double absent);
  Vector3 vector(const std::string& key, const Vector3& absent);
  /// Numbers with commas between them, at least `fewest` and at most `most`.
  std::vector<double> numbers(const std::string& key, std::size_t fewest, std::size_t most);
  /// Reads lists of numbers with semicolons between them, each as numbers() does; empty: the key is
  /// absent.
  std::vector<std::vector<double>> lists(const std::string& key, std::size_t fewest,
                                         std::size_t most);
  /// The number of a body: the first integer.
  int body() const;
  /// The second integer.
  int link(int absent) const { return integers_.size() > 1 ? integers_[1] : absent; }
  /// @throws std::invalid_argument if there are keys that nobody has asked for.
  void finish() const;
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
