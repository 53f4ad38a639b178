// Runs that must reproduce the recorded bits. --record writes the file anew: only for a change that
// means to change results.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/golden/golden_record.h"

namespace ambient::test {

void PrintTo(const GoldenRun& run, std::ostream* stream) { *stream << run.name; }

namespace {

std::string hexadecimal(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

std::string hexadecimal(std::uint64_t value) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::string line(const GoldenRecord& record) {
  std::string text = record.name + " " + hexadecimal(record.hash);
  for (const double value : record.sample) text += " " + hexadecimal(value);
  return text + "\n";
}

GoldenRecord parseRecord(const std::string& text) {
  std::istringstream words(text);
  GoldenRecord record;
  words >> record.name >> std::hex >> record.hash;
  std::string number;  // streams cannot read hexadecimal fractions
  for (double& value : record.sample) {
    words >> number;
    value = std::strtod(number.c_str(), nullptr);
  }
  if (!words) throw std::runtime_error("\"" + text + "\" is not a name, a hash and six numbers");
  return record;
}

// A text file with a line for each run, numbers in hexadecimal.
std::vector<GoldenRecord> readGoldenFile(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::string text;
  std::vector<GoldenRecord> records;
  while (std::getline(stream, text)) {
    try {
      records.push_back(parseRecord(text));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file.string() + ": " + error.what());
    }
  }
  return records;
}

void writeGoldenFile(const std::filesystem::path& file, const std::vector<GoldenRecord>& records) {
  std::ofstream stream(file);
  for (const GoldenRecord& record : records) stream << line(record);
  if (!stream.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

const std::vector<GoldenRecord>& golden() {
  static const std::vector<GoldenRecord> records = readGoldenFile(AMBIENT_GOLDEN_FILE);
  return records;
}

const GoldenRecord* find(const std::string& name) {
  const auto found = std::find_if(golden().begin(), golden().end(),
                                  [&](const GoldenRecord& record) { return record.name == name; });
  return found == golden().end() ? nullptr : &*found;
}

class GoldenRuns : public ::testing::TestWithParam<GoldenRun> {};

TEST_P(GoldenRuns, KeepTheirBits) {
  const GoldenRecord* before = find(GetParam().name);
  ASSERT_NE(before, nullptr) << "not in " << AMBIENT_GOLDEN_FILE << "; record it by --record";
  const GoldenRecord now = GetParam().record();
  const Vector6 change = now.sample - before->sample;
  EXPECT_EQ(now.hash, before->hash)
      << "sample was " << before->sample.transpose() << "\nchange is  " << change.transpose()
      << (change.isZero(0) ? "\nthe difference is elsewhere in the run" : "");
}

INSTANTIATE_TEST_SUITE_P(Recorded, GoldenRuns, ::testing::ValuesIn(goldenRuns()),
                         [](const auto& run) { return run.param.name; });

TEST(GoldenFile, HasTheseRunsOnly) {
  std::string recorded, present;
  for (const GoldenRecord& record : golden()) recorded += record.name + " ";
  for (const GoldenRun& run : goldenRuns()) present += run.name + " ";
  EXPECT_EQ(recorded, present);
}

void recordAll() {
  std::vector<GoldenRecord> records;
  for (const GoldenRun& run : goldenRuns()) {
    records.push_back(run.record());
    records.back().name = run.name;
  }
  writeGoldenFile(AMBIENT_GOLDEN_FILE, records);
}

// Sines and cosines of Bullet come from the C library, whose variants with fused multiply-add
// differ in last bits. Without these variants all machines agree. The library chooses at program
// start: so execv() starts the program anew.
void startWithPlainMathematics(char** argv) {
  constexpr const char* kName = "GLIBC_TUNABLES";
  constexpr const char* kPlain = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F";
  const char* now = std::getenv(kName);
  if (now != nullptr && std::string(now) == kPlain) return;
  setenv(kName, kPlain, 1);
  execv("/proc/self/exe", argv);
  std::perror(argv[0]);
  std::exit(1);
}

}  // namespace
}  // namespace ambient::test

int main(int argc, char** argv) {
  ambient::test::startWithPlainMathematics(argv);
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
