#include <gtest/gtest.h>

#include "preprocess/hand_over.h"
#include "tests/preprocess/hand_over/handed_bodies.h"

namespace ambient::test {
namespace {

TEST(Bemio, IsRefusedWithoutHdf5) {
  ExportSettings settings;
  settings.draught = 1;
  try {
    exportFluidBody(sphereBody(1), ExportFormat::kBemio, settings);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "fluid body 'ellipsoid': format bemio needs HDF5, without which this program was "
                 "built (Debian: libhdf5-dev)");
  }
}

}  // namespace
}  // namespace ambient::test
