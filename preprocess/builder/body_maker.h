#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/body_folder.h"

namespace ambient {

/// Prints a line to standard error, begun with the library's name.
void printReport(const std::string& line);

/// Makes fluid bodies, or reads them from a folder, and counts them. While the work takes longer
/// than a second, one line per second says what is being made. May be used by several threads.
class BodyMaker {
 public:
  /// Receives lines, one at a time, also from a thread of its own; may be null.
  using Report = std::function<void(const std::string&)>;
  /// Makes a fluid body; calls begin() with the name of each stage that may take long.
  using Make = std::function<FluidBody(const std::function<void(const std::string& stage)>& begin)>;

  struct Made {
    std::shared_ptr<const FluidBody> body;
    std::filesystem::path file;  ///< for keep(); empty: it was read, or is not worth a file
  };
  struct Counts {
    int made = 0;
    int read = 0;  ///< from the folder
  };

  explicit BodyMaker(BodyFolder folder = {}, Report report = nullptr);

  /// Reads the body with this name and provenance, or makes it where the folder has none, or a
  /// file that is damaged, foreign or outdated. `whose`: what lines about the work say of it
  /// besides, such as "body 2 'crane', 3 of 14"; empty: nothing.
  Made get(const std::string& name, const Provenance& provenance, const Make& make,
           const std::string& whose = {});
  /// Writes a body into the folder, whole or not at all: other processes may read and write there.
  /// Reports in one line if it cannot be written.
  void keep(const Made& made);
  /// Gives a line to the report; drops what that throws.
  void say(const std::string& line) noexcept;
  Counts counts() const;

 private:
  using Clock = std::chrono::steady_clock;

  FluidBody makeShown(const std::string& label, const Make& make);

  const BodyFolder folder_;
  const Report report_;
  std::mutex saying_;
  mutable std::mutex mutex_;  // of these:
  Counts counts_;
  Clock::time_point end_, next_line_;  // of the last work; of the next line about it
};

}  // namespace ambient
