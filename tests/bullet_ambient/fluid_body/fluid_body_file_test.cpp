#include "bullet_ambient/fluid_body/file/fluid_body_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <tuple>

#include "preprocess/base/fluid_body_writer.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

using test::refusalOf;

auto fieldsOf(const FluidBody& b) {
  return std::tie(b.name, b.provenance.source, b.provenance.source_hash, b.provenance.settings,
                  b.provenance.generator, b.provenance.said, b.added_mass, b.asymmetry, b.volume,
                  b.area, b.centre_of_volume, b.origin, b.uniform_mass.centre,
                  b.uniform_mass.inertia, b.surface_mass.centre, b.surface_mass.inertia,
                  b.faces.normal_x, b.faces.normal_y, b.faces.normal_z, b.faces.centroid_x,
                  b.faces.centroid_y, b.faces.centroid_z, b.faces.area, b.faces.sharpness,
                  b.surface.vertices, b.surface.triangles, b.form.hull, b.form.faces.sharpness,
                  b.waterline.subdivisions, b.waterline.immersions, b.waterline.corrections,
                  b.viscous.is_primitive);
}

void expectSame(const FluidBody& a, const FluidBody& b) {
  EXPECT_TRUE(fieldsOf(a) == fieldsOf(b)) << a.name;
  EXPECT_EQ(contentHash(a), contentHash(b));
  for (std::size_t i = 0; i < ViscousForm::kNumbers; ++i)
    EXPECT_EQ(*a.viscous.numbers()[i], *b.viscous.numbers()[i]) << i;
  ASSERT_EQ(a.added_mass_parts.size(), b.added_mass_parts.size());
  for (std::size_t i = 0; i < a.added_mass_parts.size(); ++i) {
    EXPECT_EQ(a.added_mass_parts[i].centre, b.added_mass_parts[i].centre);
    EXPECT_EQ(a.added_mass_parts[i].spread, b.added_mass_parts[i].spread);
    EXPECT_EQ(a.added_mass_parts[i].inertia, b.added_mass_parts[i].inertia);
  }
}

std::ptrdiff_t entriesOf(const TemporaryFolder& folder) {
  const auto entries = std::filesystem::directory_iterator(folder.path());
  return std::distance(begin(entries), end(entries));
}

FluidBody bodyWithWaterline() {
  FluidBody body = test::exampleBody();
  body.added_mass_parts = std::vector<AddedMassPart>(1);
  body.waterline = {1, {0.25, 1}, {}};
  for (int i = 0; i < 12; ++i) {
    Matrix6 correction;
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column) correction(row, column) = i - row * column;
    body.waterline.corrections.push_back(correction);
  }
  return body;
}

// Numbers that are kept in single precision are such.
FluidBody bodyWithParts() {
  FluidBody body = test::exampleBody();
  std::vector<AddedMassPart> parts(3);
  for (int i = 0; i < 3; ++i) {
    AddedMassPart& part = parts[static_cast<std::size_t>(i)];
    part.centre = {0.5 + i, -0.25, 2};
    part.spread << 1, 2, 3, 4, 5, 0.125 * i;
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column) part.inertia(row, column) = i + row * column;
  }
  body.added_mass_parts = parts;
  return body;
}

TEST(FluidBodyFile, GivesBackEveryFieldBitForBitInTheSameVersion) {
  const TemporaryFolder folder;
  const FluidBody plain = test::exampleBody();
  const std::string bytes = encodeFluidBody(plain, "a");
  FluidBody sharp = plain, winged = plain;
  for (std::size_t i = 0; i < sharp.faces.size(); ++i)
    sharp.faces.sharpness.push_back(static_cast<double>(1.0f / static_cast<float>(i + 1)));
  winged.form.faces.sharpness[3] = 1.0 / 3;  // that of a wing is not rounded
  for (const FluidBody& body :
       {plain, sharp, winged, test::viscousBody(), bodyWithParts(), bodyWithWaterline()}) {
    writeFluidBody(body, folder / "body.ambient");
    expectSame(readFluidBody(folder / "body.ambient"), body);
    EXPECT_EQ(readText(folder / "body.ambient").substr(0, 16), bytes.substr(0, 16));  // version
  }
  EXPECT_LT(encodeFluidBody(sharp, "a").size(), bytes.size() + 4 * plain.faces.size() + 64);
  EXPECT_LT(encodeFluidBody(bodyWithParts(), "a").size(), bytes.size() + 3 * 120 + 64);
}

TEST(FluidBodyFile, KnowsWhatIsNotPrepared) {
  FluidBody body = test::viscousBody();
  const auto back = [&] { return decodeFluidBody(encodeFluidBody(body, "a"), "a"); };
  EXPECT_TRUE(isPrepared(back()));
  EXPECT_TRUE(back().viscous.isKnown());
  body.form = {};
  body.viscous = {};
  EXPECT_FALSE(isPrepared(back()));
  EXPECT_FALSE(back().viscous.isKnown());
}

