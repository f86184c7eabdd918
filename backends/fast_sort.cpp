#include "backends/fast_sort.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace asterflow {
namespace {

constexpr int most_bits = 11;  // of a digit: counters that stay in the cache
constexpr long few = 32;       // items sorted by insertion

// The bits by which one pass sorts: below those that all keys share.
struct Digit {
  int shift, bits;

  Digit(std::uint64_t varying, long n) {
    bits = std::clamp(static_cast<int>(std::bit_width(static_cast<std::uint64_t>(n))) - 3, 4, most_bits);
    shift = std::max(0, static_cast<int>(std::bit_width(varying)) - bits);
  }
  std::size_t of(std::uint64_t key) const { return (key >> shift) & ((1u << bits) - 1u); }
  std::size_t n_value() const { return std::size_t{1} << bits; }
};

std::uint64_t varying_bits(KeyedIndex const* items, long n) {
  std::uint64_t varying = 0;
  for (long i = 1; i < n; ++i) varying |= items[i].key ^ items[0].key;
  return varying;
}

void insert_in_order(KeyedIndex* items, long n) {
  for (long i = 1; i < n; ++i) {
    KeyedIndex const item = items[i];
    long k = i;
    for (; k > 0 && items[k - 1].key > item.key; --k) items[k] = items[k - 1];
    items[k] = item;
  }
}

// Sorts n items with the help of as many others; the result is in `items` or, when asked for, in `others`.
void sort_range(KeyedIndex* items, KeyedIndex* others, long n, bool into_others) {
  std::uint64_t const varying = n <= few ? 0 : varying_bits(items, n);
  if (varying == 0) {
    if (n <= few) insert_in_order(items, n);
    if (into_others) std::copy(items, items + n, others);
    return;
  }
  Digit const digit(varying, n);
  std::uint32_t next[1u << most_bits];
  std::fill_n(next, digit.n_value(), 0u);
  for (long i = 0; i < n; ++i) ++next[digit.of(items[i].key)];
  std::uint32_t begin = 0;
  for (std::size_t value = 0; value < digit.n_value(); ++value) begin += std::exchange(next[value], begin);
  for (long i = 0; i < n; ++i) others[next[digit.of(items[i].key)]++] = items[i];
  for (std::size_t value = 0; value < digit.n_value(); ++value) {  // next: now the ends
    long const first = value == 0 ? 0 : next[value - 1];
    if (next[value] > first) sort_range(others + first, items + first, next[value] - first, !into_others);
  }
}

}  // namespace

void sort_on_this_thread(std::vector<KeyedIndex>& items) {
  std::vector<KeyedIndex> others(items.size());
  sort_range(items.data(), others.data(), static_cast<long>(items.size()), false);
}

void sort_by_key(std::vector<KeyedIndex>& items) {
  constexpr long least_block = 2048, most_blocks = 64;
  long const n = static_cast<long>(items.size()), n_block = std::clamp(n / least_block, 1L, most_blocks);
  if (n_block == 1) return sort_on_this_thread(items);
  std::vector<KeyedIndex> others(items.size());
  auto const begin = [&](long block) { return block * n / n_block; };

  std::vector<std::uint64_t> varying_of(n_block);
  parallel_for("Fast::sort::vary", n_block, [&](long block) {
    for (long i = begin(block); i < begin(block + 1); ++i) varying_of[block] |= items[i].key ^ items[0].key;
  });
  std::uint64_t varying = 0;
  for (std::uint64_t bits : varying_of) varying |= bits;
  if (varying == 0) return;
  Digit const digit(varying, n);
  std::vector<std::uint32_t> next(n_block * digit.n_value(), 0);  // [block, value]
  parallel_for("Fast::sort::count", n_block, [&](long block) {
    std::uint32_t* const count = next.data() + block * static_cast<long>(digit.n_value());
    for (long i = begin(block); i < begin(block + 1); ++i) ++count[digit.of(items[i].key)];
  });
  std::vector<long> bucket{0};
  std::uint32_t placed = 0;
  for (std::size_t value = 0; value < digit.n_value(); ++value) {
    for (long block = 0; block < n_block; ++block) placed += std::exchange(next[block * digit.n_value() + value], placed);
    bucket.push_back(placed);
  }
  parallel_for("Fast::sort::move", n_block, [&](long block) {
    std::uint32_t* const place = next.data() + block * static_cast<long>(digit.n_value());
    for (long i = begin(block); i < begin(block + 1); ++i) others[place[digit.of(items[i].key)]++] = items[i];
  });
  parallel_for("Fast::sort::buckets", static_cast<long>(digit.n_value()), [&](long value) {
    long const first = bucket[value];
    sort_range(others.data() + first, items.data() + first, bucket[value + 1] - first, true);
  });
}

}  // namespace asterflow
