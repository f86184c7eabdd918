#include "backends/workspace.hpp"

#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace asterflow {

void* allocate_workspace(std::size_t bytes) {
  constexpr std::size_t line = 64, huge_page = std::size_t{1} << 21;
  std::size_t const unit = bytes < 2 * huge_page ? line : huge_page;
  void* const memory = std::aligned_alloc(unit, (bytes + unit - 1) / unit * unit);
  if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (unit == huge_page) madvise(memory, (bytes + unit - 1) / unit * unit, MADV_HUGEPAGE);  // advice: may be refused
#endif
  return memory;
}

}  // namespace asterflow
