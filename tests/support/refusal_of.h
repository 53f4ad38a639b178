#pragma once

#include <stdexcept>
#include <string>

namespace ambient::test {

/// Returns the sentence of an action's refusal, an exception of this type; empty if accepted.
template <class Refusal = std::runtime_error, class Action>
std::string refusalOf(const Action& action) {
  try {
    action();
  } catch (const Refusal& error) {
    return error.what();
  }
  return "";
}

}  // namespace ambient::test
