#pragma once
// What a run writes and when: the table [output].

#include "base/table.hpp"

namespace asterflow {

struct OutputSpec {
  double interval = 1.0;  // s, > 0, between stored states; the first and the last state are always stored
  double picture_spacing = 0.5;  // um, > 0, between velocity samples of the picture drawn at the end of a run
  bool picture = true;    // draw the last state when the run ends
};

OutputSpec read_output(Table table);

}  // namespace asterflow
