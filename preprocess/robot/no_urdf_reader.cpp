#include "preprocess/mesh/input_error.h"
#include "preprocess/robot/robot_model.h"

namespace ambient {

RobotModel readUrdf(const std::filesystem::path& file, const PackageFolders& packages) {
  return parseUrdf("", file, packages);
}

RobotModel parseUrdf(const std::string&, const std::filesystem::path& file, const PackageFolders&) {
  raiseInputError(file.string(),
                  "URDF files need tinyxml2 (Debian: libtinyxml2-dev), without which this "
                  "was built");
}

}  // namespace ambient
