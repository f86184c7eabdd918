#pragma once
// Flexible GMRES with right preconditioning: solves A x = b, minimising |b - A x| over x0 + span{M_k v_k},
// where the preconditioner M_k may itself be an iteration.  [Saad 1993, SIAM J. Sci. Comput. 14]

#include "base/arrays.hpp"

#include <functional>

namespace asterflow {

// output = operator(input); both of the size of the unknown, never aliased.
using LinearOperator = std::function<void(ConstVector input, Vector output)>;

struct GmresOptions {
  double tolerance = 1e-6;  // on |b - A x| / reference
  double reference = 0.0;   // what the residual is compared with; 0: |b|
  int max_iterations = 200;
  int restart = 60;  // Krylov vectors kept
  // Told the relative residual before the first iteration and after each.
  std::function<void(double residual)> monitor = {};
};

struct GmresResult {
  int iterations = 0;
  double residual = 0.0;  // |b - A x| / reference, as estimated by the recurrence
  bool converged = false;
};

// x holds the initial guess and receives the solution. An empty preconditioner means the identity.
GmresResult solve_gmres(LinearOperator const& a, LinearOperator const& preconditioner, ConstVector b, Vector x,
                        GmresOptions const& options);

}  // namespace asterflow
