#include "bullet_ambient/force/load_tables.h"

#include <iterator>

namespace ambient {
namespace {

template <class Map, class Condition>
void eraseIf(Map& map, const Condition& condition) {
  for (auto entry = map.begin(); entry != map.end();)
    entry = condition(entry->second) ? map.erase(entry) : std::next(entry);
}

}  // namespace

std::shared_ptr<const PackedFaces> LoadTables::packedFaces(
    const std::shared_ptr<const FluidBody>& body) {
  if (const auto found = packed_.find(body.get()); found != packed_.end())
    if (auto faces = found->second.faces.lock(); faces && found->second.body.lock() == body)
      return faces;
  eraseIf(packed_, [](const Packed& packed) { return packed.faces.expired(); });
  auto faces = std::make_shared<const PackedFaces>(body->faces);
  packed_[body.get()] = {body, faces};
  return faces;
}

std::shared_ptr<const SphereTable> LoadTables::sphereTable(double separation_cosine) {
  if (const auto found = spheres_.find(separation_cosine); found != spheres_.end())
    return found->second;
  eraseIf(spheres_, [](const auto& table) { return table.use_count() == 1; });
  return spheres_[separation_cosine] = std::make_shared<const SphereTable>(separation_cosine);
}

}  // namespace ambient
