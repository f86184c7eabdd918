#pragma once
// Force, torque and first moment that the fibers and bodies of a stored state exert on the fluid. For a force density
//   M_ij = int [ (r_i f_j + r_j f_i) / 2 - delta_ij r . f / 3 ],   r = x - x_0.
// Of a body only its flow u is known: on any sphere of outward normal n around it, which u leaves without net flux,
//   M_ij = 5 mu int (u_i n_j + u_j n_i) / 2 dS   about the sphere's centre,
// by the reciprocal theorem with the flow of the traction E n on that sphere, which is E y / (5 mu) inside.

#include "observable/stored_fibers.hpp"
#include "system/stored_flow.hpp"

namespace asterflow {

struct ForceMoments {
  Vec3d force{};                       // pN
  Vec3d torque{};                      // pN um, about the origin
  Matrix3 moment = Matrix3::Zero();    // pN um, about `centre`
  double absolute = 0.0;               // pN um, sum |r| |force|: the largest that 3/2 |M_xx| could be
  void add(Vec3d x, Vec3d f, Vec3d centre);  // one point force
};

ForceMoments force_moments(StoredFlow const& flow, SceneFlows const& flows, double viscosity, StoredFibers const& fibers,
                           Vec3d centre);

}  // namespace asterflow
