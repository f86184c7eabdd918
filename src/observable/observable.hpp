#pragma once
// A number that a stored state yields. Lists of them, always in the same order for one scene, become the rows of a table.

#include <string>
#include <vector>

namespace asterflow {

struct Observable {
  std::string name;  // "fibers_captured"; units are where the functions are declared
  double value;      // not a number where the state does not have it
};

using Observables = std::vector<Observable>;

}  // namespace asterflow
