#include "tests/golden/golden_record.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/fnv1a.h"

namespace ambient::test {
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

}  // namespace

std::uint64_t GoldenTrace::hash() const { return fnv1a64(bytes_); }

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

}  // namespace ambient::test