TEST(FluidBodyFile, RefusesAPartThatIsNotFinite) {
  FluidBody body = test::exampleBody();
  std::vector<AddedMassPart> parts(1);
  parts[0].centre.x() = std::nan("");
  body.added_mass_parts = parts;
  EXPECT_EQ(test::refusalOf([&] { encodeFluidBody(body, "a"); }),
            "a: centre of a part of the added mass is nan, but must be finite");
}

TEST(FluidBodyFile, RefusesAWaterlineTableThatIsNone) {
  const auto refusal = [](const auto& change) {
    FluidBody body = bodyWithWaterline();
    change(body);
    return test::refusalOf([&] { encodeFluidBody(body, "a"); });
  };
  EXPECT_EQ(refusal([](FluidBody& body) { body.waterline.subdivisions = 65; }),
            "a: the waterline table has 65 subdivisions, but must have 0 to 64");
  EXPECT_EQ(refusal([](FluidBody& body) { body.waterline.immersions[1] = 0.25; }),
            "a: immersion 0.25 of the waterline table must be above 0.25 and below 3");
  EXPECT_EQ(refusal([](FluidBody& body) { body.waterline.immersions[1] = std::nan(""); }),
            "a: immersion nan of the waterline table must be above 0.25 and below 3");
  EXPECT_EQ(refusal([](FluidBody& body) { body.waterline.corrections.pop_back(); }),
            "a: the waterline table has 11 corrections, but needs 12");
  EXPECT_EQ(refusal([](FluidBody& body) { body.waterline.corrections[3](1, 2) = std::nan(""); }),
            "a: a correction of the waterline table is nan, but must be finite");
  EXPECT_EQ(refusal([](FluidBody& body) { body.added_mass_parts = {}; }),
            "a: the waterline table has nothing to correct: there are no parts of the added mass");
}

TEST(FluidBodyFile, HasTheSameBytesForTheSameBody) {
  EXPECT_EQ(encodeFluidBody(test::exampleBody(), "a"), encodeFluidBody(test::exampleBody(), "b"));
  FluidBody other = test::exampleBody();
  other.volume = std::nextafter(other.volume, 1);
  EXPECT_NE(encodeFluidBody(other, "a"), encodeFluidBody(test::exampleBody(), "a"));
}

TEST(FluidBodyFile, KeepsNegativeZeroAndSubnormalNumbers) {
  FluidBody body = test::exampleBody();
  body.volume = -0.0;
  body.asymmetry = 5e-324;
  body.origin.x() = -0.0;
  const FluidBody back = decodeFluidBody(encodeFluidBody(body, "x"), "x");
  EXPECT_TRUE(std::signbit(back.volume));
  EXPECT_TRUE(std::signbit(back.origin.x()));
  EXPECT_EQ(back.asymmetry, 5e-324);
}

TEST(FluidBodyFile, HoldsABodyWithoutFacesAndNames) {
  const FluidBody empty;
  expectSame(decodeFluidBody(encodeFluidBody(empty, "x"), "x"), empty);
}

TEST(FluidBodyFile, IsLittleEndianWithAHeaderOf32Bytes) {
  const std::string bytes = encodeFluidBody(test::exampleBody(), "x");
  EXPECT_EQ(bytes.substr(0, 8),
            "\x89"
            "AMB\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(8, 8), std::string("\1\0\0\0\0\0\0\0", 8));
  std::size_t payload_size = 0;
  for (int i = 7; i >= 0; --i)
    payload_size = payload_size << 8 | static_cast<unsigned char>(bytes[16 + i]);
  EXPECT_EQ(payload_size, bytes.size() - 32);
}

TEST(FluidBodyFile, IsReadFromMemoryThatIsNotAligned) {
  const FluidBody body = test::exampleBody();
  const std::string bytes = encodeFluidBody(body, "x");
  for (std::size_t offset = 1; offset < 8; ++offset) {
    const std::string moved = std::string(offset, '\0') + bytes;
    expectSame(decodeFluidBody(std::string_view(moved).substr(offset), "x"), body);
  }
}

TEST(FluidBodyFile, ReplacesAnOldFileAndLeavesNothingElseBehind) {
  const TemporaryFolder folder;
  const auto file = folder / "body.ambient";
  writeText(file, "old");
  writeFluidBody(test::exampleBody(), file);
  EXPECT_EQ(readText(file), encodeFluidBody(test::exampleBody(), "x"));
  EXPECT_EQ(entriesOf(folder), 1);
}

TEST(FluidBodyFile, IsWrittenThroughSymbolicLinksAndUnderTheLongestNames) {
  const TemporaryFolder folder;
  const auto file = folder / "body.ambient", link = folder / "link.ambient";
  std::filesystem::create_symlink("body.ambient", link);
  writeFluidBody(test::exampleBody(), link);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(readText(file), encodeFluidBody(test::exampleBody(), "x"));
  constexpr std::size_t kLongest = 255;  // bytes of a name on common file systems
  for (std::size_t length = kLongest - 2; length <= kLongest; ++length)
    writeFluidBody(test::exampleBody(), folder / std::string(length, 'a'));
  EXPECT_EQ(entriesOf(folder), 5);
}

TEST(FluidBodyFile, KeepsTheOldFileIfTheBodyIsNotValid) {
  const TemporaryFolder folder;
  const auto file = folder / "body.ambient";
  writeText(file, "old");
  FluidBody broken = test::exampleBody();
  broken.faces.area[3] = -1;
  const std::string refusal = refusalOf([&] { writeFluidBody(broken, file); });
  EXPECT_EQ(refusal, file.string() + ": area of face 3 is -1 m^2, but must not be negative");
  EXPECT_EQ(readText(file), "old");
  EXPECT_EQ(entriesOf(folder), 1);
}

TEST(FluidBodyFile, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  const auto missing = folder / "nowhere/body.ambient";
  EXPECT_EQ(refusalOf([&] { writeFluidBody(test::exampleBody(), missing); }),
            missing.string() + ": cannot be written: No such file or directory");
  const auto inner = folder / "folder";
  std::filesystem::create_directory(inner);
  EXPECT_EQ(refusalOf([&] { writeFluidBody(test::exampleBody(), inner); }),
            inner.string() + ": cannot be written: Is a directory");
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusalOf([&] { writeFluidBody(test::exampleBody(), pipe); }),
            pipe.string() + ": is not a regular file");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(entriesOf(folder), 2);  // no partial file remains
}

