#include "preprocess/base/output_file.h"

#include <cerrno>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>

namespace ambient {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void failToWrite(const fs::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

/// Random name in the folder of `file`, which no other writer uses, on other machines neither. Its
/// length does not depend on `file`, so that it never exceeds the file system's limit.
fs::path temporaryNameFor(const fs::path& file) {
  std::random_device random;
  return file.parent_path() /
         (".ambient-" + std::to_string(random()) + std::to_string(random()) + ".partial");
}

}  // namespace

fs::path linkTarget(const fs::path& file) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  fs::path target = file;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(target, error)); ++i)
    target = target.parent_path() / fs::read_symlink(target, error);
  return target;
}

OutputFile::OutputFile(const fs::path& file)
    : file_(file), target_(linkTarget(file)), partial_(temporaryNameFor(target_)) {
  std::error_code no_status;
  const fs::file_status status = fs::status(target_, no_status);
  if (fs::is_other(status))
    failToWrite(file, "is not a regular file");  // renaming would replace a device
  errno = 0;
  stream_.open(partial_, std::ios::binary | std::ios::trunc);
  if (!stream_) failToWrite(file, std::string("cannot be written: ") + std::strerror(errno));
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

void OutputFile::write(std::string_view text) {
  errno = 0;
  stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream_ && error_ == 0) error_ = errno;
}

void OutputFile::commit() {
  if (error_ == 0) errno = 0;
  stream_.close();
  if (!stream_)
    failToWrite(file_,
                std::string("cannot be written: ") + std::strerror(error_ == 0 ? errno : error_));
  std::error_code error;
  fs::rename(partial_, target_, error);
  if (error) failToWrite(file_, "cannot be written: " + error.message());
  partial_.clear();
}

void writeFile(const fs::path& file, std::string_view text) {
  OutputFile output(file);
  output.write(text);
  output.commit();
}

}  // namespace ambient
