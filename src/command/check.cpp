#include "command/check.hpp"

#include "base/timer.hpp"
#include "io/scene.hpp"
#include "mechanism/cytoplasmic_pulling.hpp"
#include "system/flows.hpp"
#include "system/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <memory>
#include <string_view>
#include <sys/resource.h>
#include <vector>

namespace asterflow {

namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool is_quick = false;
};

void print_line(std::string const& what, std::string const& text) { fmt::print("{:<14} {}\n", what, text); }

std::string shape_words(ShapeSpec const& shape) {
  switch (shape.kind) {
    case ShapeSpec::Kind::sphere: return fmt::format("sphere of radius {:g} um", shape.radius);
    case ShapeSpec::Kind::ellipsoid:
      return fmt::format("ellipsoid of semi-axes {:g}, {:g}, {:g} um", shape.semi_axes.x, shape.semi_axes.y,
                         shape.semi_axes.z);
    case ShapeSpec::Kind::revolution: break;
  }
  return fmt::format("surface of revolution through {} points", shape.profile.size());
}

// Nodes of a surface at the resolution of the run.
int surface_nodes(ShapeSpec const& shape, int order_in_scene, double accuracy) {
  return static_cast<int>(grid_of_order(*make_shape(shape), surface_order(shape, order_in_scene, accuracy)).size());
}

// What the nodes of a surface cannot honour.
void print_limit(std::string const& name, ShapeSpec const& spec, int order_in_scene, double accuracy) {
  int const order = surface_order(spec, order_in_scene, accuracy);
  double const resolved = resolved_accuracy(*make_shape(spec), order);
  if (resolved > 2.0 * accuracy)
    print_line("note", fmt::format("{}: order {} resolves flows to about {:.0e}, not to accuracy = {:g}{}", name, order,
                                   resolved, accuracy, order_in_scene > 0 ? "" : "; set its order to go beyond"));
}

// How well the flow is known where fibers and the cortex are close.
void print_flow_near_cortex(Scene const& scene) {
  ShapeSpec const& shape = scene.periphery->shape;
  Surface const surface = plain_surface(shape, surface_order(shape, scene.periphery->order, scene.run.accuracy));
  if (auto const wall = wall_of_images(scene, surface))
    print_line("near cortex", fmt::format("within {:.2g} um, flow of forces as close has an error of up to about {:.0e} of their flow "
                                          "without a cell", surface.spacing(),
                                          wall->nearby_error()));
}

// Prints the scene's objects; returns the number of surface nodes.
long print_objects(Scene const& scene) {
  long n_node = 0;
  print_line("fluid", fmt::format("viscosity {:g} pN s/um^2", scene.fluid.viscosity));
  if (scene.background) print_line("background", "imposed flow");
  if (scene.periphery) {
    bool const is_flow = scene.run.interactions == Interactions::confined;
    int const n = is_flow ? surface_nodes(scene.periphery->shape, scene.periphery->order, scene.run.accuracy) : 0;
    n_node += n;
    print_line("periphery", shape_words(scene.periphery->shape) +
                                (is_flow ? fmt::format(", {} nodes", n) : ", stops fibers, no flow"));
    if (is_flow) {
      print_limit("periphery", scene.periphery->shape, scene.periphery->order, scene.run.accuracy);
      print_flow_near_cortex(scene);
    }
  }
  for (auto const& body : scene.bodies) {
    int const n = surface_nodes(body.shape, body.order, scene.run.accuracy);
    n_node += n;
    print_line("body", fmt::format("\"{}\": {}, {}, {} nodes", body.name, shape_words(body.shape),
                                   body.motion == BodySpec::Motion::free ? "free" : "prescribed motion", n));
    print_limit('"' + body.name + '"', body.shape, body.order, scene.run.accuracy);
  }
  return n_node;
}

void print_fibers(Scene const& scene, Fibers const& fibers) {
  if (fibers.count() == 0) return;
  std::map<std::size_t, std::size_t> fibers_of_size;  // by number of nodes
  for (std::size_t i = 0; i < fibers.count(); ++i) ++fibers_of_size[fibers.first_node(i + 1) - fibers.first_node(i)];
  std::string sizes;
  for (auto const& [n, count] : fibers_of_size) sizes += fmt::format("{}{} with {}", sizes.empty() ? "" : ", ", count, n);
  print_line("fibers", fmt::format("{} ({} single, {} asters), {} nodes: {}{}", fibers.count(), scene.fibers.size(),
                                   scene.asters.size(), fibers.node_count(), sizes,
                                   scene.dynamic_instability ? "; dynamic instability" : ""));
}

