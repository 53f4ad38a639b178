#include "bullet_ambient/base/plain_text.h"

#include <cstdio>
#include <cstdlib>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

unsigned codeAt(const std::string& text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Bytes of the control character at i, 0 if there is none: ASCII controls and U+0080 to U+009F.
std::size_t controlSize(const std::string& text, std::size_t i) {
  const unsigned first = codeAt(text, i), second = codeAt(text, i + 1);
  if (first == 0xc2 && second >= 0x80 && second < 0xa0) return 2;
  return first < 0x20 || first == 0x7f ? 1 : 0;
}

std::string withLineEnds(const std::string& text, const char* line_end) {
  std::string plain;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = controlSize(text, i);
    if (size == 0) {
      plain += text[i++];
      continue;
    }
    plain += text[i] == '\n' ? line_end : "?";
    i += size;
  }
  return plain;
}

}  // namespace

std::string plainText(const std::string& text) { return withLineEnds(text, "\n"); }

std::string plainLine(const std::string& text) { return withLineEnds(text, "\\n"); }

void failAssert(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "bullet_ambient: %s:%d: this must hold: %s\n", file, line, condition);
  std::abort();
}

}  // namespace ambient
