#include "preprocess/collision_shape/fluid_body_cache.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/collision_shape/shape_form.h"

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

  /// A form to be made beside others.
  struct Work {
    std::string content;
    ShapeForm form;
    std::string whose;
    SharedBody made;  ///< null: it was there, or there is none
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
  std::unordered_map<std::string, std::exception_ptr> refused;  // not told yet
  std::unordered_map<std::thread::id, const Expected*> expected;
  LastLists<std::int32_t> triangles;
  LastLists<double> normals;

  /// Makes the body of a form, or reads it, and keeps it; on so many threads.
  SharedBody get(const ShapeForm& form, const std::string& whose, int threads) {
    const std::string& name = settings.name.empty() ? form.kind : settings.name;
    const auto make = [&](const auto& begin) {
      CollisionShapeSettings shown = settings;
      shown.begin = begin;
      shown.flow.threads = threads;
      return makeFormBody(form, shown);
    };
    const BodyMaker::Made made = maker.get(name, describeForm(form, settings), make, whose);
    maker.keep(made);
    return made.body;
  }

  void say(const FluidBody& body) {
    for (const std::string& line : body.provenance.said) maker.say(line);
  }

  // Scenes have few forms in many sizes, or a form for each shape, which then is kept but once.
  SharedBody getUnit(const std::string& content, const ShapeForm& form,
                     const std::function<std::string()>& whose) {
    constexpr std::size_t kKept = 16;
    bool is_new = false;
    const SharedBody unit = forms.get(content, [&] {
      is_new = true;
      throwIfRefused(content);
      return get(form, whose(), settings.flow.threads);
    });
    if (is_new) say(*unit);
    if (!is_new || !isSoonMade(form, settings)) return unit;
    const std::lock_guard<std::mutex> lock(mutex);
    soon_made.push_back(content);
    if (soon_made.size() <= kKept) return unit;
    forms.forget(soon_made.front());
    soon_made.pop_front();
    return unit;
  }

  void makeBeside(Work& work, int threads) {
    try {
      forms.get(work.content, [&] { return work.made = get(work.form, work.whose, threads); });
    } catch (const std::exception&) {
      const std::lock_guard<std::mutex> lock(mutex);
      refused[work.content] = std::current_exception();
    }
  }

  /// Throws, once, what makeBeside() found.
  void throwIfRefused(const std::string& content) {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto found = refused.find(content);
    if (found == refused.end()) return;
    const std::exception_ptr reason = found->second;
    refused.erase(found);
    std::rethrow_exception(reason);
  }

  /// Makes what the calling thread expects, once.
  void makeExpected() {
    const Expected* wanted = nullptr;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      const auto found = expected.find(std::this_thread::get_id());
      if (found == expected.end()) return;
      wanted = found->second;
      expected.erase(found);
    }
    std::vector<Work> works;
    std::unordered_set<const btCollisionShape*> seen;
    std::unordered_set<std::string> contents;
    for (std::size_t k = 0; k < wanted->shapes.size(); ++k) {
      const btCollisionShape* shape = wanted->shapes[k];
      if (!shape || !seen.insert(shape).second) continue;
      try {
        ShapeForm form = normalised(recognised(readForm(*shape, settings)));
        if (!isSolvedAsImage(form)) continue;
        form = firstImage(form).form;
        std::string content = form.kind + contentOf(form.parts);
        if (contents.insert(content).second)
          works.push_back({std::move(content), std::move(form), wanted->whose(k), nullptr});
      } catch (const std::exception&) {  // fluidBodyOf() says why
      }
    }
    const auto count = static_cast<int>(works.size());
    if (count < 2) return;
    // The largest first, so that none is waited for in the end.
    std::stable_sort(works.begin(), works.end(), [](const Work& a, const Work& b) {
      return a.content.size() > b.content.size();
    });
    // Twice as many threads as cores: the last bodies have all cores.
    const int threads = threadCount(settings.flow.threads);
    const int each = std::max(1, 2 * threads / std::min(threads, count));
    parallelFor(threads, count,
                [&](std::ptrdiff_t k) { makeBeside(works[static_cast<std::size_t>(k)], each); });
    for (const Work& work : works)
      if (work.made) say(*work.made);
  }

  bool isSolvedAsImage(const ShapeForm& form) const {
    return !isSoonMade(form, settings) && settings.waterline_subdivisions == 0;
  }

  /// Forms that are images of each other are solved once. What is said of a body may tell places in
  /// it, and so is said of no image.
  SharedBody getImage(const std::string& content, const ShapeForm& form,
                      const std::function<std::string()>& whose) {
    if (!isSolvedAsImage(form)) return getUnit(content, form, whose);
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
  const std::string key = read.kind + contentOf(read.parts);
  if (!store.shapes.has(key)) store.makeExpected();
  return store.shapes.get(key, [&] {
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

void FluidBodyCache::expect(const Expected* expected) noexcept {
  const std::lock_guard<std::mutex> lock(store_->mutex);
  store_->expected.erase(std::this_thread::get_id());
  try {
    if (expected) store_->expected.emplace(std::this_thread::get_id(), expected);
  } catch (const std::bad_alloc&) {  // then one after another
  }
}

SharedBody FluidBodyCache::find(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(store_->mutex);
  const auto found = store_->by_name.find(name);
  return found == store_->by_name.end() ? nullptr : found->second;
}

FluidBodyCache::Counts FluidBodyCache::counts() const { return store_->maker.counts(); }

AMBIENT_END
