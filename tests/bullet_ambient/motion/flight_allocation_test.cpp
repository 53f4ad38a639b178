#include <gtest/gtest.h>

#include "bullet_ambient/motion/rows/row_velocity.h"
#include "demos/integrators/integrators.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"

namespace ambient {
namespace {

using test::FreeBody;

TEST(Flight, AllocatesNothing) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  FreeBody body({test::meshedEllipsoid(semi_axes, 1), {10, Matrix3::Identity()}, water(), {2.0}});
  body.setGravity({0, 0, -9.81});
  for (const double spin : {1.0, 1e3, 1e5}) {
    for (const OwnFlight integrator : std::initializer_list<OwnFlight>{nullptr, flyRungeKutta}) {
      body.state.twist = {{spin, 2, 3}, {1, 2, 3}};
      body.settings = {1e-3, 16, integrator};
      const std::size_t before = test::allocationCount();
      body.advance(1.0 / 60, 3);
      EXPECT_EQ(test::allocationCount(), before);
    }
  }
}

TEST(RowVelocity, AllocatesNothing) {
  const Vector3 semi_axes(0.3, 0.2, 0.1);
  FreeBody body({test::meshedEllipsoid(semi_axes, 1), {10, Matrix3::Identity()}, water(), {2.0}});
  for (const double spin : {1.0, 1e3}) {
    body.state.twist = {{spin, 2, 3}, {1, 2, 3}};
    const std::size_t before = test::allocationCount();
    computeRowVelocity({body.model(), body.surroundings, body.settings, 1.0 / 60}, body.state);
    EXPECT_EQ(test::allocationCount(), before);
  }
}

}  // namespace
}  // namespace ambient
