#include "command/json.hpp"

#include <cmath>
#include <fmt/format.h>

namespace asterflow {

std::string json_text(std::string const& text) {
  std::string result = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') result += '\\', result += c;
    else if (static_cast<unsigned char>(c) < 0x20) result += fmt::format("\\u{:04x}", static_cast<int>(c));
    else result += c;
  }
  return result + '"';
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_matrix(Eigen::MatrixXd const& rows) {
  std::string result = "[";
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    result += i > 0 ? ", [" : "[";
    for (Eigen::Index j = 0; j < rows.cols(); ++j) result += (j > 0 ? ", " : "") + json_number(rows(i, j));
    result += "]";
  }
  return result + "]";
}

}  // namespace asterflow
