#include "preprocess/hand_over/number_text.h"

#include <charconv>

namespace ambient {

std::string numberText(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number + 0.0).ptr};  // no -0
}

std::string roundedText(double number, int digits) {
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, number + 0.0, std::chars_format::general, digits)
              .ptr};
}

std::string fixedText(double number, int digits) {
  char text[400];
  const std::string signed_text(
      text, std::to_chars(text, text + sizeof text, number, std::chars_format::fixed, digits).ptr);
  const bool is_zero = signed_text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && signed_text[0] == '-' ? signed_text.substr(1) : signed_text;
}

Matrix6 linearFirst(const Matrix6& rotation_first) {
  Matrix6 K;
  K << rotation_first.bottomRightCorner<3, 3>(), rotation_first.bottomLeftCorner<3, 3>(),
      rotation_first.topRightCorner<3, 3>(), rotation_first.topLeftCorner<3, 3>();
  return K;
}

}  // namespace ambient