std::string_view sliding_words(PushingSpec::Sliding sliding) {
  switch (sliding) {
    case PushingSpec::Sliding::none: return "without sliding";
    case PushingSpec::Sliding::friction: return "sliding with friction";
    case PushingSpec::Sliding::free: break;
  }
  return "sliding freely";
}

// The active mechanisms, one line each.
void print_mechanisms(Scene const& scene) {
  if (auto const& growth = scene.dynamic_instability)
    print_line("growth", fmt::format("at {:g} um/s, shrinkage at {:g} um/s; catastrophes {:g} / s, rescues {:g} / s",
                                     growth->growth_speed, growth->shrinkage_speed, growth->catastrophe_rate, growth->rescue_rate));
  if (auto const& pulling = scene.cytoplasmic_pulling)
    print_line("motors", fmt::format("{:g} / um pull with {:.3g} pN each", pulling->motor_density,
                                     motor_force(*pulling, scene.fluid.viscosity)));
  if (auto const& pushing = scene.pushing)
    print_line("pushing", fmt::format("plus ends push the cortex, {}", sliding_words(pushing->sliding)));
  if (auto const& pulling = scene.cortical_pulling)
    print_line("cortical sites", fmt::format("{} pull with {:g} pN each",
                                             pulling->positions.empty() ? pulling->sites : static_cast<int>(pulling->positions.size()),
                                             pulling->pull_force));
  if (auto const& repulsion = scene.steric_repulsion) {
    std::vector<std::string_view> pairs;
    if (repulsion->fiber_cortex) pairs.push_back("fibers and cortex");
    if (repulsion->fiber_body) pairs.push_back("fibers and bodies");
    if (repulsion->body_cortex) pairs.push_back("bodies and cortex");
    if (repulsion->body_body && scene.bodies.size() > 1) pairs.push_back("bodies and bodies");
    print_line("repulsion", fmt::format("within {:g} um: {}", repulsion->range, fmt::join(pairs, ", ")));
  }
}

void print_solver(Scene const& scene, Simulation const& simulation, long n_surface_node) {
  auto const& run = scene.run;
  std::size_t const n_fiber_node = simulation.fibers().node_count();
  print_line("interactions", std::string(name_of(run.interactions)));
  if (run.interactions == Interactions::local) {
    print_line("unknowns", "none for GMRES: fibers and bodies are solved directly");
    print_line("evaluators", "none");
  } else {
    long const n_node = n_surface_node + long(n_fiber_node);
    print_line("unknowns", fmt::format("{} (incident flow at {} nodes)", 3 * n_node, n_node));
    print_line("evaluators", n_fiber_node > 0 ? fmt::format("stokeslet: {}, accuracy {:g}", run.evaluator,
                                                            run.evaluator_accuracy)
                                              : "none: surfaces only");
    print_line("GMRES", fmt::format("tolerance {:g}, at most {} iterations", run.gmres_tolerance, run.gmres_max_iterations));
  }
  print_line("time", fmt::format("to {:g} s, {}", run.end_time,
                                 run.adaptive ? fmt::format("error {:g} um a step", run.step_tolerance)
                                              : fmt::format("steps of {:g} s", run.time_step)));
}

// Largest resident memory of this process so far, bytes.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

void check(CheckOptions const& options) {
  Scene const scene = read_scene(options.scene, options.overrides);
  print_line("scene", options.scene + ": valid");
  long const n_surface_node = print_objects(scene);
  print_mechanisms(scene);
  if (options.is_quick) return;
  Timer timer;
  Simulation simulation(scene);
  double const seconds = timer.seconds();
  print_fibers(scene, simulation.fibers());
  print_solver(scene, simulation, n_surface_node);
  print_line("set-up", fmt::format("{:.2g} s", seconds));
  if (scene.run.end_time > 0.0) {
    StepReport const step = simulation.step(scene.run.end_time);
    print_line("first step", fmt::format("{:.3g} s for dt = {:.3g} s, {} GMRES iterations, {} trials before it", step.seconds,
                                         step.dt, step.iterations, step.rejected));
  }
  print_line("memory", fmt::format("{:.0f} MB, of the whole program at most", peak_memory() / 1e6));
}

}  // namespace

void add_check_command(CLI::App& program, Action& chosen) {
  auto const options = std::make_shared<CheckOptions>();
  auto* const command = program.add_subcommand(
      "check", "Validate a scene and print what will be modelled: objects, unknowns, evaluators, memory, and the cost of\n"
               "its first step, measured. Nothing is written.");
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_flag("--quick", options->is_quick, "validate only, without set-up and first step");
  add_overrides(*command, options->overrides);
  command->footer(examples("  asterflow check scenes/figure2.toml\n"
                           "  asterflow check scenes/figure2.toml --set run.interactions=open --quick\n"));
  command->callback([options, &chosen] { chosen = [options] { check(*options); }; });
}

}  // namespace asterflow
