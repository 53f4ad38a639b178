#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "bullet_ambient/saved_state.h"

namespace ambient::test {

/// A world that is saved and restored: its fluid, and one step of it.
struct SavedRun {
  Fluid& fluid;
  std::function<void()> step;
};

/// Bytes of all that moves, without Bullet's pairs and contacts.
inline std::string motionBytes(const Fluid& fluid) {
  WorldState state = fluid.save();
  state.pairs.clear();
  state.contacts.clear();
  return encodeState(state);
}

/// Bytes of the motion after each step.
inline std::vector<std::string> record(const SavedRun& run, int steps) {
  std::vector<std::string> motions;
  for (int i = 0; i < steps; ++i) {
    run.step();
    motions.push_back(motionBytes(run.fluid));
  }
  return motions;
}

inline void expectSameMotion(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_TRUE(a[i] == b[i]) << "bits differ after step " << i + 1;
}

/// Expects that `other`, restored from the bytes of a state of `run`, goes on as that bit for bit.
/// `other` is `run` itself, or a world that was built by the same code.
inline void expectGoesOn(const SavedRun& run, const SavedRun& other, const FluidBodyLookup& lookup,
                         int steps) {
  const std::string bytes = encodeState(run.fluid.save()), motion = motionBytes(run.fluid);
  const double time = run.fluid.time();
  const auto motions = record(run, steps);
  other.fluid.restore(decodeState(bytes, "bytes", lookup));
  EXPECT_TRUE(motionBytes(other.fluid) == motion);
  EXPECT_EQ(other.fluid.time(), time);
  expectSameMotion(motions, record(other, steps));
}

/// Knows one fluid body alone.
inline FluidBodyLookup lookupOf(std::shared_ptr<const FluidBody> shape) {
  return [shape](const std::string&) { return shape; };
}

}  // namespace ambient::test
