#pragma once
// Rates of sums on disk: one small file a key in the folder of base/cache_folder.hpp. A file holds its whole key and a
// checksum; one that is damaged or of another key counts as absent. The first file written under a key stays.

#include "backends/rates.hpp"

#include <optional>
#include <string>

namespace asterflow {

// What the rates depend on: processor, threads, instruction set, execution space, program, kernel, accuracy.
std::string rates_key(std::string_view kernel, int digits);

bool can_store_rates();
std::optional<SumRates> read_rates(std::string const& key);
void write_rates(std::string const& key, SumRates const& rates);

}  // namespace asterflow
