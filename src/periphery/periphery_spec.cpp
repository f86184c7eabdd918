#include "periphery/periphery_spec.hpp"

namespace asterflow {

PeripherySpec read_periphery(Table table) {
  PeripherySpec periphery;
  periphery.shape = read_shape(table);
  table.read("order", periphery.order, between(4, 96));
  table.finish();
  return periphery;
}

}  // namespace asterflow
