#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/bullet_ambient/fluid_body/example_body.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_files.h"

namespace ambient {
namespace {

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
