#include "backends/rates_file.hpp"

#include "backends/backend.hpp"
#include "backends/default_space.hpp"
#include "base/build_info.hpp"
#include "base/cache_folder.hpp"
#include "base/parallel.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <unistd.h>

namespace asterflow {
namespace {

constexpr int method_version = 12;  // of the sums and of what is measured: to be raised when either changes

std::string hexadecimal(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(number));
  return text;
}

std::filesystem::path file_of(std::string const& key) {
  return (cache_folder() / "sums-").concat(hexadecimal(number_of(key))).concat(".rates");
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 1);
  return " unknown";
}

// Numbers are written exactly.
std::string contents(std::string const& key, SumRates const& rates) {
  char numbers[64];
  std::snprintf(numbers, sizeof(numbers), "%a %a\n", rates.pair, rates.plan);
  return key + numbers + hexadecimal(number_of(key + numbers)) + "\n";
}

}  // namespace

std::string rates_key(std::string_view kernel, int digits) {
  std::ostringstream key;
  key << "asterflow " << build_info::version << " rates of sums " << method_version << "\nprocessor" << processor() << " of "
      << std::thread::hardware_concurrency() << ", threads " << thread_count() << ", "
      << (has_avx512() ? "avx512" : has_avx2() ? "avx2" : "portable") << ", " << Kokkos::DefaultExecutionSpace::name() << "\n"
      << kernel << ", digits " << digits << "\n";
  return key.str();
}

bool can_store_rates() {
  auto const folder = cache_folder();
  if (folder.empty()) return false;
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  return !failure && access(folder.c_str(), W_OK) == 0;
}

std::optional<SumRates> read_rates(std::string const& key) {
  if (cache_folder().empty()) return {};
  std::ifstream file(file_of(key), std::ios::binary);
  std::string const text(std::istreambuf_iterator<char>(file), {});
  SumRates rates;
  if (!text.starts_with(key) || std::sscanf(text.c_str() + key.size(), "%la %la", &rates.pair, &rates.plan) != 2) return {};
  if (text != contents(key, rates) || !(rates.pair > 0.0 && rates.plan > 0.0)) return {};
  return rates;
}

void write_rates(std::string const& key, SumRates const& rates) {
  auto const path = file_of(key);
  auto const thread = std::hash<std::thread::id>{}(std::this_thread::get_id());
  auto temporary = path;
  temporary.concat(hexadecimal(static_cast<std::uint64_t>(getpid()))).concat(hexadecimal(thread));
  std::ofstream file(temporary, std::ios::binary);
  file << contents(key, rates);
  file.close();
  std::error_code failure;
  // A link fails where there is a file already, unlike a renaming.
  if (file) std::filesystem::create_hard_link(temporary, path, failure);
  if (file && failure && !read_rates(key)) std::filesystem::rename(temporary, path, failure);
  std::filesystem::remove(temporary, failure);
}

}  // namespace asterflow
