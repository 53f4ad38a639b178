#pragma once

#include <array>
#include <utility>

namespace ambient {

/// Law of the pressure on a face.
enum class PressureLaw {
  kPublished,  ///< of the slip, docs/theory.md eq. (14): Padilla et al. 2025
  kForm,       ///< of the form drag, eq. (43) to (51): for boxes and whatever else has flat sides
};

/// Names of the laws in scenes and commands.
constexpr std::array<std::pair<PressureLaw, const char*>, 2> kPressureLawNames{
    {{PressureLaw::kPublished, "published"}, {PressureLaw::kForm, "form"}}};

}  // namespace ambient
