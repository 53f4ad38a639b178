// Runs that give the same bits as when they were recorded. With --record, the file is written anew:
// only a change that means to change results may do that.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/golden/golden_record.h"

namespace ambient::test {

void PrintTo(const GoldenRun& run, std::ostream* stream) { *stream << run.name; }

namespace {

const GoldenFile& golden() {
  static const GoldenFile file = readGoldenFile(AMBIENT_GOLDEN_FILE);
  return file;
}

const GoldenRecord* find(const std::string& name) {
  const auto& records = golden().records;
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const GoldenRecord& record) { return record.name == name; });
  return found == records.end() ? nullptr : &*found;
}

bool isRecordedHere() {
  static const bool is_same = golden().machine == mathHash();
  return is_same;
}

// Where the machine's mathematical functions round differently: what contacts and tumbling plates
// make of that within a second, in Bullet's float or double.
constexpr double kOtherMachine = AMBIENT_GOLDEN_TOLERANCE;

class GoldenRuns : public ::testing::TestWithParam<GoldenRun> {};

TEST_P(GoldenRuns, KeepTheirBits) {
  const GoldenRecord* before = find(GetParam().name);
  ASSERT_NE(before, nullptr) << "not in " << AMBIENT_GOLDEN_FILE << "; record it by --record";
  const GoldenRecord now = GetParam().record();
  const Vector6 change = now.sample - before->sample;
  if (isRecordedHere()) {
    EXPECT_EQ(now.hash, before->hash)
        << "sample was " << before->sample.transpose() << "\nchange is  " << change.transpose()
        << (change.isZero(0) ? "\nthe difference is elsewhere in the run" : "");
  } else {
    std::printf("another machine than the recorded one: compared to %g only\n", kOtherMachine);
    EXPECT_LE(change.norm(), kOtherMachine * before->sample.norm()) << change.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Recorded, GoldenRuns, ::testing::ValuesIn(goldenRuns()),
                         [](const auto& run) { return run.param.name; });

TEST(GoldenFile, HasTheseRunsOnly) {
  std::string recorded, present;
  for (const GoldenRecord& record : golden().records) recorded += record.name + " ";
  for (const GoldenRun& run : goldenRuns()) present += run.name + " ";
  EXPECT_EQ(recorded, present);
}

void recordAll() {
  GoldenFile file;
  file.machine = mathHash();
  for (const GoldenRun& run : goldenRuns()) {
    file.records.push_back(run.record());
    file.records.back().name = run.name;
  }
  writeGoldenFile(AMBIENT_GOLDEN_FILE, file);
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc < 2) return RUN_ALL_TESTS();
  if (argc > 2 || std::string(argv[1]) != "--record") {
    std::fprintf(stderr, "usage: %s [--record]\n", argv[0]);
    return 2;
  }
  try {
    ambient::test::recordAll();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
