#pragma once

#include <LinearMath/btTransform.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/spatial/vector_types.h"

AMBIENT_BEGIN

// transfer(stream, field) is written once for all directions: the stream writes bytes, reads them,
// or checks numbers.

/// Appends numbers and texts to bytes, little-endian.
class ByteWriter {
 public:
  static constexpr bool kReads = false;

  template <class Number>
  void number(const Number& value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_.push_back(static_cast<char>(bits >> (8 * i)));
    }
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads the bytes of a ByteWriter. All functions throw std::runtime_error, beginning with
/// `source`, if the bytes end too early.
class ByteReader {
 public:
  static constexpr bool kReads = true;

  ByteReader(std::string_view bytes, std::string source)
      : bytes_(bytes), source_(std::move(source)) {}

  template <class Number>
  void number(Number& value) {
    const std::string_view raw = take(sizeof value);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(raw[i])) << (8 * i);
    }
    std::memcpy(&value, &bits, sizeof value);
  }
  void text(std::string& value) {
    std::uint32_t size = 0;
    number(size);
    value = take(size);
  }
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) fail("is cut short");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::size_t left() const { return bytes_.size(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(plainLine(source_ + ": the saved state " + what));
  }

 private:
  std::string_view bytes_;
  std::string source_;
};

/// Transfers a number.
template <class Stream, class Number>
std::enable_if_t<std::is_arithmetic_v<Number>> transfer(Stream& stream, Number& number) {
  stream.number(number);
}

/// Transfers a flag as one byte, 0 or 1.
template <class Stream>
void transfer(Stream& stream, bool& flag) {
  auto byte = static_cast<std::uint8_t>(flag);
  stream.number(byte);
  if constexpr (Stream::kReads) {
    if (byte > 1) stream.fail("has a flag that is neither 0 nor 1");
    flag = byte == 1;
  }
}

/// Transfers an enumerator as a number of 32 bits.
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

/// Transfers a matrix column by column.
template <class Stream, class Matrix>
void transfer(Stream& stream, Eigen::PlainObjectBase<Matrix>& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) stream.number(matrix.data()[i]);
}

template <class Stream, std::size_t kSize>
void transfer(Stream& stream, std::array<btScalar, kSize>& numbers) {
  for (btScalar& number : numbers) stream.number(number);
}

/// Transfers a length, then each entry by transfer_entry(entry). A reader adds entries one by one
/// as their bytes come: a wrong length cannot exhaust memory.
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

/// Transfers whether an optional field has a value; a reader creates the value. Returns true if
/// there is one.
template <class Stream, class Value>
bool transferPresence(Stream& stream, std::optional<Value>& field) {
  bool is_there = field.has_value();
  transfer(stream, is_there);
  if constexpr (Stream::kReads) {
    if (is_there) field.emplace();
  }
  return is_there;
}

/// Transfers an enumerator as one byte; a reader refuses one that `names` does not have.
template <class Stream, class Enum, class Names>
void transferChoice(Stream& stream, Enum& value, const Names& names) {
  auto byte = static_cast<std::uint8_t>(value);
  stream.number(byte);
  if constexpr (Stream::kReads) {
    value = static_cast<Enum>(byte);
    if (!wordOf(names, value)) stream.fail("has a choice that does not exist");
  }
}

AMBIENT_END
