#include "tests/golden/golden_record.h"

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/fluid_body/fnv1a.h"

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

constexpr const char* kMachine = "machine";

std::string line(const GoldenRecord& record) {
  std::string text = record.name + " " + hexadecimal(record.hash);
  for (const double value : record.sample) text += " " + hexadecimal(value);
  return text + "\n";
}

GoldenRecord parseRecord(const std::string& text) {
  std::istringstream words(text);
  GoldenRecord record;
  words >> record.name >> std::hex >> record.hash;
  std::string number;  // streams do not read hexadecimal fractions
  for (double& value : record.sample) {
    words >> number;
    value = std::strtod(number.c_str(), nullptr);
  }
  if (!words) throw std::runtime_error("\"" + text + "\" is not a name, a hash and six numbers");
  return record;
}

}  // namespace

std::uint64_t GoldenTrace::hash() const { return fnv1a64(bytes_); }

GoldenFile readGoldenFile(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string word, text;
  GoldenFile golden;
  if (!(stream >> word >> std::hex >> golden.machine) || word != kMachine)
    throw std::runtime_error(file.string() + ": cannot be read, or begins without its machine");
  std::getline(stream, text);
  while (std::getline(stream, text)) {
    try {
      golden.records.push_back(parseRecord(text));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file.string() + ": " + error.what());
    }
  }
  return golden;
}

void writeGoldenFile(const std::filesystem::path& file, const GoldenFile& golden) {
  std::ofstream stream(file);
  stream << kMachine << " " << hexadecimal(golden.machine) << "\n";
  for (const GoldenRecord& record : golden.records) stream << line(record);
  if (!stream.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

std::uint64_t mathHash() {
  GoldenTrace trace;
  for (int i = 1; i < 2000; ++i) {
    const double x = 0.0137 * i;
    for (const double value :
         {std::sin(x), std::cos(x), std::tan(x), std::exp(-x), std::log(x), std::pow(x, 0.8),
          std::cbrt(x), std::atan2(x, 3.0), std::asin(x / 28), std::acos(x / 28), std::sinh(x),
          std::cosh(x), std::tanh(x), std::expm1(x), std::log1p(x), std::hypot(x, 3.0)})
      trace.add(value);
    const float y = static_cast<float>(x);
    for (const float value : {std::sin(y), std::cos(y), std::tan(y), std::atan2(y, 3.0f),
                              std::acos(y / 28), std::asin(y / 28), std::pow(y, 0.8f)})
      trace.add(value);
  }
  constexpr int kRows = 120, kDepth = 3000;
  Eigen::MatrixXd factor(kRows, kDepth);
  for (int i = 0; i < kRows * kDepth; ++i) factor.data()[i] = 1.0 / (1 + i % 997);
  const Eigen::MatrixXd product = factor * factor.transpose();
  for (int i = 0; i < kRows; ++i) trace.add(product(i, kRows - 1 - i));
  return trace.hash();
}

}  // namespace ambient::test
