#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_fields.h"

AMBIENT_BEGIN

/// Visitor that copies fields from an object of Bullet.
template <class Object>
struct FromBullet : FieldVisitor {
  explicit FromBullet(Object& from) : object(from) {}

  template <class Field>
  void operator()(Field&, const Rule&) {}
  template <class Field, class Get, class Set>
  void operator()(Field& field, const Rule&, const Get& get, const Set&) {
    field = std::invoke(get, object);
  }
  template <std::size_t kSize, class Get>
  void operator()(std::array<btScalar, kSize>& field, const Rule&, const Get& get) {
    const Numbers numbers = get(object);
    std::copy_n(numbers.first, numbers.count, field.begin());
  }
  template <class Get>
  void operator()(std::vector<btScalar>& field, const Rule&, const Get& get) {
    const Numbers numbers = get(object);
    field.assign(numbers.first, numbers.first + numbers.count);
  }
  Object& object;
};

/// Visitor that sets the fields of an object of Bullet, in order; skips those with SetElsewhere.
template <class Object>
struct ToBullet : FieldVisitor {
  explicit ToBullet(Object& to) : object(to) {}

  template <class Field>
  void operator()(const Field&, const Rule&) {}
  template <class Field, class Get, class Set>
  void operator()(const Field& field, const Rule&, const Get&, const Set& set) {
    std::invoke(set, object, field);
  }
  template <class Field, class Get>
  void operator()(const Field& field, const Rule&, const Get& get) {
    const Numbers numbers = get(object);
    std::copy_n(field.begin(), numbers.count, numbers.first);
  }
  Object& object;
};

template <class State, class Object>
State fromBullet(Object& object) {
  State state;
  FromBullet<Object> visitor(object);
  fields(visitor, state);
  return state;
}

template <class State, class Object>
void toBullet(const State& state, Object& object) {
  ToBullet<Object> visitor(object);
  visit(visitor, state);
}

AMBIENT_END
