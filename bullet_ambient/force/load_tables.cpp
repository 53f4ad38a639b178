#include "bullet_ambient/force/load_tables.h"

#include <iterator>

#include "bullet_ambient/fluid_body/sharpness.h"

namespace ambient {
namespace {

template <class Map, class Condition>
void eraseIf(Map& map, const Condition& condition) {
  for (auto entry = map.begin(); entry != map.end();)
    entry = condition(entry->second) ? map.erase(entry) : std::next(entry);
}

}  // namespace

template <class Source, class Table>
template <class Make>
std::shared_ptr<const Table> LoadTables::Made<Source, Table>::get(
    const std::shared_ptr<const Source>& source, const Make& make) {
  if (const auto found = entries_.find(source.get()); found != entries_.end())
    if (auto table = found->second.table.lock(); table && found->second.source.lock() == source)
      return table;
  eraseIf(entries_, [](const Entry& entry) { return entry.table.expired(); });
  auto table = std::make_shared<const Table>(make());
  entries_[source.get()] = {source, table};
  return table;
}

LoadTables::Faces LoadTables::formFaces(const Body& body) {
  return form_faces_.get(body, [&] { return formLawFaces(*body); });
}

std::shared_ptr<const PackedFaces> LoadTables::packedFaces(const Faces& faces, PressureLaw law) {
  const bool is_form = law == PressureLaw::kForm;
  auto& packed = is_form ? packed_form_ : packed_;
  return packed.get(faces, [&] { return PackedFaces(*faces, is_form); });
}

std::shared_ptr<const PackedHull> LoadTables::hull(const Body& body) {
  return hulls_.get(body, [&] { return PackedHull(*body); });
}

std::shared_ptr<const PackedParts> LoadTables::addedMassParts(const Body& body) {
  return parts_.get(body, [&] { return PackedParts(body->added_mass_parts); });
}

std::shared_ptr<const SphereTable> LoadTables::sphereTable(double separation_cosine) {
  if (const auto found = spheres_.find(separation_cosine); found != spheres_.end())
    return found->second;
  eraseIf(spheres_, [](const auto& table) { return table.use_count() == 1; });
  return spheres_[separation_cosine] = std::make_shared<const SphereTable>(separation_cosine);
}

}  // namespace ambient
