#include "preprocess/command_line/commands.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {

int buildWorldFile(const BuildArguments& arguments) {
  raiseInputError(arguments.input,
                  "this program was built without Bullet's world importer (Debian: "
                  "libbullet-extras-dev) and reads no .bullet files");
}

}  // namespace ambient
