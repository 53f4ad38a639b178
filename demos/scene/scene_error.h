#pragma once

#include <stdexcept>
#include <string>

namespace ambient {

/// Bad input in a scene: one line "<file>: <place> <what is wrong and the limit>".
class SceneError : public std::runtime_error {
 public:
  SceneError(const std::string& file, const std::string& message)
      : std::runtime_error(file + ": " + message) {}
};

}  // namespace ambient
