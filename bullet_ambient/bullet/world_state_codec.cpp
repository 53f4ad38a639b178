#include <map>

#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/bullet/world_state_faults.h"
#include "bullet_ambient/bullet/world_state_fields.h"
#include "bullet_ambient/fluid_body/content_hash.h"
#include "bullet_ambient/fluid_body/fnv1a.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// Header: magic, version, bytes per number of Bullet, FNV-1a of the payload, payload.
constexpr std::string_view kMagic = "AMBSTATE";
constexpr std::uint32_t kVersion = 7;
constexpr std::size_t kBodySize = 200;  // at least [bytes]

using Hashes = std::map<const FluidBody*, std::uint64_t>;

std::uint64_t hashOf(const FluidBody& fluid_body, Hashes& hashes) {
  const auto [entry, is_new] = hashes.try_emplace(&fluid_body, 0);
  if (is_new) entry->second = contentHash(fluid_body);
  return entry->second;
}

// What decodeState() finds by one name must be one fluid body.
void requireOneContentPerName(const WorldState& state, Hashes& hashes) {
  std::map<std::string, std::uint64_t> named;
  for (const BodyState& body : state.bodies) {
    if (!body.ambient) continue;
    const FluidBody& fluid_body = *body.ambient->def.fluid_body;
    const std::uint64_t hash = hashOf(fluid_body, hashes);
    if (named.try_emplace(fluid_body.name, hash).first->second != hash) {
      throw std::runtime_error("encodeState: two different fluid bodies have the name '" +
                               fluid_body.name + "', by which they are found again; rename one");
    }
  }
}

void writeAmbient(ByteWriter& writer, const AmbientState& ambient, Hashes& hashes) {
  const FluidBody& fluid_body = *ambient.def.fluid_body;
  writer.text(fluid_body.name);
  writer.number(hashOf(fluid_body, hashes));
  transferSettings(writer, ambient.def);
  transferFlight(writer, ambient);
}

std::shared_ptr<const FluidBody> findFluidBody(ByteReader& reader, const FluidBodyLookup& lookup,
                                               Hashes& hashes) {
  std::string name;
  std::uint64_t hash = 0;
  reader.text(name);
  reader.number(hash);
  std::shared_ptr<const FluidBody> found = lookup ? lookup(name) : nullptr;
  if (!found) reader.fail("needs the fluid body '" + name + "', which is not known here");
  if (hashOf(*found, hashes) != hash) {
    reader.fail("was saved with another content of the fluid body '" + name + "'");
  }
  return found;
}

void readBody(ByteReader& reader, BodyState& body, const FluidBodyLookup& lookup, Hashes& hashes) {
  transferBody(reader, body);
  bool has_fluid = false;
  transferFlag(reader, has_fluid);
  if (!has_fluid) return;
  AmbientState& ambient = body.ambient.emplace();
  ambient.def.fluid_body = findFluidBody(reader, lookup, hashes);
  transferSettings(reader, ambient.def);
  transferFlight(reader, ambient);
}

void checkHeader(ByteReader& reader) {
  if (reader.left() < kMagic.size() || reader.take(kMagic.size()) != kMagic) {
    reader.fail("is not one: it does not begin with " + std::string(kMagic));
  }
  std::uint32_t version = 0, number_size = 0;
  std::uint64_t checksum = 0;
  reader.number(version);
  if (version != kVersion) {
    reader.fail("is of version " + std::to_string(version) + ", this program reads version " +
                std::to_string(kVersion));
  }
  reader.number(number_size);
  if (number_size != sizeof(btScalar)) {
    reader.fail("is of a Bullet whose numbers have " + std::to_string(number_size) +
                " bytes, here they have " + std::to_string(sizeof(btScalar)));
  }
  reader.number(checksum);
  ByteReader copy = reader;
  if (fnv1a64(copy.take(copy.left())) != checksum) reader.fail("is cut short or damaged");
}

}  // namespace

std::string encodeState(const WorldState& state) {
  ByteWriter payload;
  Hashes hashes;
  requireOneContentPerName(state, hashes);
  payload.number(static_cast<std::uint32_t>(state.bodies.size()));
  for (const BodyState& body : state.bodies) {
    transferBody(payload, body);
    const bool has_fluid = body.ambient.has_value();
    transferFlag(payload, has_fluid);
    if (has_fluid) writeAmbient(payload, *body.ambient, hashes);
  }
  transferContactsAndJoints(payload, state);
  ByteWriter header;
  header.number(kVersion);
  header.number(static_cast<std::uint32_t>(sizeof(btScalar)));
  header.number(fnv1a64(payload.bytes()));
  return std::string(kMagic) + header.bytes() + payload.bytes();
}

WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup) {
  ByteReader reader(bytes, source);
  checkHeader(reader);
  WorldState state;
  Hashes hashes;
  transferSize(reader, state.bodies, kBodySize);
  for (BodyState& body : state.bodies) readBody(reader, body, lookup, hashes);
  transferContactsAndJoints(reader, state);
  if (reader.left() > 0) reader.fail("has bytes after its end");
  const std::string fault = findFault(state);
  if (!fault.empty()) reader.fail(fault);
  return state;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
