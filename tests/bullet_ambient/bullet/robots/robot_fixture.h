#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {

/// A world for robots in fluid, and what the fluid says of them.
class Robots : public testing::Test {
 protected:
  Robots() {
    world.fluid.setReport([this](const std::string& text) { heard.push_back(text); });
  }
  btMultiBody& add(const RobotDef& def = {}) { return world.add(arbitrary, def); }
  AttachDef fluidOf(const btMultiBody& body, int link) {
    return coupledFluid(arbitrary, body, link, 2);
  }
  std::string refusal(btMultiBody& body, int link, const AttachDef& def) {
    return refusalOf<std::invalid_argument>([&] { world.fluid.add(body, link, def); });
  }

  std::vector<std::string> heard;
  Arbitrary arbitrary{5};
  RobotWorld world;
};

}  // namespace ambient::test
