#include "preprocess/hand_over/export_fluid_body.h"

#include <stdexcept>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/output_file.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

ExportFormat exportFormatOf(const std::string& name) {
  if (const auto format = valueOf(kExportFormatNames, name)) return *format;
  throw std::invalid_argument("\"" + name + "\" is none of sdf, mjcf, fossen");
}

void ExportedBody::write(const std::filesystem::path& file) const { writeFile(file, bytes); }

ExportedBody exportFluidBody(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                             const ExportSettings& settings) {
  if (settings.speed && format != ExportFormat::kFossen)
    reject(*body, "speed [m/s]", *settings.speed, "given for fossen only");
  const HandedBody handed = handedBody(body, settings);
  switch (format) {
    case ExportFormat::kSdf:
      return makeSdf(handed);
    case ExportFormat::kMjcf:
      return makeMjcf(handed);
    case ExportFormat::kFossen:
      return makeFossen(handed);
  }
  AMBIENT_ASSERT(false);
  return {};
}

}  // namespace ambient
