#include "bullet_ambient/fluid_body/file/fluid_body_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "bullet_ambient/base/plain_text.h"

namespace ambient {

namespace {

std::uint64_t littleEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

}  // namespace

FileHeader decodeFileHeader(std::string_view bytes, const std::string& source) {
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(source + ": " + what);
  };
  if (bytes.empty()) fail("the file is empty");
  if (bytes.substr(0, kFileMagic.size()) != kFileMagic.substr(0, bytes.size()))
    fail("not a .ambient file: it does not begin with the mark of one");
  if (bytes.size() < kFileHeaderSize)
    fail("truncated: " + std::to_string(bytes.size()) + " bytes, but the header alone has " +
         std::to_string(kFileHeaderSize));

  FileHeader header;
  header.version = static_cast<std::uint32_t>(littleEndian(bytes.substr(8, 4)));
  header.payload_size = littleEndian(bytes.substr(16, 8));
  header.payload_checksum = littleEndian(bytes.substr(24, 8));
  if (header.version > kFormatVersion)
    fail("format version " + std::to_string(header.version) +
         " is newer than this program reads, limit " + std::to_string(kFormatVersion));
  if (header.version == 0 || littleEndian(bytes.substr(12, 4)) != 0)
    fail("damaged: its header is not valid");
  return header;
}

void checkPayloadSize(const FileHeader& header, std::uint64_t present, const std::string& source) {
  if (header.payload_size > kPayloadLimit)
    throw std::runtime_error(source + ": damaged: a payload of " +
                             std::to_string(header.payload_size) + " bytes is announced, limit " +
                             std::to_string(kPayloadLimit));
  if (present != header.payload_size)
    throw std::runtime_error(
        source + (present < header.payload_size ? ": truncated: " : ": damaged: ") +
        std::to_string(present) + " bytes follow the header, which announces " +
        std::to_string(header.payload_size));
}

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

}  // namespace ambient
