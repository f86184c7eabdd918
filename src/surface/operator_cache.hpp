#pragma once
// Solution operators on disk, so that a surface is prepared once: one file an operator in the folder ASTERFLOW_CACHE
// ("off": none), else XDG_CACHE_HOME/asterflow, else ~/.cache/asterflow. A file holds its whole key and a checksum; one
// that is damaged, foreign or of another key counts as absent. Files are written under another name and then renamed,
// so that several processes may share the folder. Where nothing can be written nothing is stored.

#include "surface/shell_operator.hpp"
#include "surface/surface.hpp"

#include <string>

namespace asterflow {

// What an operator depends on.
class OperatorKey {
 public:
  OperatorKey(Surface const& surface, Side side, int n_shell, double accuracy);
  std::string const& text() const { return text_; }

 private:
  std::string text_;
};

ShellOperator::Matrices read_operator(OperatorKey const& key);  // empty where there is none
void write_operator(OperatorKey const& key, ShellOperator::Matrices const& matrices);

}  // namespace asterflow