TEST(FluidBodyFile, SaysThatItIsMissingOrNoFile) {
  const TemporaryFolder folder;
  const auto missing = folder / "missing.ambient";
  EXPECT_EQ(refusalOf([&] { readFluidBody(missing); }), missing.string() + ": no such file");
  EXPECT_EQ(refusalOf([&] { readFluidBody(folder.path()); }),
            folder.path().string() + ": is a directory, not a .ambient file");
  EXPECT_EQ(refusalOf([] { readFluidBody("/dev/null"); }), "/dev/null: is not a regular file");
}

TEST(FluidBodyFile, SaysThatItIsEmptyForeignOrTruncated) {
  const TemporaryFolder folder;
  const auto file = folder / "f.ambient";
  const auto refusalOfBytes = [&](const std::string& bytes) {
    writeText(file, bytes);
    return refusalOf([&] { readFluidBody(file); });
  };
  const std::string whole = encodeFluidBody(test::exampleBody(), "x");
  const std::string size = std::to_string(whole.size() - 32);
  EXPECT_EQ(refusalOfBytes(""), file.string() + ": the file is empty");
  EXPECT_EQ(refusalOfBytes("v 0 0 0\nv 1 0 0\n"),
            file.string() + ": not a .ambient file: it does not begin with the mark of one");
  EXPECT_EQ(refusalOfBytes(whole.substr(0, 20)),
            file.string() + ": truncated: 20 bytes, but the header alone has 32");
  EXPECT_EQ(refusalOfBytes(whole.substr(0, 1032)),
            file.string() + ": truncated: 1000 bytes follow the header, which announces " + size);
  EXPECT_EQ(refusalOfBytes(whole + "x"), file.string() +
                                             ": damaged: " + std::to_string(whole.size() - 31) +
                                             " bytes follow the header, which announces " + size);
}

TEST(FluidBodyFile, SaysThatItIsOfANewerVersion) {
  std::string bytes = encodeFluidBody(test::exampleBody(), "x");
  bytes[8] = 7;
  EXPECT_EQ(refusalOf([&] { decodeFluidBody(bytes, "f.ambient"); }),
            "f.ambient: format version 7 is newer than this program reads, limit 4");
}

TEST(FluidBodyFile, SaysThatAByteWasChanged) {
  std::string bytes = encodeFluidBody(test::exampleBody(), "x");
  bytes[4711] ^= 1;
  EXPECT_EQ(refusalOf([&] { decodeFluidBody(bytes, "f.ambient"); }),
            "f.ambient: damaged: the checksum of its " + std::to_string(bytes.size() - 32) +
                " byte payload does not match");
}

TEST(FluidBodyFile, KeepsTheRadiusOfASphereInAVersionOfItsOwn) {
  FluidBody body = test::exampleBody();
  const std::string plain = encodeFluidBody(body, "f.ambient");
  body.sphere_radius = 0.1;
  const std::string bytes = encodeFluidBody(body, "f.ambient");
  EXPECT_EQ(plain[8], 1);
  EXPECT_EQ(bytes[8], 3);
  EXPECT_EQ(decodeFluidBody(plain, "f.ambient").sphere_radius, 0);
  EXPECT_EQ(decodeFluidBody(bytes, "f.ambient").sphere_radius, 0.1);
}

}  // namespace
}  // namespace ambient
