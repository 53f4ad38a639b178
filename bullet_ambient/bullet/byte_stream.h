#pragma once

#include <LinearMath/btTransform.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/fluid_body/plain_text.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

// One function template that passes all fields to a stream serves for both directions.

/// Appends numbers, little-endian.
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

/// Reads them back. @throws std::runtime_error that begins with `source`, in all functions.
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

template <class Stream, class Vector>
void transferVector(Stream& stream, Vector& v) {
  for (int i = 0; i < 3; ++i) stream.number(v[i]);
  if constexpr (Stream::kReads) v.setW(0);
}

template <class Stream, class Transform>
void transferPose(Stream& stream, Transform& pose) {
  for (int row = 0; row < 3; ++row) transferVector(stream, pose.getBasis()[row]);
  transferVector(stream, pose.getOrigin());
}

/// The fields of a matrix of Eigen, column by column.
template <class Stream, class Matrix>
void transferMatrix(Stream& stream, Matrix& matrix) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) stream.number(matrix.data()[i]);
}

/// As one byte, 0 or 1.
template <class Stream, class Bool>
void transferFlag(Stream& stream, Bool& flag) {
  auto byte = static_cast<std::uint8_t>(flag);
  stream.number(byte);
  if constexpr (Stream::kReads) {
    if (byte > 1) stream.fail("has a flag that is neither 0 nor 1");
    flag = byte == 1;
  }
}

/// As one byte, one of those that have a name.
template <class Stream, class Enum, class Names>
void transferEnum(Stream& stream, Enum& value, const Names& names) {
  auto byte = static_cast<std::uint8_t>(value);
  stream.number(byte);
  if constexpr (Stream::kReads) {
    value = static_cast<Enum>(byte);
    for (const auto& [known, name] : names)
      if (known == value) return;
    stream.fail("has a choice that does not exist");
  }
}

/// The length of a list whose entries take at least `entry_size` bytes each.
template <class Stream, class List>
void transferSize(Stream& stream, List& list, std::size_t entry_size) {
  auto size = static_cast<std::uint32_t>(list.size());
  stream.number(size);
  if constexpr (Stream::kReads) {
    if (size > stream.left() / entry_size) stream.fail("is cut short");
    list.resize(size);
  }
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
