#include "io/output_spec.hpp"

namespace asterflow {

OutputSpec read_output(Table table) {
  OutputSpec output;
  table.read("interval", output.interval, positive, "s");
  table.read("picture", output.picture);
  table.read("picture_spacing", output.picture_spacing, positive, "um");
  table.finish();
  return output;
}

}  // namespace asterflow
