#include "preprocess/collision_shape/fluid_body_cache.h"

#include <atomic>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "bullet_ambient/fluid_body/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fnv1a.h"
#include "preprocess/builder/reuse.h"
#include "preprocess/builder/shared_bodies.h"
#include "preprocess/collision_shape/form_body.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

namespace fs = std::filesystem;
using SharedBody = SharedBodies::Body;

std::string fileNameFor(const Provenance& provenance, const std::string& name) {
  const std::string text = name + '\n' + provenance.source + '\n' +
                           std::to_string(provenance.source_hash) + '\n' + provenance.settings +
                           '\n' + provenance.generator;
  char file_name[32];
  std::snprintf(file_name, sizeof file_name, "%016llx.ambient",
                static_cast<unsigned long long>(fnv1a64(text)));
  return file_name;
}

std::string withSize(std::string content, double size) {
  return content.append(reinterpret_cast<const char*>(&size), sizeof size);
}

}  // namespace

struct FluidBodyCache::Store {
  CollisionShapeSettings settings;
  fs::path folder;
  SharedBodies forms;   // at size 1
  SharedBodies shapes;  // at their own sizes
  std::atomic<int> made{0}, read{0};

  FluidBody make(const ShapeForm& form) {
    ++made;
    return makeFormBody(form, settings);
  }

  SharedBody readOrMake(const ShapeForm& form) {
    if (folder.empty()) return std::make_shared<const FluidBody>(make(form));
    const Provenance provenance = describeForm(form, settings);
    const std::string& name = settings.name.empty() ? form.kind : settings.name;
    const fs::path file = folder / fileNameFor(provenance, name);
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
      if (settings.report)
        settings.report(std::string("the fluid body is not kept: ") + error.what());
    }
  }
};

FluidBodyCache::FluidBodyCache(CollisionShapeSettings settings, fs::path folder)
    : store_(std::make_unique<Store>()) {
  store_->settings = std::move(settings);
  store_->folder = std::move(folder);
}

FluidBodyCache::~FluidBodyCache() = default;

SharedBody FluidBodyCache::fluidBody(const btCollisionShape& shape) {
  const ShapeForm form = normalised(readForm(shape, store_->settings));
  const std::string content = form.kind + contentOf(form.parts);
  return store_->shapes.get(withSize(content, form.size), [&] {
    const SharedBody unit = store_->forms.get(content, [&] { return store_->readOrMake(form); });
    if (form.size == 1) return unit;
    return std::make_shared<const FluidBody>(scaled(*unit, form.size));
  });
}

FluidBodyCache::Counts FluidBodyCache::counts() const { return {store_->made, store_->read}; }

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
