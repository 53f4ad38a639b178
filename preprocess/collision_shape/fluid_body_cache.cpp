#include "preprocess/collision_shape/fluid_body_cache.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/collision_shape/form_image.h"

AMBIENT_BEGIN
namespace {

using SharedBody = SharedBodies::Body;

std::string withSize(std::string content, double size) {
  return content.append(reinterpret_cast<const char*>(&size), sizeof size);
}

}  // namespace

struct FluidBodyCache::Store {
  /// Last lists seen, for those that many shapes have alike: which vertices make triangles,
  /// normals.
  template <class Number>
  class LastLists {
   public:
    /// Lets a list have the memory of an equal one.
    void share(SharedList<Number>& list) {
      constexpr std::size_t kMost = 64;
      if (list.empty()) return;
      if (const auto same = std::find(lists_.begin(), lists_.end(), list); same != lists_.end()) {
        list = *same;
        return;
      }
      lists_.push_back(list);
      if (lists_.size() > kMost) lists_.pop_front();
    }

   private:
    std::deque<SharedList<Number>> lists_;
  };

  Store(CollisionShapeSettings wanted, BodyFolder folder)
      : settings(std::move(wanted)), maker(std::move(folder), settings.report) {}

  CollisionShapeSettings settings;
  BodyMaker maker;
  SharedBodies forms;                 // at size 1; of those that are soon made again, the last few
  SharedBodies shapes;                // at their own sizes
  std::mutex mutex;                   // of this:
  std::deque<std::string> soon_made;  // what such forms were made of
  std::unordered_map<std::string, SharedBody> by_name;
  LastLists<std::int32_t> triangles;
  LastLists<double> normals;

  SharedBody get(const ShapeForm& form, const std::string& whose) {
    const std::string& name = settings.name.empty() ? form.kind : settings.name;
    const auto make = [&](const auto& begin) {
      CollisionShapeSettings shown = settings;
      shown.begin = begin;
      return makeFormBody(form, shown);
    };
    const BodyMaker::Made made = maker.get(name, describeForm(form, settings), make, whose);
    maker.keep(made);
    for (const std::string& line : made.body->provenance.said) maker.say(line);
    return made.body;
  }

  // Scenes have few forms in many sizes, or a form for each shape, which then is kept but once.
  SharedBody getUnit(const std::string& content, const ShapeForm& form,
                     const std::function<std::string()>& whose) {
    constexpr std::size_t kKept = 16;
    bool is_new = false;
    const SharedBody unit = forms.get(content, [&] {
      is_new = true;
      return get(form, whose());
    });
    if (!is_new || !isSoonMade(form, settings)) return unit;
    const std::lock_guard<std::mutex> lock(mutex);
    soon_made.push_back(content);
    if (soon_made.size() <= kKept) return unit;
    forms.forget(soon_made.front());
    soon_made.pop_front();
    return unit;
  }

  /// Forms that are images of each other are solved once. What is said of a body may tell places in
  /// it, and so is said of no image.
  SharedBody getImage(const std::string& content, const ShapeForm& form,
                      const std::function<std::string()>& whose) {
    if (isSoonMade(form, settings) || settings.waterline_subdivisions > 0)
      return getUnit(content, form, whose);
    const FormImage image = firstImage(form);
    SharedBody unit = getUnit(image.form.kind + contentOf(image.form.parts), image.form, whose);
    if (image.turned == 0) return unit;
    if (!unit->provenance.said.empty()) return getUnit(content, form, whose);
    return std::make_shared<const FluidBody>(imageOf(*unit, image.turned));
  }

  /// Lets a body have lists in common with others of its kind.
  void share(FluidBody& body) {
    const std::lock_guard<std::mutex> lock(mutex);
    triangles.share(body.surface.triangles);
    triangles.share(body.form.hull);
    FaceTable& faces = body.form.faces;
    for (SharedList<double>* column : {&faces.normal_x, &faces.normal_y, &faces.normal_z})
      normals.share(*column);
  }

  SharedBody remember(SharedBody body) {
    const std::lock_guard<std::mutex> lock(mutex);
    by_name[body->name] = body;
    return body;
  }
};

FluidBodyCache::FluidBodyCache(CollisionShapeSettings settings, BodyFolder folder)
    : store_(std::make_unique<Store>(std::move(settings), std::move(folder))) {}

FluidBodyCache::~FluidBodyCache() = default;

SharedBody FluidBodyCache::fluidBody(const btCollisionShape& shape) {
  return fluidBodyOf([] { return std::string(); }, shape);
}

SharedBody FluidBodyCache::fluidBodyOf(const std::function<std::string()>& whose,
                                       const btCollisionShape& shape) {
  Store& store = *store_;
  const ShapeForm read = readForm(shape, store.settings);
  return store.shapes.get(read.kind + contentOf(read.parts), [&] {
    const ShapeForm form = normalised(recognised(read));
    const std::string content = form.kind + contentOf(form.parts);
    const std::string sized = withSize(content, form.size);
    const SharedBody unit = store.getImage(content, form, whose);
    FluidBody body = form.size == 1 ? *unit : scaled(*unit, form.size);
    body.faces = {};
    body.omits_faces = true;
    // Tells the fluid bodies of one kind of shape apart, the same in all programs.
    body.name = unit->name + " " + hashText(fnv1a64(sized));
    if (isSoonMade(form, store.settings)) store.share(body);
    return store.remember(std::make_shared<const FluidBody>(std::move(body)));
  });
}

SharedBody FluidBodyCache::find(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(store_->mutex);
  const auto found = store_->by_name.find(name);
  return found == store_->by_name.end() ? nullptr : found->second;
}

FluidBodyCache::Counts FluidBodyCache::counts() const { return store_->maker.counts(); }

AMBIENT_END
