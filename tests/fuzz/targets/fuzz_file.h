#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ambient::test {

/// View of a fuzzer's bytes as text.
inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Calls a reader; a std::runtime_error of one line is a refusal, not a finding.
template <class Reader>
void mayRefuse(const Reader& reader) {
  try {
    reader();
  } catch (const std::runtime_error& error) {
    const std::string_view message = error.what();
    if (message.empty() || message.find('\n') != std::string_view::npos) {
      throw std::logic_error("a refusal is not one line: " + std::string(message));
    }
  }
}

/// A file for readers of files; one name per process, deleted at exit.
class FuzzFile {
 public:
  explicit FuzzFile(const std::string& extension)
      : path_(std::filesystem::temp_directory_path() /
              ("ambient_fuzz_" + std::to_string(::getpid()) + extension)) {}
  ~FuzzFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  const std::filesystem::path& write(std::string_view bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace ambient::test
