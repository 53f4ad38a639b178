#include "bullet_ambient/fluid_body/file/fluid_body_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "bullet_ambient/base/output_file.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file_header.h"
#include "bullet_ambient/fluid_body/file/load_fluid_body.h"

namespace ambient {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw std::runtime_error(plainLine(file.string() + ": " + what));
}

std::uint64_t sizeOfRegularFile(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) fail(file, "no such file");
  if (error) fail(file, "cannot be read: " + error.message());
  if (fs::is_directory(status)) fail(file, "is a directory, not a .ambient file");
  if (!fs::is_regular_file(status)) fail(file, "is not a regular file");
  const std::uint64_t size = fs::file_size(file, error);
  if (error) fail(file, "cannot be read: " + error.message());
  return size;
}

std::string readBytes(const fs::path& file) {
  const std::uint64_t size = sizeOfRegularFile(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, std::string("cannot be opened: ") + std::strerror(errno));

  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(size, kFileHeaderSize)), '\0');
  const auto read = [&](std::size_t from) {
    stream.read(bytes.data() + from, static_cast<std::streamsize>(bytes.size() - from));
    bytes.resize(from + static_cast<std::size_t>(stream.gcount()));
  };
  read(0);
  // The whole file is allocated only after the header has been checked.
  const FileHeader header = decodeFileHeader(bytes, file.string());
  checkPayloadSize(header, size - kFileHeaderSize, file.string());
  bytes.resize(static_cast<std::size_t>(size));
  read(kFileHeaderSize);
  return bytes;
}

}  // namespace

FluidBody readFluidBody(const fs::path& file) {
  return decodeFluidBody(readBytes(file), file.string());
}

std::shared_ptr<const FluidBody> loadFluidBody(const std::string& file) {
  return std::make_shared<FluidBody>(readFluidBody(file));
}

void writeFluidBody(const FluidBody& body, const fs::path& file) {
  writeFile(file, encodeFluidBody(body, file.string()));
}

}  // namespace ambient
