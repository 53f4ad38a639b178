#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <unordered_map>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Folder of .ambient files that keeps fluid bodies for other runs and programs.
struct BodyFolder {
  BodyFolder() = default;
  template <class Path,
            class = std::enable_if_t<std::is_constructible_v<std::filesystem::path, const Path&>>>
  BodyFolder(const Path& folder, std::chrono::milliseconds least_time = {})
      : path(folder), least(least_time) {}

  std::filesystem::path path;          ///< made when first needed; empty: none
  std::chrono::milliseconds least{0};  ///< bodies that are made in less time get no file
};

/// Returns the folder of the user, in which PyBullet and Python keep what takes more than 50 ms:
/// $BULLET_AMBIENT_CACHE, else bullet_ambient in $XDG_CACHE_HOME or in ~/.cache. None if
/// BULLET_AMBIENT_CACHE is "off", or without a home.
BodyFolder userBodyFolder();

/// Fluid bodies by key; may be used by any number of threads.
class SharedBodies {
 public:
  using Body = std::shared_ptr<const FluidBody>;

  /// Returns the body of a key. The first thread that asks calls make(); others wait for it. An
  /// exception of make() goes to all of them; the next caller makes the body again, as the memory
  /// or the file that was missing may be there then.
  Body get(const std::string& key, const std::function<Body()>& make);
  /// True if the body of a key is there, or is being made.
  bool has(const std::string& key);
  /// Lets go of the body of a key: the next caller makes it again.
  void forget(const std::string& key);

 private:
  std::mutex mutex_;
  std::unordered_map<std::string, std::shared_future<Body>> bodies_;
};

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
  /// besides, such as "body 'crane', 3 of 14"; empty: nothing.
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

/// Reads a fluid body if a build would give the same: the file can be read and has the name,
/// source, settings, program, version and solver revision given by `name` and `provenance`. Else
/// none.
std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance);

/// Name of the .ambient file for a cache: a hash of all that readIfSame() compares.
std::string keptFileName(const std::string& name, const Provenance& provenance);

}  // namespace ambient
