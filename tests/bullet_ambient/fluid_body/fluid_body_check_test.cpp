#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns the sentence of checkFluidBody() for the example after a change.
template <class Change>
std::string refusalAfter(const Change& change, FluidBody body = test::exampleBody()) {
  change(body);
  return test::refusalOf([&] { checkFluidBody(body, "b"); });
}

TEST(FluidBodyCheck, PassesTheExample) {
  EXPECT_EQ(refusalAfter([](FluidBody&) {}), "");
}

struct Damage {
  void (*spoil)(FluidBody&);
  const char* says;
};

TEST(FluidBodyCheck, NamesWhatNoBodyHas) {
  const Damage damages[] = {
      {[](FluidBody& b) { b.volume = kNan; }, "volume is nan, but must be finite"},
      {[](FluidBody& b) { b.area = HUGE_VAL; }, "area is inf, but must be finite"},
      {[](FluidBody& b) { b.origin.z() = kNan; }, "origin is nan, but must be finite"},
      {[](FluidBody& b) { b.centre_of_volume.y() = -HUGE_VAL; },
       "centre of volume is -inf, but must be finite"},
      {[](FluidBody& b) { b.added_mass(2, 4) = kNan; }, "added mass is nan, but must be finite"},
      {[](FluidBody& b) { b.uniform_mass.inertia(1, 1) = kNan; },
       "inertia of uniform mass is nan, but must be finite"},
      {[](FluidBody& b) { b.surface_mass.centre.x() = kNan; },
       "centre of surface mass is nan, but must be finite"},
      {[](FluidBody& b) { b.faces.centroid_y[5] = kNan; },
       "face centroid y of entry 5 is nan, but must be finite"},
      {[](FluidBody& b) { b.surface.vertices[7] = HUGE_VAL; },
       "vertex coordinate of entry 7 is inf, but must be finite"},
      {[](FluidBody& b) { b.volume = -0.25; }, "volume is -0.25, but must not be negative"},
      {[](FluidBody& b) { b.area = -1; }, "area is -1, but must not be negative"},
      {[](FluidBody& b) { b.asymmetry = -1; }, "asymmetry is -1, but must not be negative"},
      {[](FluidBody& b) {
         b.faces.normal_x.own()[4] = b.faces.normal_y.own()[4] = b.faces.normal_z.own()[4] = 0;
       },
       "normal of face 4 has length 0, but must be 1 within 1e-09"},
      {[](FluidBody& b) { b.faces.normal_z.own().pop_back(); },
       "face normal z has 79 entries, but there are 80 face areas"},
      {[](FluidBody& b) { b.form.shape.wing = 2; },
       "a share of the form is 2, but must be between 0 and 1"},
      {[](FluidBody& b) { b.form.shape.chord = kNan; },
       "a number of the form is nan, but must be finite"},
      {[](FluidBody& b) { b.form.faces.sharpness.pop_back(); },
       "face sharpness has 1431 entries, but there are 1432 face areas"},
      {[](FluidBody& b) { b.form.hull.own()[4] = 1000; },
       "hull triangle 1 refers to vertex 1000, but there are 42 vertices"},
      {[](FluidBody& b) { b.faces.sharpness.assign(2, 1); },
       "face sharpness has 2 entries, but there are 80 face areas"},
      {[](FluidBody& b) { b.faces.sharpness.assign(80, 2.5); },
       "sharpness of face 0 is 2.5, but must be between 0 and 2"},
      {[](FluidBody& b) { b.surface.triangles.own()[10] = 42; },
       "triangle 3 refers to vertex 42, but there are 42 vertices"},
      {[](FluidBody& b) { b.surface.triangles.own()[10] = -1; },
       "triangle 3 refers to vertex -1, but there are 42 vertices"},
      {[](FluidBody& b) { b.surface.triangles.own().pop_back(); },
       "there are 239 triangle indices, but their number must be a multiple of 3"},
      {[](FluidBody& b) { b.surface.vertices.pop_back(); },
       "there are 125 vertex coordinates, but their number must be a multiple of 3"}};
  for (const auto& [spoil, says] : damages)
    EXPECT_EQ(refusalAfter(spoil), std::string("b: ") + says);
  const Damage beginnings[] = {
      {[](FluidBody& b) { b.added_mass(0, 3) += 1e-6; }, "added mass is not symmetric: off by "},
      {[](FluidBody& b) { b.added_mass(5, 5) = -1e-6; },
       "added mass is not positive semi-definite: lowest eigenvalue "},
      {[](FluidBody& b) { b.uniform_mass.inertia(2, 2) = -1; },
       "inertia of uniform mass is not positive semi-definite"}};
  for (const auto& [spoil, says] : beginnings)
    EXPECT_EQ(refusalAfter(spoil).find(std::string("b: ") + says), 0u) << refusalAfter(spoil);
}

