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
constexpr std::uint32_t kVersion = 9;
constexpr std::size_t kBodySize = 200, kMultiBodySize = 100;  // at least [bytes]

using Hashes = std::map<const FluidBody*, std::uint64_t>;

std::uint64_t hashOf(const FluidBody& fluid_body, Hashes& hashes) {
  const auto [entry, is_new] = hashes.try_emplace(&fluid_body, 0);
  if (is_new) entry->second = contentHash(fluid_body);
  return entry->second;
}

// What decodeState() finds by one name must be one fluid body.
void requireOneContentPerName(const WorldState& state, Hashes& hashes) {
  std::map<std::string, std::uint64_t> named;
  const auto require = [&](const AmbientState& ambient) {
    const FluidBody& fluid_body = *ambient.def.fluid_body;
    const std::uint64_t hash = hashOf(fluid_body, hashes);
    if (named.try_emplace(fluid_body.name, hash).first->second != hash) {
      throw std::runtime_error("encodeState: two different fluid bodies have the name '" +
                               fluid_body.name + "', by which they are found again; rename one");
    }
  };
  for (const BodyState& body : state.bodies)
    if (body.ambient) require(*body.ambient);
  for (const MultiBodyState& body : state.multi_bodies)
    for (const LinkFluidState& fluid : body.fluids) require(fluid.ambient);
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

AmbientState readAmbient(ByteReader& reader, const FluidBodyLookup& lookup, Hashes& hashes) {
  AmbientState ambient;
  ambient.def.fluid_body = findFluidBody(reader, lookup, hashes);
  transferSettings(reader, ambient.def);
  transferFlight(reader, ambient);
  return ambient;
}

void readBody(ByteReader& reader, BodyState& body, const FluidBodyLookup& lookup, Hashes& hashes) {
  transferBody(reader, body);
  if (transferPresence(reader, body.ambient)) body.ambient = readAmbient(reader, lookup, hashes);
}

void readMultiBody(ByteReader& reader, MultiBodyState& body, const FluidBodyLookup& lookup,
                   Hashes& hashes) {
  transferMultiBody(reader, body);
  transferSize(reader, body.fluids, kLinkFluidSize);
  for (LinkFluidState& fluid : body.fluids) {
    transferLinkFluid(reader, fluid);
    fluid.ambient = readAmbient(reader, lookup, hashes);
  }
}

void writeMultiBody(ByteWriter& writer, const MultiBodyState& body, Hashes& hashes) {
  transferMultiBody(writer, body);
  transferSize(writer, body.fluids, kLinkFluidSize);
  for (const LinkFluidState& fluid : body.fluids) {
    transferLinkFluid(writer, fluid);
    writeAmbient(writer, fluid.ambient, hashes);
  }
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
    if (transferPresence(payload, body.ambient)) writeAmbient(payload, *body.ambient, hashes);
  }
  transferSize(payload, state.multi_bodies, kMultiBodySize);
  for (const MultiBodyState& body : state.multi_bodies) writeMultiBody(payload, body, hashes);
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
  transferSize(reader, state.multi_bodies, kMultiBodySize);
  for (MultiBodyState& body : state.multi_bodies) readMultiBody(reader, body, lookup, hashes);
  transferContactsAndJoints(reader, state);
  if (reader.left() > 0) reader.fail("has bytes after its end");
  const std::string fault = findFault(state);
  if (!fault.empty()) reader.fail(fault);
  return state;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
