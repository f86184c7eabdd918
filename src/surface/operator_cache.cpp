#include "surface/operator_cache.hpp"

#include "base/cache_folder.hpp"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <thread>
#include <unistd.h>

namespace asterflow {
namespace {

constexpr int method_version = 1;  // of the operators and of the file: to be raised when either changes
constexpr std::uint64_t largest_entry = std::uint64_t{1} << 32;

// Fowler-Noll-Vo over words of eight bytes.
std::uint64_t checksum(double const* values, std::size_t n, std::uint64_t sum = 14695981039346656037ULL) {
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t word;
    std::memcpy(&word, values + i, sizeof(word));
    sum = (sum ^ word) * 1099511628211ULL;
    sum ^= sum >> 29;
  }
  return sum;
}

std::uint64_t checksum(ShellOperator::Matrices const& matrices) {
  std::uint64_t sum = matrices.size();
  for (auto const& m : matrices) sum = checksum(m.data(), static_cast<std::size_t>(m.size()), sum + static_cast<std::uint64_t>(m.rows()));
  return sum;
}

std::filesystem::path file_of(OperatorKey const& key) {
  auto const folder = cache_folder();
  return folder.empty() ? folder : folder / fmt::format("surface-{:016x}.operator", number_of(key.text()));
}

bool read_number(std::ifstream& file, std::uint64_t& number, std::uint64_t most) {
  return file.read(reinterpret_cast<char*>(&number), sizeof(number)) && number <= most;
}

void write_number(std::ofstream& file, std::uint64_t number) {
  file.write(reinterpret_cast<char const*>(&number), sizeof(number));
}

}  // namespace

OperatorKey::OperatorKey(Surface const& surface, Side side, int n_shell, double accuracy) {
  auto const nodes = flat(surface.nodes());
  text_ = fmt::format("asterflow surface operator {}\n{} order {} shells {} accuracy {:a} centre {:a} {:a} {:a} nodes {:016x}\n",
                      method_version, side == Side::interior ? "interior" : "exterior", surface.order(), n_shell, accuracy,
                      surface.shape().centre().x, surface.shape().centre().y, surface.shape().centre().z,
                      checksum(nodes.data(), static_cast<std::size_t>(nodes.size())));
}

// Layout: key, then numbers of 8 bytes: how many matrices; rows, columns and values of each; checksum.
ShellOperator::Matrices read_operator(OperatorKey const& key) {
  auto const path = file_of(key);
  if (path.empty()) return {};
  std::ifstream file(path, std::ios::binary);
  std::string text(key.text().size(), ' ');
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())) || text != key.text()) return {};
  std::uint64_t count = 0, rows = 0, columns = 0, sum = 0;
  if (!read_number(file, count, 10000)) return {};
  ShellOperator::Matrices matrices(count);
  for (auto& matrix : matrices) {
    if (!read_number(file, rows, largest_entry) || !read_number(file, columns, largest_entry / (rows + 1))) return {};
    matrix.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    if (!file.read(reinterpret_cast<char*>(matrix.data()), static_cast<std::streamsize>(sizeof(double) * matrix.size()))) return {};
  }
  if (!read_number(file, sum, ~std::uint64_t{0}) || sum != checksum(matrices)) return {};
  return matrices;
}

void write_operator(OperatorKey const& key, ShellOperator::Matrices const& matrices) {
  auto const path = file_of(key);
  if (path.empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(path.parent_path(), failure);
  auto temporary = path;
  temporary += fmt::format(".{}.{}", getpid(), std::hash<std::thread::id>{}(std::this_thread::get_id()));
  std::ofstream file(temporary, std::ios::binary);
  file.write(key.text().data(), static_cast<std::streamsize>(key.text().size()));
  write_number(file, matrices.size());
  for (auto const& matrix : matrices) {
    write_number(file, static_cast<std::uint64_t>(matrix.rows()));
    write_number(file, static_cast<std::uint64_t>(matrix.cols()));
    file.write(reinterpret_cast<char const*>(matrix.data()), static_cast<std::streamsize>(sizeof(double) * matrix.size()));
  }
  write_number(file, checksum(matrices));
  file.close();
  if (file) std::filesystem::rename(temporary, path, failure);
  if (!file || failure) std::filesystem::remove(temporary, failure);
}

}  // namespace asterflow
