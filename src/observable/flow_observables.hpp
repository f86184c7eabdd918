#pragma once
// The flow of a stored state, the forces that make it and their work. The periphery counts as outside: net force and
// torque on the fluid are what it takes up. First body: of the scene; x is the anterior-posterior axis. Columns:
//   motor_power, tip_power, body_power   pN um/s, work per time of motors on their fibers, sum int f_motor . V ds, of the
//                                     forces on plus ends, sum F . V(L), and of the loads on free bodies
//   net_force_x, ..., net_torque_x, ...  pN, pN um about the origin, of fibers and bodies on the fluid
//   force_imbalance                   pN, net force less all forces that act on fibers and bodies from outside
//   torque_imbalance                  pN um, the same of torques about the origin
//   force_moment_xx, _yy, _zz, _xy, _xz, _yz   pN um, symmetric traceless part of the first moment of the force on the
//                                     fluid about the centre of the first body (stresslet), bodies included
//   puller_index                      -1 (pusher) to 1 (puller along x): -3/2 M_xx over sum |x - x_0| |force|
//   fluid_speed_mean, _largest        um/s, over points spread evenly in the fluid
//   fluid_speed_ratio                 the mean over the speed of the first body
//   flow_anterior_x, flow_posterior_x um/s, mean u_x in a cylinder of half the first body's radius on its -x and +x side
//   flow_along_fibers                 um/s, mean velocity of the fluid 0.75 um beside the fibers, towards plus ends
//   flow_in_anterior_asters_x         um/s, mean u_x there, on the -x side of the first body
//   no_slip_residual                  of system/no_slip.hpp, relative

#include "observable/observable.hpp"
#include "observable/stored_fibers.hpp"
#include "system/flows.hpp"

namespace asterflow {

// Not a number throughout where the state holds no flow: level `local`, or before the first solve.
Observables flow_observables(Scene const& scene, SceneFlows const& flows, Frame const& frame, StoredFibers const& fibers);

}  // namespace asterflow
