#pragma once

// Vectors of doubles for what is compiled once per instruction set, and may share no inline
// function with the rest of the program. Written with the vector types of GCC and Clang, which have
// the +, -, *, > and ?: of IEEE 754 per lane.

#include "bullet_ambient/force/lane_vectors.h"

namespace ambient {
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 8;
#elif defined(__AVX2__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif

using Doubles = double __attribute__((vector_size(kWidth * sizeof(double))));

inline Doubles load(const double* from) {
  Doubles d;
  __builtin_memcpy(&d, from, sizeof d);
  return d;
}

inline void store(double* to, const Doubles& d) { __builtin_memcpy(to, &d, sizeof d); }

using Vectors = VectorsOf<Doubles>;

}  // namespace
}  // namespace ambient
