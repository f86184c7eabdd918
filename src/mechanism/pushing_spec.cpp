#include "mechanism/pushing_spec.hpp"

namespace asterflow {

PushingSpec read_pushing(Table table) {
  using enum PushingSpec::Sliding;
  PushingSpec spec;
  table.require("sliding");
  table.read_choice<PushingSpec::Sliding>("sliding", spec.sliding,
                                          {{"none", none}, {"free", free}, {"friction", friction}});
  table.read("stall_force", spec.stall_force, positive, "pN");
  table.read("range", spec.range, positive, "um");
  table.read("minimal_catastrophe_rate", spec.minimal_catastrophe_rate, not_negative, "1/s");
  table.read("spring_stiffness", spec.spring_stiffness, positive, "pN/um");
  table.read("friction", spec.friction, positive, "pN s/um");
  if (spec.sliding == free && table.has("spring_stiffness"))
    table.fail("spring_stiffness", "holds the plus ends and contradicts sliding = \"free\"");
  if (spec.sliding == friction && !table.has("friction")) table.fail("friction", "is needed by sliding = \"friction\"");
  if (spec.sliding != friction && table.has("friction"))
    table.fail("friction", "needs sliding = \"friction\" and contradicts the sliding that is given");
  table.finish();
  return spec;
}

}  // namespace asterflow
