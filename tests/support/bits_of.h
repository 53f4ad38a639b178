#ifndef TESTS_SUPPORT_BITS_OF_H_
#define TESTS_SUPPORT_BITS_OF_H_

#include <cstring>
#include <string>
#include <type_traits>

namespace ambient::test {

/// The bytes of a value without padding, for comparison.
template <class Value>
std::string bitsOf(const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace ambient::test

#endif  // TESTS_SUPPORT_BITS_OF_H_
