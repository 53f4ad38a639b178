#include <cmath>
#include <map>

#include "bullet_ambient/bullet/world_state.h"
#include "bullet_ambient/bullet/world_state_fields.h"
#include "bullet_ambient/fluid_body/content_hash.h"
#include "bullet_ambient/fluid_body/fnv1a.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// Header: magic, version, bytes per number of Bullet, FNV-1a of the payload, payload.
constexpr std::string_view kMagic = "AMBSTATE";
constexpr std::uint32_t kVersion = 6;
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

template <class... Parts>
bool areFinite(const Parts&... parts) {
  return (parts.allFinite() && ...);
}

void checkAmbient(const ByteReader& reader, const AmbientState& ambient) {
  const FlightMemory& memory = ambient.memory;
  const WaveMemory& waves = ambient.waves;
  if (!areFinite(waves.tilt_W[0], waves.tilt_W[1]) || !std::isfinite(waves.heave[0]) ||
      !std::isfinite(waves.heave[1]) || !std::isfinite(waves.energy())) {
    reader.fail("has waves whose numbers are not finite");
  }
  if (!areFinite(memory.load_W.torque, memory.load_W.force, ambient.left_W.angular,
                 ambient.left_W.linear) ||
      !std::isfinite(memory.substep)) {
    reader.fail("has a flight whose numbers are not finite");
  }
}

bool isFinite(const btVector3& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

bool isFinite(const btTransform& pose) {
  return isFinite(pose.getOrigin()) && isFinite(pose.getBasis()[0]) &&
         isFinite(pose.getBasis()[1]) && isFinite(pose.getBasis()[2]);
}

void checkBody(const ByteReader& reader, const BodyState& body) {
  if (!isFinite(body.pose) || !isFinite(body.interpolation_pose) ||
      !isFinite(body.linear_velocity) || !isFinite(body.angular_velocity) ||
      !isFinite(body.interpolation_linear_velocity) ||
      !isFinite(body.interpolation_angular_velocity)) {
    reader.fail("has a body whose pose or velocity is not finite");
  }
  if (body.activation_state < ACTIVE_TAG || body.activation_state > FIXED_BASE_MULTI_BODY) {
    reader.fail("has a body of an unknown activation state");
  }
  if (!(body.inverse_mass >= 0) || !std::isfinite(body.inverse_mass)) {
    reader.fail("has a body whose inverse mass is negative or not finite");
  }
}

void checkPair(const ByteReader& reader, const PairState& pair) {
  if (pair.object_a < 0 || pair.object_b < 0) reader.fail("has a contact without an object");
}

void checkContact(const ByteReader& reader, const ContactState& contact) {
  checkPair(reader, contact.pair);
  if (contact.points.size() > MANIFOLD_CACHE_SIZE) {
    reader.fail("has a contact of more than " + std::to_string(MANIFOLD_CACHE_SIZE) + " points");
  }
}

void readBody(ByteReader& reader, BodyState& body, const FluidBodyLookup& lookup, Hashes& hashes) {
  transferBody(reader, body);
  checkBody(reader, body);
  bool has_fluid = false;
  transferFlag(reader, has_fluid);
  if (!has_fluid) return;
  AmbientState& ambient = body.ambient.emplace();
  ambient.def.fluid_body = findFluidBody(reader, lookup, hashes);
  transferSettings(reader, ambient.def);
  transferFlight(reader, ambient);
  checkAmbient(reader, ambient);
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
  for (const PairState& pair : state.pairs) checkPair(reader, pair);
  for (const ContactState& contact : state.contacts) checkContact(reader, contact);
  if (!std::isfinite(state.time)) reader.fail("has a time that is not finite");
  if (reader.left() > 0) reader.fail("has bytes after its end");
  return state;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
