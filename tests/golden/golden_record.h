#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient::test {

/// Results kept from a run.
struct GoldenRecord {
  std::string name;
  std::uint64_t hash = 0;            ///< FNV-1a of the bytes of all numbers traced
  Vector6 sample = Vector6::Zero();  ///< some of these numbers, shows the size of a difference
};

/// Collects the numbers of a run.
class GoldenTrace {
 public:
  template <class Number>
  void add(const Number& number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void add(const Vector3& vector) {
    for (int i = 0; i < 3; ++i) add(vector[i]);
  }
  std::uint64_t hash() const { return fnv1a64(bytes_); }

 private:
  std::string bytes_;
};

/// A run with results that must stay the same to the bit.
struct GoldenRun {
  std::string name;
  std::function<GoldenRecord()> record;  ///< may leave the record's name empty
};

/// Returns the runs of a program; each program defines this function.
std::vector<GoldenRun> goldenRuns();

}  // namespace ambient::test
