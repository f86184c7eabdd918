#pragma once
// Memory that is written before it is read: growing it sets nothing, so that its pages are first touched by the threads
// that use them and not, one after the other, by the one that asks for it.

#include <cstddef>
#include <memory>

namespace asterflow {

template <class Number>
class Workspace {
 public:
  // Room for n numbers; keeps nothing when it grows.
  void grow(std::size_t n) {
    if (n <= capacity_) return;
    numbers_ = std::make_unique_for_overwrite<Number[]>(n);
    capacity_ = n;
  }
  Number* data() { return numbers_.get(); }
  Number const* data() const { return numbers_.get(); }
  std::size_t capacity() const { return capacity_; }

 private:
  std::unique_ptr<Number[]> numbers_;
  std::size_t capacity_ = 0;
};

}  // namespace asterflow
