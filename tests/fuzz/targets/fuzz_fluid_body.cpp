#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "preprocess/base/fluid_body_writer.h"
#include "tests/fuzz/targets/fuzz_file.h"

namespace ambient::test {
namespace {

// Reads; an accepted body must survive writing and reading unchanged.
void readAndWrite(std::string_view bytes) {
  mayRefuse([&] {
    const FluidBody body = decodeFluidBody(bytes, "fuzz");
    const std::string written = encodeFluidBody(body, "fuzz");
    if (encodeFluidBody(decodeFluidBody(written, "fuzz"), "fuzz") != written) {
      throw std::logic_error("a fluid body changed on its way through a file");
    }
  });
}

// Adds a header with a valid checksum, which nearly every mutation would fail.
void readAsPayload(std::string_view bytes) {
  if (bytes.size() < kFileHeaderSize) return;
  const std::string_view payload = bytes.substr(kFileHeaderSize);
  std::string sealed = encodeFileHeader({kFormatVersion, payload.size(), fnv1a64(payload)});
  sealed += payload;
  readAndWrite(sealed);
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = ambient::test::textOf(data, size);
  ambient::test::readAndWrite(bytes);
  ambient::test::readAsPayload(bytes);
  return 0;
}
