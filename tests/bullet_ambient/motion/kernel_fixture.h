#pragma once

#include <gtest/gtest.h>

#include "bullet_ambient/motion/flight/flight.h"

namespace ambient::test {

/// A kernel of flight for each instruction set; skipped where the processor does not have it.
class FlightKernelTest : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    kernel_ = kFlightKernels.of(GetParam());
    if (!kernel_) GTEST_SKIP() << "this processor does not have the instructions";
  }

  const FlightKernel* kernel_ = nullptr;
};

inline const auto kAllInstructionSets =
    ::testing::Values(InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512);

}  // namespace ambient::test
