#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace ambient {

/// A child process that ended without a result; the message continues "what it did ...".
struct ChildFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a child process and returns the bytes that it returned there: a crash, damaged
/// memory, leaks and endless loops of foreign code end with the child. What it writes to standard
/// error is lost. Only the calling thread exists in the child: `work` must not wait for others.
/// @throws std::runtime_error with the message of what `work` threw.
/// @throws ChildFailure if it crashed, was killed, used more than `most_seconds` of processor time,
/// or could not be started.
std::string runInChild(const std::function<std::string()>& work, int most_seconds);

}  // namespace ambient
