#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace ambient {

/// List of numbers. Copies share their memory until one of them is to be changed, own().
template <class Number>
class SharedList {
 public:
  using List = std::vector<Number>;

  SharedList() = default;
  SharedList(List numbers) {
    if (!numbers.empty()) list_ = std::make_shared<List>(std::move(numbers));
  }
  SharedList(std::initializer_list<Number> numbers) : SharedList(List(numbers)) {}
  template <class Iterator>
  SharedList(Iterator begin, Iterator end) : SharedList(List(begin, end)) {}

  operator const List&() const { return get(); }
  const List& get() const {
    static const List kNone;
    return list_ ? *list_ : kNone;
  }
  /// Returns the list to change it; no copy sees that.
  List& own() {
    if (!list_ || list_.use_count() > 1) list_ = std::make_shared<List>(get());
    return *list_;
  }

  std::size_t size() const { return get().size(); }
  bool empty() const { return get().empty(); }
  const Number* data() const { return get().data(); }
  const Number& operator[](std::size_t i) const { return (*list_)[i]; }
  auto begin() const { return get().begin(); }
  auto end() const { return get().end(); }
  friend bool operator==(const SharedList& a, const SharedList& b) { return a.get() == b.get(); }
  friend bool operator!=(const SharedList& a, const SharedList& b) { return !(a == b); }

 private:
  std::shared_ptr<List> list_;  ///< null: empty
};

}  // namespace ambient
