#include "bullet_ambient/bullet/state/world_state_faults.h"

#include <type_traits>

#include "bullet_ambient/bullet/core/byte_stream.h"
#include "bullet_ambient/bullet/state/world_state_fields.h"

AMBIENT_BEGIN
namespace {

// A stream that asks a rule of each number.
struct NumberCheck {
  static constexpr bool kReads = false;
  bool (*holds)(double);
  bool are_passed = true;

  template <class Number>
  void number(const Number& value) {
    are_passed = are_passed && holds(static_cast<double>(value));
  }
};

// Visits fields up to the first fault.
struct FaultFinder : FieldVisitor {
  template <class Field, class... Access>
  void operator()(Field& field, const Rule& rule, const Access&...) {
    if (!fault.empty() || !rule.holds) return;
    NumberCheck numbers{rule.holds};
    transfer(numbers, field);
    if (numbers.are_passed) return;
    fault = rule.fault;
    if constexpr (std::is_arithmetic_v<Field>)
      if (fault.back() == ' ') fault += std::to_string(field);
  }
  template <class State>
  void optional(std::optional<State>& state) {
    if (state) fields(*this, *state);
  }
  template <class State, class Name>
  void list(std::vector<State>& states, const Name& name) {
    for (std::size_t i = 0; i < states.size() && fault.empty(); ++i) {
      fields(*this, states[i]);
      if (!fault.empty()) fault = name(i) + fault;
    }
  }
  template <class Words, class Holds>
  void check(const Words& words, const Holds& holds) {
    if (fault.empty() && !holds()) fault = words;
  }

  std::string fault;
};

}  // namespace

std::string findFault(const WorldState& state) {
  FaultFinder finder;
  visit(finder, state);
  return finder.fault;
}

AMBIENT_END
