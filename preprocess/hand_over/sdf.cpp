#include "preprocess/hand_over/handed_body.h"
#include "preprocess/hand_over/number_text.h"

namespace ambient {
namespace {

std::string element(const std::string& name, double value) {
  return "          <" + name + ">" + numberText(value) + "</" + name + ">\n";
}

// The upper half of a symmetric matrix, an element per entry. Their names are those of the rows and
// columns after a prefix.
std::string elements(const char* prefix, const char* letters, const Matrix6& matrix, int size) {
  std::string text;
  for (int i = 0; i < size; ++i)
    for (int j = i; j < size; ++j)
      text += element(std::string(prefix) + letters[i] + letters[j], matrix(i, j));
  return text;
}

}  // namespace

ExportedBody makeSdf(const HandedBody& body) {
  Matrix6 inertia = Matrix6::Zero();
  inertia.topLeftCorner<3, 3>() = body.inertia;
  return {
      "<?xml version=\"1.0\"?>\n"
      "<sdf version=\"1.10\">\n"
      "  <model name=\"" +
          body.name +
          "\">\n"
          "    <link name=\"" +
          body.name +
          "\">\n"
          "      <inertial>\n"
          "        <pose>" +
          rowText(body.weight.centre) +
          " 0 0 0</pose>\n"
          "        <mass>" +
          numberText(body.weight.mass) +
          "</mass>\n"
          "        <inertia>\n" +
          elements("i", "xyz", inertia, 3) +
          "        </inertia>\n"
          "        <fluid_added_mass>\n" +
          elements("", "xyzpqr", linearFirst(body.added_mass), 6) +
          "        </fluid_added_mass>\n"
          "      </inertial>\n"
          "    </link>\n"
          "  </model>\n"
          "</sdf>\n",
      ""};
}

}  // namespace ambient
