#include "preprocess/collision_shape/fluid_body_cache.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/builder/background_work.h"
#include "preprocess/builder/reuse.h"
#include "preprocess/builder/shared_bodies.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/collision_shape/shape_parts.h"

AMBIENT_BEGIN
namespace {

namespace fs = std::filesystem;
using SharedBody = SharedBodies::Body;

std::string withSize(std::string content, double size) {
  return content.append(reinterpret_cast<const char*>(&size), sizeof size);
}

}  // namespace

struct FluidBodyCache::Store {
  CollisionShapeSettings settings;
  CollisionShapeSettings instant_settings;
  fs::path folder;
  bool has_instants = false;
  Replacement replacement = Replacement::kWhenReady;
  SharedBodies forms;          // at size 1
  SharedBodies shapes;         // at their own sizes
  SharedBodies instant_forms;  // the same, guessed
  SharedBodies instant_shapes;
  std::atomic<int> made{0}, read{0}, guessed{0};
  std::atomic<unsigned> revision{0};
  std::mutex mutex;  // of these:
  std::unordered_set<std::string> ready, published;
  std::unordered_map<std::string, SharedBody> by_name;
  BackgroundWork work;  // last: it ends before what it works on

  FluidBody make(const ShapeForm& form) {
    ++made;
    return makeFormBody(form, settings);
  }

  SharedBody readOrMake(const ShapeForm& form) {
    if (folder.empty()) return std::make_shared<const FluidBody>(make(form));
    const Provenance provenance = describeForm(form, settings);
    const std::string& name = settings.name.empty() ? form.kind : settings.name;
    const fs::path file = folder / keptFileName(name, provenance);
    if (std::optional<FluidBody> kept = readIfSame(file, name, provenance)) {
      ++read;
      return std::make_shared<const FluidBody>(*std::move(kept));
    }
    SharedBody body = std::make_shared<const FluidBody>(make(form));
    keep(*body, file);
    return body;
  }

  // Under a temporary name until it is whole: other processes may read and write the same folder.
  void keep(const FluidBody& body, const fs::path& file) const {
    try {
      fs::create_directories(folder);
      writeFluidBody(body, file);
    } catch (const std::exception& error) {
      say(std::string("the fluid body is not kept: ") + error.what());
    }
  }

  // Reports a line. Drops what the user's function throws: nobody could catch it in the background.
  void say(const std::string& text) const noexcept {
    try {
      if (settings.report) settings.report(text);
    } catch (...) {
    }
  }

  SharedBody remember(SharedBody body) {
    const std::lock_guard<std::mutex> lock(mutex);
    by_name[body->name] = body;
    return body;
  }

  bool isPublished(const std::string& content) {
    const std::lock_guard<std::mutex> lock(mutex);
    return published.count(content) > 0;
  }

  void publishReady() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (ready.empty()) return;
      published.merge(ready);
      ready.clear();
    }
    ++revision;
  }

  SharedBody guess(const ShapeForm& form, const std::string& content) {
    ++guessed;
    auto body = std::make_shared<const FluidBody>(makeFormBody(form, instant_settings));
    work.add([this, form, content] { solveInBackground(form, content); });
    return body;
  }

  // Solves a form that was guessed. A form that cannot be solved keeps its guess.
  void solveInBackground(const ShapeForm& form, const std::string& content) noexcept {
    try {
      forms.get(content, [&] { return readOrMake(form); });
      {
        const std::lock_guard<std::mutex> lock(mutex);
        ready.insert(content);
      }
      if (replacement == Replacement::kWhenReady) publishReady();
    } catch (const std::exception& error) {
      say(error.what());
    }
  }
};

FluidBodyCache::FluidBodyCache(CollisionShapeSettings settings, fs::path folder,
                               Replacement replacement)
    : store_(std::make_unique<Store>()) {
  store_->has_instants = settings.quality == Quality::kInstant;
  store_->instant_settings = settings;
  store_->instant_settings.report = nullptr;  // it is said of the solution
  store_->settings = std::move(settings);
  store_->settings.quality = Quality::kStandard;
  store_->folder = std::move(folder);
  store_->replacement = replacement;
}

FluidBodyCache::~FluidBodyCache() = default;

SharedBody FluidBodyCache::fluidBody(const btCollisionShape& shape) {
  Store& store = *store_;
  const ShapeForm form = normalised(readForm(shape, store.settings));
  const std::string content = form.kind + contentOf(form.parts);
  const bool is_guess = store.has_instants && !store.isPublished(content);
  SharedBodies& forms = is_guess ? store.instant_forms : store.forms;
  SharedBodies& shapes = is_guess ? store.instant_shapes : store.shapes;
  const std::string sized = withSize(content, form.size);
  return shapes.get(sized, [&] {
    const SharedBody unit = forms.get(
        content, [&] { return is_guess ? store.guess(form, content) : store.readOrMake(form); });
    FluidBody body = form.size == 1 ? *unit : scaled(*unit, form.size);
    // Tells the fluid bodies of one kind of shape apart, the same in all programs.
    body.name = unit->name + " " + hashText(fnv1a64(sized));
    return store.remember(std::make_shared<const FluidBody>(std::move(body)));
  });
}

SharedBody FluidBodyCache::find(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(store_->mutex);
  const auto found = store_->by_name.find(name);
  return found == store_->by_name.end() ? nullptr : found->second;
}

unsigned FluidBodyCache::revision() const noexcept { return store_->revision; }

void FluidBodyCache::finish() {
  store_->work.finish();
  store_->publishReady();
}

FluidBodyCache::Counts FluidBodyCache::counts() const {
  return {store_->made, store_->read, store_->guessed};
}

AMBIENT_END
