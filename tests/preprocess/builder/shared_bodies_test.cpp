#include <gtest/gtest.h>

#include <memory>
#include <new>

#include "preprocess/builder/body_maker.h"

// Bodies that several callers share, and what could not be made.
namespace ambient::test {
namespace {

TEST(SharedBodies, ThatCouldNotBeMadeAreMadeByTheNextCaller) {
  SharedBodies bodies;
  const auto body = std::make_shared<const FluidBody>();
  EXPECT_THROW(bodies.get("key", []() -> SharedBodies::Body { throw std::bad_alloc(); }),
               std::bad_alloc);
  EXPECT_EQ(bodies.get("key", [&] { return body; }), body);
  EXPECT_EQ(bodies.get("key", [] { return std::make_shared<const FluidBody>(); }), body);
}

}  // namespace
}  // namespace ambient::test
