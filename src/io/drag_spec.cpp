#include "io/drag_spec.hpp"

namespace asterflow {

namespace {

void read_levels(Table& table, DragSpec& drag) {
  std::vector<std::string> names;
  table.read("levels", names);
  if (!table.has("levels")) return;
  drag.levels.clear();
  for (auto const& name : names) {
    bool is_known = false;
    for (auto level : {Interactions::local, Interactions::open, Interactions::confined})
      if (name == name_of(level)) drag.levels.push_back(level), is_known = true;
    if (!is_known) table.fail("levels", "every entry must be one of local, open, confined");
  }
  if (drag.levels.empty()) table.fail("levels", "must not be empty");
}

}  // namespace

DragSpec read_drag(Table table) {
  DragSpec drag;
  table.read("body", drag.body);
  table.read("fiber_counts", drag.fiber_counts, between(0, 1e6));
  if (drag.fiber_counts.empty()) table.fail("fiber_counts", "must not be empty");
  read_levels(table, drag);
  table.read("force", drag.force, any_number, "pN");
  table.read("torque", drag.torque, any_number, "pN um");
  if (norm(drag.force) == 0.0) table.fail("force", "must not be zero (pN)");
  if (norm(drag.torque) == 0.0) table.fail("torque", "must not be zero (pN um)");
  table.read("settling_time", drag.settling_time, not_negative, "s");
  table.read("duration", drag.duration, positive, "s");
  table.read("samples", drag.samples, between(1, 100000));
  table.finish();
  return drag;
}

}  // namespace asterflow
