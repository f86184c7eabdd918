#include "backends/fast_cover.hpp"

#include <algorithm>

namespace asterflow {
namespace {

struct Choice {
  double cost = 0.0;
  std::vector<Rectangle> rectangles;
};

Rectangle bounding(std::vector<Box const*> boxes) {
  Rectangle r;
  for (int d = 0; d < 3; ++d) {
    auto const less = [d](Box const* a, Box const* b) { return a->place[d] < b->place[d]; };
    auto const [first, last] = std::minmax_element(boxes.begin(), boxes.end(), less);
    r.low[d] = (*first)->place[d];
    r.high[d] = (*last)->place[d];
  }
  r.boxes = std::move(boxes);
  return r;
}

double grid_nodes(Rectangle const& r, double nodes_per_box) {
  double nodes = 1.0;
  for (int d = 0; d < 3; ++d) nodes *= (r.high[d] - r.low[d] + 3) * nodes_per_box;
  return nodes;
}

Choice best_cover(std::vector<Box const*> boxes, double nodes_per_box, double max_nodes) {
  Rectangle const whole = bounding(std::move(boxes));
  double const nodes = grid_nodes(whole, nodes_per_box);
  int longest = 0;
  for (int d = 1; d < 3; ++d)
    if (whole.high[d] - whole.low[d] > whole.high[longest] - whole.low[longest]) longest = d;
  if (whole.high[longest] == whole.low[longest]) return {nodes, {whole}};
  int const middle = (whole.low[longest] + whole.high[longest]) / 2;
  std::vector<Box const*> lower, upper;
  for (Box const* box : whole.boxes) (box->place[longest] <= middle ? lower : upper).push_back(box);
  Choice a = best_cover(std::move(lower), nodes_per_box, max_nodes);
  Choice b = best_cover(std::move(upper), nodes_per_box, max_nodes);
  if (nodes <= max_nodes && nodes <= a.cost + b.cost) return {nodes, {whole}};
  a.cost += b.cost;
  for (Rectangle& r : b.rectangles) a.rectangles.push_back(std::move(r));
  return a;
}

}  // namespace

std::vector<Rectangle> cover(std::vector<Box const*> boxes, double nodes_per_box, double max_nodes) {
  if (boxes.empty()) return {};
  return best_cover(std::move(boxes), nodes_per_box, max_nodes).rectangles;
}

}  // namespace asterflow
