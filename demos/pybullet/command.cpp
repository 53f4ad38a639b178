#include "demos/pybullet/command.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace ambient::pybullet {

Command::Command(const std::string& text, std::vector<int> integers)
    : integers_(std::move(integers)) {
  std::istringstream words(text);
  words >> name_;
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    if (equals == std::string::npos) fail("'" + word + "' is not key=value");
    values_[word.substr(0, equals)] = word.substr(equals + 1);
  }
}

bool Command::has(const std::string& key) {
  known_.insert(key);
  return values_.count(key) > 0;
}

std::string Command::text(const std::string& key, const std::string& absent) {
  return has(key) ? values_[key] : absent;
}

double Command::number(const std::string& key, double absent) {
  return has(key) ? numbers(key, 1, 1)[0] : absent;
}

Vector3 Command::vector(const std::string& key, const Vector3& absent) {
  if (!has(key)) return absent;
  const std::vector<double> x = numbers(key, 3, 3);
  return {x[0], x[1], x[2]};
}

std::vector<double> Command::numbers(const std::string& key, std::size_t fewest, std::size_t most) {
  return parse(key, text(key, ""), fewest, most);
}

std::vector<std::vector<double>> Command::lists(const std::string& key, std::size_t fewest,
                                                std::size_t most) {
  std::vector<std::vector<double>> lists;
  std::istringstream parts(text(key, ""));
  for (std::string part; std::getline(parts, part, ';');)
    lists.push_back(parse(key, part, fewest, most));
  return lists;
}

std::vector<double> Command::parse(const std::string& key, const std::string& value,
                                   std::size_t fewest, std::size_t most) const {
  std::vector<double> numbers;
  std::istringstream words(value);
  for (std::string word; std::getline(words, word, ',');) {
    std::size_t used = 0;
    double number = 0;
    try {
      number = std::stod(word, &used);
    } catch (const std::exception&) {
      used = std::string::npos;
    }
    if (used != word.size() || !std::isfinite(number))
      fail(key + ": '" + word + "' is not a finite number");
    numbers.push_back(number);
  }
  if (numbers.size() < fewest || numbers.size() > most) {
    const std::string upper = most == fewest ? "" : " to " + std::to_string(most);
    fail(key + " takes " + std::to_string(fewest) + upper + " numbers, not " +
         std::to_string(numbers.size()));
  }
  return numbers;
}

int Command::body() const {
  if (integers_.empty()) fail("takes the number of a body, intArgs=[body, link]");
  return integers_[0];
}

void Command::finish() const {
  for (const auto& [key, value] : values_) {
    if (known_.count(key)) continue;
    std::string keys;
    for (const std::string& known : known_) keys += " " + known;
    fail("there is no '" + key + "'; there are:" + keys);
  }
}

void Command::fail(const std::string& why) const {
  throw std::invalid_argument(name_ + ": " + why);
}

}  // namespace ambient::pybullet
