#include <cstring>
#include <map>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/bullet/state/world_state_fields.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/saved_state.h"

AMBIENT_BEGIN
namespace {

using Hashes = std::map<const FluidBody*, std::uint64_t>;

std::uint64_t hashOf(const FluidBody& fluid_body, Hashes& hashes) {
  const auto [entry, is_new] = hashes.try_emplace(&fluid_body, 0);
  if (is_new) entry->second = contentHash(fluid_body);
  return entry->second;
}

// Appends numbers, texts and names of fluid bodies to bytes, little-endian.
class StateWriter {
 public:
  static constexpr bool kReads = false;

  template <class Number>
  void number(const Number& value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_.push_back(static_cast<char>(bits >> (8 * i)));
  }
  // A fluid body is found by its name; a hash of its content stands beside it.
  void fluidBody(const std::shared_ptr<const FluidBody>& body) {
    AMBIENT_ASSERT(body);
    const std::uint64_t hash = hashOf(*body, hashes_);
    if (named_.try_emplace(body->name, hash).first->second != hash) {
      throw std::runtime_error("encodeState: two different fluid bodies have the name '" +
                               body->name + "', by which they are found again; rename one");
    }
    number(static_cast<std::uint32_t>(body->name.size()));
    bytes_ += body->name;
    number(hash);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  Hashes hashes_;
  std::map<std::string, std::uint64_t> named_;
};

// Reads the bytes of a StateWriter. All functions throw std::runtime_error, beginning with
// `source`, if the bytes end too early.
class StateReader {
 public:
  static constexpr bool kReads = true;

  StateReader(std::string_view bytes, std::string source, const FluidBodyLookup& lookup)
      : bytes_(bytes), source_(std::move(source)), lookup_(lookup) {}

  template <class Number>
  void number(Number& value) {
    const std::string_view raw = take(sizeof value);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(raw[i])) << (8 * i);
    std::memcpy(&value, &bits, sizeof value);
  }
  void fluidBody(std::shared_ptr<const FluidBody>& body) {
    std::uint32_t size = 0;
    std::uint64_t hash = 0;
    number(size);
    const std::string name(take(size));
    number(hash);
    body = lookup_ ? lookup_(name) : nullptr;
    if (!body) fail("needs the fluid body '" + name + "', which is not known here");
    if (hashOf(*body, hashes_) != hash)
      fail("was saved with another content of the fluid body '" + name + "'");
  }
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) fail("is cut short");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string_view left() const { return bytes_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(plainLine(source_ + ": the saved state " + what));
  }

 private:
  std::string_view bytes_;
  std::string source_;
  const FluidBodyLookup& lookup_;
  Hashes hashes_;
};

// transfer(stream, field) is written once for all directions: the stream writes bytes, reads them,
// or checks numbers.

// Transfers a number.
template <class Stream, class Number>
std::enable_if_t<std::is_arithmetic_v<Number>> transfer(Stream& stream, Number& number) {
  stream.number(number);
}

// Transfers a flag as one byte, 0 or 1.
template <class Stream>
void transfer(Stream& stream, bool& flag) {
  auto byte = static_cast<std::uint8_t>(flag);
  stream.number(byte);
  if constexpr (Stream::kReads) {
    if (byte > 1) stream.fail("has a flag that is neither 0 nor 1");
    flag = byte == 1;
  }
}

// Transfers an enumerator as a number of 32 bits.
template <class Stream, class Enum>
std::enable_if_t<std::is_enum_v<Enum>> transfer(Stream& stream, Enum& value) {
  auto number = static_cast<std::int32_t>(value);
  stream.number(number);
  if constexpr (Stream::kReads) value = static_cast<Enum>(number);
}

template <class Stream>
void transfer(Stream& stream, btVector3& v) {
  for (int i = 0; i < 3; ++i) stream.number(v[i]);
  if constexpr (Stream::kReads) v.setW(0);
}

template <class Stream>
void transfer(Stream& stream, btQuaternion& q) {
  for (int i = 0; i < 4; ++i) stream.number(q[i]);
}

template <class Stream>
void transfer(Stream& stream, btTransform& pose) {
  for (int row = 0; row < 3; ++row) transfer(stream, pose.getBasis()[row]);
  transfer(stream, pose.getOrigin());
}

// Transfers a matrix column by column.
template <class Stream, class Matrix>
void transfer(Stream& stream, Eigen::PlainObjectBase<Matrix>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) stream.number(matrix.data()[i]);
}

template <class Stream, std::size_t kSize>
void transfer(Stream& stream, std::array<btScalar, kSize>& numbers) {
  for (btScalar& number : numbers) stream.number(number);
}

// Transfers a length, then each entry by transfer_entry(entry). A reader adds entries one by one
// as their bytes come: a wrong length cannot exhaust memory.
template <class Stream, class Entry, class TransferEntry>
void transferList(Stream& stream, std::vector<Entry>& list, const TransferEntry& transfer_entry) {
  auto size = static_cast<std::uint32_t>(list.size());
  stream.number(size);
  for (std::size_t i = 0; i < size; ++i) {
    if constexpr (Stream::kReads) list.emplace_back();
    transfer_entry(list[i]);
  }
}

template <class Stream>
void transfer(Stream& stream, std::vector<btScalar>& numbers) {
  transferList(stream, numbers, [&stream](btScalar& number) { stream.number(number); });
}

// Visitor that passes fields as bytes to a StateWriter, or from a StateReader.
template <class Stream>
struct Transfer : FieldVisitor, Stream {
  using Stream::Stream, Stream::fluidBody;

  template <class Field, class... Access>
  void operator()(Field& field, const Rule&, const Access&...) {
    transfer<Stream>(*this, field);
  }
  // As one byte; a reader refuses an enumerator that `names` does not have.
  template <class Enum, class Names>
  void choice(Enum& value, const Names& names) {
    auto byte = static_cast<std::uint8_t>(value);
    this->number(byte);
    if constexpr (Stream::kReads) {
      value = static_cast<Enum>(byte);
      if (!wordOf(names, value)) this->fail("has a choice that does not exist");
    }
  }
  template <class State>
  void optional(std::optional<State>& state) {
    bool is_there = state.has_value();
    transfer<Stream>(*this, is_there);
    if (!is_there) return;
    if constexpr (Stream::kReads) state.emplace();
    fields(*this, *state);
  }
  template <class State, class Name>
  void list(std::vector<State>& states, const Name&) {
    transferList<Stream>(*this, states, [this](State& state) { fields(*this, state); });
  }
};

// Header: magic, version, bytes per number of Bullet, FNV-1a of the payload, payload.
constexpr std::string_view kMagic = "AMBSTATE";

void checkHeader(StateReader& reader) {
  if (reader.left().size() < kMagic.size() || reader.take(kMagic.size()) != kMagic) {
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
  if (fnv1a64(reader.left()) != checksum) reader.fail("is cut short or damaged");
}

}  // namespace

std::string encodeState(const WorldState& state) {
  Transfer<StateWriter> payload;
  visit(payload, state);
  StateWriter header;
  header.number(kStateVersion);
  header.number(static_cast<std::uint32_t>(sizeof(btScalar)));
  header.number(fnv1a64(payload.bytes()));
  return std::string(kMagic) + header.bytes() + payload.bytes();
}

WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup) {
  Transfer<StateReader> reader(bytes, source, lookup);
  checkHeader(reader);
  WorldState state;
  fields(reader, state);
  if (!reader.left().empty()) reader.fail("has bytes after its end");
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
