#include "mechanism/cortical_pulling_spec.hpp"

namespace asterflow {

CorticalPullingSpec read_cortical_pulling(Table table) {
  using enum CorticalPullingSpec::Direction;
  CorticalPullingSpec spec;
  table.read("sites", spec.sites, between(0, 1000000));
  using Arrangement = CorticalPullingSpec::Arrangement;
  table.read_choice<Arrangement>("arrangement", spec.arrangement,
                                 {{"random", Arrangement::random}, {"even", Arrangement::even}});
  table.read("positions", spec.positions, any_number, "um");
  if (table.has("sites") && table.has("positions")) table.fail("sites", "does not go together with positions");
  if (table.has("arrangement") && table.has("positions")) table.fail("arrangement", "does not go together with positions");
  table.read("pull_force", spec.pull_force, not_negative, "pN");
  table.read_choice<CorticalPullingSpec::Direction>("direction", spec.direction,
                                                    {{"fiber", fiber}, {"normal", normal}});
  table.read("residence_time", spec.residence_time, positive, "s");
  table.read("reach", spec.reach, positive, "um");
  table.read("capture_rate", spec.capture_rate, not_negative, "1/s");
  table.read("posterior", spec.posterior);
  if (norm(spec.posterior) == 0.0) table.fail("posterior", "must not be zero");
  spec.posterior = normalized(spec.posterior);
  table.read("posterior_pole_factor", spec.posterior_pole_factor, not_negative);
  table.read("posterior_plane_factor", spec.posterior_plane_factor, not_negative);
  table.read("dividing_body", spec.dividing_body);
  table.read("dividing_plane", spec.dividing_plane, any_number, "um");
  if (table.has("dividing_body") && table.has("dividing_plane"))
    table.fail("dividing_plane", "does not go together with dividing_body");
  table.finish();
  return spec;
}

}  // namespace asterflow
