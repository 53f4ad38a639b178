#include <map>
#include <type_traits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/bullet/core/byte_stream.h"
#include "bullet_ambient/bullet/state/world_state_fields.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/saved_state.h"

AMBIENT_BEGIN
namespace {

// Header: magic, version, bytes per number of Bullet, FNV-1a of the payload, payload.
constexpr std::string_view kMagic = "AMBSTATE";

using Hashes = std::map<const FluidBody*, std::uint64_t>;

std::uint64_t hashOf(const FluidBody& fluid_body, Hashes& hashes) {
  const auto [entry, is_new] = hashes.try_emplace(&fluid_body, 0);
  if (is_new) entry->second = contentHash(fluid_body);
  return entry->second;
}

// Finds fluid bodies by their names; a hash of their content stands beside the name.
class StateWriter : public ByteWriter {
 public:
  void fluidBody(const std::shared_ptr<const FluidBody>& body) {
    AMBIENT_ASSERT(body);
    const std::uint64_t hash = hashOf(*body, hashes_);
    if (named_.try_emplace(body->name, hash).first->second != hash) {
      throw std::runtime_error("encodeState: two different fluid bodies have the name '" +
                               body->name + "', by which they are found again; rename one");
    }
    text(body->name);
    number(hash);
  }

 private:
  Hashes hashes_;
  std::map<std::string, std::uint64_t> named_;
};

class StateReader : public ByteReader {
 public:
  StateReader(std::string_view bytes, const std::string& source, const FluidBodyLookup& lookup)
      : ByteReader(bytes, source), lookup_(lookup) {}

  void fluidBody(std::shared_ptr<const FluidBody>& body) {
    std::string name;
    std::uint64_t hash = 0;
    text(name);
    number(hash);
    body = lookup_ ? lookup_(name) : nullptr;
    if (!body) fail("needs the fluid body '" + name + "', which is not known here");
    if (hashOf(*body, hashes_) != hash)
      fail("was saved with another content of the fluid body '" + name + "'");
  }

 private:
  const FluidBodyLookup& lookup_;
  Hashes hashes_;
};

// Passes fields as bytes to a stream, or from it.
template <class Stream>
struct Transfer : FieldVisitor {
  explicit Transfer(Stream& to_or_from) : stream(to_or_from) {}

  template <class Field, class... Access>
  void operator()(Field& field, const Rule&, const Access&...) {
    transfer(stream, field);
  }
  template <class Enum, class Names>
  void choice(Enum& field, const Names& names) {
    transferChoice(stream, field, names);
  }
  void fluidBody(std::shared_ptr<const FluidBody>& field) { stream.fluidBody(field); }
  template <class State>
  void optional(std::optional<State>& state) {
    if (transferPresence(stream, state)) fields(*this, *state);
  }
  template <class State, class Name>
  void list(std::vector<State>& states, const Name&) {
    transferList(stream, states, [this](State& state) { fields(*this, state); });
  }
  Stream& stream;
};

void checkHeader(ByteReader& reader) {
  if (reader.left() < kMagic.size() || reader.take(kMagic.size()) != kMagic) {
    reader.fail("is not one: it does not begin with " + std::string(kMagic));
  }
  std::uint32_t version = 0, number_size = 0;
  std::uint64_t checksum = 0;
  reader.number(version);
  if (version != kStateVersion) {
    reader.fail("is of version " + std::to_string(version) + ", this program reads version " +
                std::to_string(kStateVersion));
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
  StateWriter payload;
  Transfer<StateWriter> visitor(payload);
  visit(visitor, state);
  ByteWriter header;
  header.number(kStateVersion);
  header.number(static_cast<std::uint32_t>(sizeof(btScalar)));
  header.number(fnv1a64(payload.bytes()));
  return std::string(kMagic) + header.bytes() + payload.bytes();
}

WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup) {
  StateReader reader(bytes, source, lookup);
  checkHeader(reader);
  WorldState state;
  Transfer<StateReader> visitor(reader);
  fields(visitor, state);
  if (reader.left() > 0) reader.fail("has bytes after its end");
  const std::string fault = findFault(state);
  if (!fault.empty()) reader.fail(fault);
  return state;
}

namespace {

// A stream that asks a rule of each number.
struct NumberCheck {
  static constexpr bool kReads = false;
  bool (*holds)(double);
  bool are_passed = true;

  template <class Number>
  void number(const Number& value) {
    are_passed = are_passed && holds(static_cast<double>(value));
  }
};

// Visits fields up to the first fault.
struct FaultFinder : FieldVisitor {
  template <class Field, class... Access>
  void operator()(Field& field, const Rule& rule, const Access&...) {
    if (!fault.empty() || !rule.holds) return;
    NumberCheck numbers{rule.holds};
    transfer(numbers, field);
    if (numbers.are_passed) return;
    fault = rule.fault;
    if constexpr (std::is_arithmetic_v<Field>)
      if (fault.back() == ' ') fault += std::to_string(field);
  }
  template <class State>
  void optional(std::optional<State>& state) {
    if (state) fields(*this, *state);
  }
  template <class State, class Name>
  void list(std::vector<State>& states, const Name& name) {
    for (std::size_t i = 0; i < states.size() && fault.empty(); ++i) {
      fields(*this, states[i]);
      if (!fault.empty()) fault = name(i) + fault;
    }
  }
  template <class Words, class Holds>
  void check(const Words& words, const Holds& holds) {
    if (fault.empty() && !holds()) fault = words;
  }

  std::string fault;
};

}  // namespace

std::string findFault(const WorldState& state) {
  FaultFinder finder;
  visit(finder, state);
  return finder.fault;
}

AMBIENT_END
