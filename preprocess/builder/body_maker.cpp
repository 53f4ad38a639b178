#include "preprocess/builder/body_maker.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

std::filesystem::path variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

BodyFolder userBodyFolder() {
  constexpr std::chrono::milliseconds kWorthAFile(50);
  const auto chosen = variable("BULLET_AMBIENT_CACHE"), home = variable("HOME");
  auto cache = variable("XDG_CACHE_HOME");
  if (chosen == "off") return {};
  if (!chosen.empty()) return {chosen, kWorthAFile};
  if (!cache.is_absolute()) cache = home / ".cache";  // as the XDG specification says
  if (!cache.is_absolute()) return {};
  return {cache / "bullet_ambient", kWorthAFile};
}

SharedBodies::Body SharedBodies::get(const std::string& key, const std::function<Body()>& make) {
  std::promise<Body> promise;
  std::shared_future<Body> body;
  bool is_new = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto [entry, inserted] = bodies_.try_emplace(key);
    is_new = inserted;
    if (is_new) entry->second = promise.get_future().share();
    body = entry->second;
  }
  if (is_new) {
    try {
      promise.set_value(make());
    } catch (...) {
      forget(key);
      promise.set_exception(std::current_exception());
    }
  }
  return body.get();
}

bool SharedBodies::has(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return bodies_.count(key) != 0;
}

void SharedBodies::forget(const std::string& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  bodies_.erase(key);
}

namespace {

constexpr std::chrono::seconds kBetweenLines(1);

}  // namespace

void printReport(const std::string& line) {
  std::fprintf(stderr, "bullet_ambient: %s\n", plainLine(line).c_str());
}

BodyMaker::BodyMaker(BodyFolder folder, Report report)
    : folder_(std::move(folder)), report_(std::move(report)) {}

BodyMaker::Made BodyMaker::get(const std::string& name, const Provenance& provenance,
                               const Make& make, const std::string& whose) {
  std::filesystem::path file;
  if (!folder_.path.empty()) {
    file = folder_.path / keptFileName(name, provenance);
    if (std::optional<FluidBody> kept = readIfSame(file, name, provenance)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++counts_.read;
      return {std::make_shared<const FluidBody>(*std::move(kept)), {}};
    }
  }
  const Clock::time_point begin = Clock::now();
  const std::string label =
      "making the fluid body of '" + name + (whose.empty() ? "'" : "' for " + whose);
  auto body = std::make_shared<const FluidBody>(makeShown(label, make));
  if (Clock::now() - begin < folder_.least) file.clear();
  return {std::move(body), std::move(file)};
}

// Bodies that are made right after each other are one work.
FluidBody BodyMaker::makeShown(const std::string& label, const Make& make) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.made;
    const Clock::time_point now = Clock::now();
    if (now - end_ > kBetweenLines) next_line_ = now + kBetweenLines;
  }
  const auto print = [this](const std::string& line) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = Clock::now();
      if (end_ < next_line_) return;
      next_line_ = end_ + kBetweenLines;
    }
    say(line);
  };
  FluidBody body;
  {
    std::optional<ElapsedDisplay> display;
    body = make([&](const std::string& stage) {
      if (report_ && !display) display.emplace(label, print, std::chrono::milliseconds(100));
      if (display) display->begin(stage);
    });
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  end_ = Clock::now();
  return body;
}

void BodyMaker::keep(const Made& made) {
  if (made.file.empty()) return;
  try {
    std::filesystem::create_directories(folder_.path);
    writeFluidBody(*made.body, made.file);
  } catch (const std::exception& error) {
    say(std::string("the fluid body is not kept: ") + error.what());
  }
}

void BodyMaker::say(const std::string& line) noexcept {
  if (!report_) return;
  const std::lock_guard<std::mutex> lock(saying_);
  try {
    report_(line);
  } catch (...) {  // nobody could catch it on the thread that shows the work
  }
}

BodyMaker::Counts BodyMaker::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

std::optional<FluidBody> readIfSame(const std::filesystem::path& file, const std::string& name,
                                    const Provenance& provenance) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  try {
    FluidBody body = readPrepared(file);
    const Provenance& found = body.provenance;
    const bool is_same = body.name == name && found.source == provenance.source &&
                         found.source_hash == provenance.source_hash &&
                         found.settings == provenance.settings &&
                         found.generator == provenance.generator;
    if (is_same) return body;
  } catch (const std::runtime_error&) {
    // A damaged or foreign file is as good as none.
  }
  return std::nullopt;
}

std::string keptFileName(const std::string& name, const Provenance& provenance) {
  const std::string text = name + '\n' + provenance.source + '\n' +
                           std::to_string(provenance.source_hash) + '\n' + provenance.settings +
                           '\n' + provenance.generator;
  return hashText(fnv1a64(text)) + ".ambient";
}

}  // namespace ambient
