#pragma once
// Memory that is written before it is read: growing it sets nothing, so that its pages are first touched by the threads
// that use them and not, one after the other, by the one that asks for it. Much of it is asked for in huge pages, where the
// system has them: sweeps through large grids would look up the address of a page for almost every number.

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace asterflow {

// Throws std::bad_alloc where there is none. To be freed with std::free.
void* allocate_workspace(std::size_t bytes);

template <class Number>
class Workspace {
 public:
  // Room for n numbers; keeps nothing when it grows.
  void grow(std::size_t n) {
    if (n <= capacity_) return;
    numbers_.reset();
    capacity_ = 0;
    numbers_.reset(static_cast<Number*>(allocate_workspace(n * sizeof(Number))));
    capacity_ = n;
  }
  Number* data() { return numbers_.get(); }
  Number const* data() const { return numbers_.get(); }
  std::size_t capacity() const { return capacity_; }

 private:
  struct Free {
    void operator()(Number* numbers) const { std::free(numbers); }
  };
  std::unique_ptr<Number[], Free> numbers_;
  std::size_t capacity_ = 0;
};

}  // namespace asterflow
