#pragma once
// Numbers and texts as JSON.

#include <Eigen/Core>

#include <string>

namespace asterflow {

std::string json_text(std::string const& text);      // in quotes, escaped
std::string json_number(double value);               // shortest that reads back the same; null when not finite
std::string json_matrix(Eigen::MatrixXd const& rows);  // [[...], ...]

}  // namespace asterflow