TEST(FluidBodyCheck, NamesWhatNoViscousFormHas) {
  const Damage damages[] = {
      {[](FluidBody& b) { b.viscous.resistance(1, 2) = kNan; },
       "resistance in creeping flow is nan, but must be finite"},
      {[](FluidBody& b) { b.viscous.resistance(0, 3) += 1; },
       "resistance in creeping flow is not symmetric: off by "},
      {[](FluidBody& b) { b.viscous.resistance(3, 3) = -1; },
       "resistance in creeping flow is not positive semi-definite: lowest eigenvalue "},
      {[](FluidBody& b) { b.viscous.sharp_share = kNan; },
       "a number of the viscous form is nan, but must be finite"},
      {[](FluidBody& b) { b.viscous.sharp_share = 1.5; },
       "sharp share is 1.5, but must be between 0 and 1"},
      {[](FluidBody& b) {
         b.viscous.centre_of_reaction = {0, 0, -1.1};
       },
       "distance of the centre of reaction from the middle of the body [m] is 1.1, but must be at "
       "most 1, the radius of the ball around it"},
      {[](FluidBody& b) { b.viscous.resistance.diagonal().tail<3>().setConstant(20); },
       "resistance to translation [m] is 20"},
      {[](FluidBody& b) { b.viscous.resistance.diagonal().head<3>().setConstant(26); },
       "resistance to rotation [m^3] is 26"},
      {[](FluidBody& b) { b.viscous.separation.axes(1, 1) += 0.5; },
       "the axes of separation are off orthonormal by "},
      {[](FluidBody& b) { b.viscous.separation.ways[4].wake_rough = -2; },
       "wake of a separation is -2, but must not be negative"},
      {[](FluidBody& b) { b.viscous.separation.ways[4].wake_bubble = 1e300; },
       "wake of a separation is 1e+300, but must be at most 10000, the square of "},
      {[](FluidBody& b) { b.viscous.separation.ways[2].thickness = 1e4; },
       "thickness of a separation is 10000, but must be at most "},
      {[](FluidBody& b) { b.viscous.separation.ways[3].friction_laminar = 1e300; },
       "friction of a separation on its frontal area [m^2] is "},
      {[](FluidBody& b) { b.viscous.separation.ways[1].thickness = -1; },
       "thickness of a separation is -1, but must not be negative"},
      {[](FluidBody& b) { b.viscous.separation.ways[5].friction_turbulent = -1; },
       "friction of a separation is -1, but must not be negative"},
      {[](FluidBody& b) { b.viscous.separation.smooth_base.z() = 1.25; },
       "smooth share of a base is 1.25, but must be between 0 and 1"},
      {[](FluidBody& b) { b.viscous.surface.frontal.y() = -3; },
       "a frontal area is -3, but must not be negative"},
      {[](FluidBody& b) { b.viscous.surface.frontal.y() = 2; },
       "a frontal area [m^2] is 2, but must be at most 1.375, half of the area"},
      {[](FluidBody& b) { b.viscous.surface.moments.y() = 5; },
       "a mean square of the surface [m^2] is 5, but must be at most 4, that of the farthest"},
      {[](FluidBody& b) { b.viscous.surface.gyration *= 1e9; },
       "trace of the gyration of the surface [m^2] is 1.8e+09, but must be at most 8, "},
      {[](FluidBody& b) { b.viscous.surface.diameter = 2; },
       "diameter of the ball with the area of the surface [m] is 2, but must be at most 1.32"},
      {[](FluidBody& b) { b.viscous.surface.moments.y() = -3; },
       "a mean square of the surface is -3, but must not be negative"},
      {[](FluidBody& b) { b.viscous.surface.gyration(0, 1) += 1; },
       "gyration of the surface is not symmetric: off by "},
      {[](FluidBody& b) { b.viscous.surface.diameter = 0; },
       "diameter of the ball with the area of the surface is 0 m, but must be above 0"}};
  EXPECT_EQ(refusalAfter([](FluidBody&) {}, test::viscousBody()), "");
  for (const auto& [spoil, says] : damages) {
    const std::string refusal = refusalAfter(spoil, test::viscousBody());
    EXPECT_EQ(refusal.find(std::string("b: ") + says), 0u) << refusal;
  }
}

