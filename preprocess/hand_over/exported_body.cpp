#include "preprocess/hand_over/exported_body.h"

#include "bullet_ambient/base/output_file.h"

namespace ambient {

void ExportedBody::write(const std::filesystem::path& file) const {
  OutputFile output(file);
  output.write(bytes);
  output.commit();
}

}  // namespace ambient
