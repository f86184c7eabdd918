#pragma once
// Radix sort on host threads: one pass over blocks of items by the leading bits of their keys, then every bucket for
// itself. Stable, so there is one result whatever the number of threads.

#include "backends/fast_order.hpp"

namespace asterflow {

// By key; items of equal keys keep their order.
void sort_by_key(std::vector<KeyedIndex>& items);
void sort_on_this_thread(std::vector<KeyedIndex>& items);  // likewise

}  // namespace asterflow