TEST(FluidBodyCheck, RefusesPlacesBeyondAnyBody) {
  const auto place = [](const std::string& what, const std::string& distance) {
    return "b: " + what + " lies " + distance +
           " m from the origin, limit 1e+12 times the size of the body of 2 m";
  };
  const auto refusal = [](const auto& change) {
    return refusalAfter([&](FluidBody& b) {
      b.area = 4;
      b.volume = 1;
      change(b);
    });
  };
  EXPECT_EQ(refusal([](FluidBody& b) { b.centre_of_volume.x() = 2e108; }),
            place("centre of volume", "2e+108"));
  EXPECT_EQ(refusal([](FluidBody& b) { b.uniform_mass.centre.y() = -5e80; }),
            place("centre of uniform mass", "5e+80"));
  EXPECT_EQ(refusal([](FluidBody& b) { b.surface_mass.centre.z() = 2.5e12; }),
            place("centre of surface mass", "2.5e+12"));
  EXPECT_EQ(refusal([](FluidBody& b) { b.faces.centroid_y[1] = 1e300; }),
            place("centroid of a face", "1e+300"));
  EXPECT_EQ(refusal([](FluidBody& b) { b.centre_of_volume.x() = 1.9e12; }), "");
}

TEST(FluidBodyCheck, SeesANegativeMassBesideTheLargeMomentsOfALargeBody) {
  FluidBody body = test::exampleBody();
  body.added_mass.setZero();
  body.added_mass.diagonal() << 1e30, 1e30, 1e30, 1e18, 1e18, -1e14;
  EXPECT_NE(test::refusalOf([&] { checkFluidBody(body, "b"); }).find("not positive semi-definite"),
            std::string::npos);
}

TEST(FluidBodyCheck, AllowsForTheRoundingOfBodiesOfAnySize) {
  for (const double s : {1e-6, 1.0, 1e6}) {
    FluidBody body = test::exampleBody();
    Vector6 scales;
    scales << s, s, s, 1, 1, 1;
    // Translation is singular to rounding, as for a body of revolution without thickness.
    Vector6 diagonal;
    diagonal << 1, 1, -1e-16, 1, 1, -1e-16;
    body.added_mass =
        s * s * s * Matrix6((scales.cwiseProduct(scales).cwiseProduct(diagonal)).asDiagonal());
    body.added_mass(0, 4) = 1e-16 * s * s * s * s;
    EXPECT_EQ(test::refusalOf([&] { checkFluidBody(body, "b"); }), "") << s;
  }
}

/// Adds a header that matches any payload, as an attacker could.
std::string withMatchingHeader(const std::string& payload) {
  return encodeFileHeader({kFormatVersion, payload.size(), fnv1a64(payload)}) + payload;
}

