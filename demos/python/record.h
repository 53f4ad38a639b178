#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

// Converts fields for Python: vectors to immutable tuples. Overloads for enumerations, in
// settings.cpp, convert to words.

template <class Value>
pybind11::object toPython(const Value& value) {
  return pybind11::cast(value);
}
inline pybind11::object toPython(const Vector3& v) {
  return pybind11::make_tuple(v.x(), v.y(), v.z());
}

template <class Value>
void fromPython(pybind11::handle from, Value& to) {
  to = from.cast<Value>();
}
inline void fromPython(pybind11::handle from, Vector3& to) {
  const auto numbers = from.cast<std::vector<double>>();
  if (numbers.size() != 3) throw pybind11::cast_error();
  to = Vector3(numbers[0], numbers[1], numbers[2]);
}

/// Binds a struct of settings as an immutable Python class: keyword-only constructor with the
/// struct's defaults, equality, hash, repr, pickle. Call field() once per member.
template <class T>
class Record {
 public:
  Record(pybind11::module_& module, const char* name, const char* doc)
      : name_(name), class_(module, name, doc) {
    namespace py = pybind11;
    class_
        .def(py::init([name](const py::args& unnamed, const py::kwargs& given) {
          return make(name, unnamed, given);
        }))
        .def("__repr__", [name](const T& self) { return repr(name, self); })
        .def("__hash__", [](const T& self) { return py::hash(values(self)); })
        .def(
            "__eq__",
            [](const T& self, const T& other) { return values(self).equal(values(other)); },
            py::is_operator())
        .def(py::pickle([](const T& self) { return values(self); },
                        [](const py::tuple& state) { return fromValues(state); }));
  }

  template <class Value>
  Record& field(const char* name, Value T::*member, const char* doc) {
    const std::string full = name_ + "." + name;
    fields().push_back({name, [member](const T& self) { return toPython(self.*member); },
                        [member, full](T& self, pybind11::handle value) {
                          try {
                            fromPython(value, self.*member);
                          } catch (const pybind11::cast_error&) {
                            throw pybind11::type_error(full + " cannot be " +
                                                       pybind11::repr(value).cast<std::string>());
                          }
                        }});
    class_.def_property_readonly(name, fields().back().get, doc);
    return *this;
  }

  /// Calls check for each new object; what it throws refuses the object.
  Record& checkedBy(void (*check)(const T&)) {
    checks().push_back(check);
    return *this;
  }

 private:
  struct Field {
    std::string name;
    std::function<pybind11::object(const T&)> get;
    std::function<void(T&, pybind11::handle)> set;
  };

  static std::vector<Field>& fields() {
    static std::vector<Field> all;
    return all;
  }

  static std::vector<void (*)(const T&)>& checks() {
    static std::vector<void (*)(const T&)> all;
    return all;
  }

  static T checked(const T& made) {
    for (const auto check : checks()) check(made);
    return made;
  }

  static T make(const char* name, const pybind11::args& unnamed, const pybind11::kwargs& given) {
    if (!unnamed.empty())
      throw pybind11::type_error(std::string(name) + "(): takes keywords alone: " + names());
    T made;
    std::size_t known = 0;
    for (const Field& field : fields()) {
      if (!given.contains(field.name)) continue;
      field.set(made, given[field.name.c_str()]);
      ++known;
    }
    if (known == given.size()) return checked(made);
    throw pybind11::type_error(std::string(name) + "(): unknown keyword; known are " + names());
  }

  static std::string names() {
    std::string all;
    for (const Field& field : fields()) all += (all.empty() ? "" : ", ") + field.name;
    return all;
  }

  static pybind11::tuple values(const T& self) {
    pybind11::list all;
    for (const Field& field : fields()) all.append(field.get(self));
    return pybind11::tuple(all);
  }

  static T fromValues(const pybind11::tuple& state) {
    T made;
    for (std::size_t i = 0; i < fields().size(); ++i) fields()[i].set(made, state[i]);
    return checked(made);
  }

  static std::string repr(const char* name, const T& self) {
    std::string text;
    for (const Field& field : fields())
      text += (text.empty() ? "" : ", ") + field.name + "=" +
              std::string(pybind11::str(pybind11::repr(field.get(self))));
    return std::string(name) + "(" + text + ")";
  }

  std::string name_;
  pybind11::class_<T> class_;
};

}  // namespace ambient
