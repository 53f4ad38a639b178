#include "preprocess/builder/body_folder.h"

#include <cstdlib>

namespace ambient {
namespace {

std::filesystem::path variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

BodyFolder userBodyFolder() {
  constexpr std::chrono::milliseconds kWorthAFile(50);
  const auto chosen = variable("BULLET_AMBIENT_CACHE"), home = variable("HOME");
  auto cache = variable("XDG_CACHE_HOME");
  if (chosen == "off") return {};
  if (!chosen.empty()) return {chosen, kWorthAFile};
  if (!cache.is_absolute()) cache = home / ".cache";  // as the XDG specification says
  if (!cache.is_absolute()) return {};
  return {cache / "bullet_ambient", kWorthAFile};
}

}  // namespace ambient