/// Reads arbitrary bytes; returns true if accepted. Expects a valid body or a sentence, and memory
/// of a few copies at most.
bool survives(const std::string& bytes) {
  const std::size_t before = test::allocatedBytes();
  bool read = true;
  FluidBody body;
  try {
    body = decodeFluidBody(bytes, "f.ambient");
  } catch (const std::runtime_error& error) {
    read = false;
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("f.ambient: ", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  // Nine arrays and four texts at most; each could claim the size of the whole payload.
  EXPECT_LT(test::allocatedBytes() - before, 20 * bytes.size() + 16384);
  if (read) {
    EXPECT_NO_THROW(checkFluidBody(body, "f.ambient"));
  }
  return read;
}

TEST(DamagedFile, IsRefusedWithEverySingleBitFlipped) {
  const std::string whole = encodeFluidBody(test::exampleBody(0), "x");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
    ASSERT_FALSE(survives(bytes)) << i;
  }
}

TEST(DamagedFile, IsRefusedWhereverItIsCutOff) {
  const std::string whole = encodeFluidBody(test::exampleBody(0), "x");
  for (std::size_t size = 0; size < whole.size(); ++size)
    ASSERT_FALSE(survives(whole.substr(0, size))) << size;
}

TEST(DamagedFile, CutOffWithAMatchingChecksumNeverCrashes) {
  const std::string payload = encodeFluidBody(test::exampleBody(0), "x").substr(kFileHeaderSize);
  for (std::size_t size = 0; size < payload.size(); ++size)
    survives(withMatchingHeader(payload.substr(0, size)));
}

TEST(DamagedFile, ChangedWithAMatchingChecksumNeverCrashes) {
  const std::string payload = encodeFluidBody(test::exampleBody(0), "x").substr(kFileHeaderSize);
  std::mt19937 engine(1);
  int refused = 0;
  constexpr int kFiles = 20000;
  // Sizes and offsets that tend to break readers, in addition to random ones.
  const std::uint32_t nasty[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffff8, 0x10000000};
  for (int i = 0; i < kFiles; ++i) {
    std::string bytes = payload;
    const int changes = 1 + static_cast<int>(engine() % 4);
    for (int change = 0; change < changes; ++change) {
      const std::size_t at = engine() % (bytes.size() - 4);
      if (engine() % 2 == 0) {
        bytes[at] = static_cast<char>(engine());
      } else {
        const std::uint32_t word = nasty[engine() % 7];
        bytes.replace(at & ~std::size_t{3}, 4, reinterpret_cast<const char*>(&word), 4);
      }
    }
    refused += !survives(withMatchingHeader(bytes));
  }
  EXPECT_GT(refused, kFiles / 2);  // most changes hit a checked number or a table
}

TEST(DamagedFile, ChangedInItsTablesWithAMatchingChecksumNeverCrashes) {
  // Changes every 32-bit word once: sizes, offsets and vtables are words.
  const std::string payload = encodeFluidBody(test::exampleBody(0), "x").substr(kFileHeaderSize);
  for (const std::uint32_t word : {0u, 1u, 0x7fffffffu, 0xffffffffu, 0x00010001u})
    for (std::size_t at = 0; at + 4 <= payload.size(); at += 4) {
      std::string bytes = payload;
      bytes.replace(at, 4, reinterpret_cast<const char*>(&word), 4);
      survives(withMatchingHeader(bytes));
    }
}

TEST(DamagedFile, OfArbitraryBytesIsRefused) {
  std::mt19937 engine(2);
  for (int i = 0; i < 5000; ++i) {
    std::string payload(engine() % 400, '\0');
    for (char& byte : payload) byte = static_cast<char>(engine());
    ASSERT_FALSE(survives(payload));
    ASSERT_FALSE(survives(withMatchingHeader(payload)));
  }
}

TEST(DamagedFile, ThatAnnouncesAHugePayloadAllocatesNothingForIt) {
  const TemporaryFolder folder;
  for (const std::uint64_t size : {std::uint64_t{1} << 31, std::uint64_t{1} << 40,
                                   std::numeric_limits<std::uint64_t>::max()}) {
    const auto file = folder / "huge.ambient";
    writeText(file, encodeFileHeader({kFormatVersion, size, 0}));
    const std::size_t before = test::allocatedBytes();
    EXPECT_EQ(test::refusalOf([&] { readFluidBody(file); }),
              file.string() + ": damaged: a payload of " + std::to_string(size) +
                  " bytes is announced, limit " + std::to_string(kPayloadLimit));
    EXPECT_LT(test::allocatedBytes() - before, 100000u);
  }
}

TEST(DamagedFile, OfGreatSizeIsRefusedBeforeItIsRead) {
  // Sparse file: uses no disk space.
  const TemporaryFolder folder;
  const auto file = folder / "large.ambient";
  writeText(file, "no mark");
  std::filesystem::resize_file(file, std::uintmax_t{1} << 36);
  const std::size_t before = test::allocatedBytes();
  EXPECT_NE(test::refusalOf([&] { readFluidBody(file); }).find("not a .ambient file"),
            std::string::npos);
  EXPECT_LT(test::allocatedBytes() - before, 100000u);
}

}  // namespace
}  // namespace ambient
