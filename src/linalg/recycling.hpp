#pragma once
// A memory of solves for the next ones with nearly the same matrix A: directions d that A stretches or shrinks most, kept as
// U with its image C = A U, C^T C = 1. The preconditioner
//   M r = r + (U - C) C^T r
// makes A M the identity on span(C): GMRES sees only what is left of the spectrum. When A changes slowly from solve to
// solve, C is only nearly A U and M is still a good preconditioner. It costs no product with A.
// [after Parks et al. 2006, SIAM J. Sci. Comput. 28: GCRO-DR, with the subspace in the preconditioner]

#include "base/arrays.hpp"

#include <Eigen/Core>

namespace asterflow {

class Recycling {
 public:
  using Directions = Eigen::MatrixXf;  // [n, k]: as a preconditioner, single precision is enough

  explicit Recycling(int capacity) : capacity_(capacity) {}

  int size() const { return static_cast<int>(images_.cols()); }
  std::size_t memory() const { return sizeof(float) * (changes_.size() + images_.size()); }  // bytes

  // r += (U - C) C^T r; nothing for a vector of another size than what was learnt.
  void precondition(Vector r) const;
  // Candidates: the columns of w with their images a_w = A w, both [n, m]. Keeps the `capacity` directions of
  // span(U, w) with the largest |log(|A d| / |d|)|.
  void learn(Directions const& w, Directions const& a_w);

  // After a solve: its candidates as in learn, and its cost in iterations per digit gained. Once full, the memory learns from
  // every third solve: a lesson costs as much as an iteration. What is remembered grows old as A changes: when it saves
  // less than a tenth of what the last solve without it took, all is forgotten.
  void learn(Directions const& w, Directions const& a_w, double cost);

  // U - C, C, the cost of the last solve without them and the solves since the memory was full: all that a restart needs.
  Directions const& changes() const { return changes_; }
  Directions const& images() const { return images_; }
  double cost_without() const { return cost_without_; }
  int solves_when_full() const { return solves_when_full_; }
  void restore(Directions changes, Directions images, double cost_without, int solves_when_full) {
    changes_ = std::move(changes);
    images_ = std::move(images);
    cost_without_ = cost_without;
    solves_when_full_ = solves_when_full;
  }

 private:
  int capacity_;
  Directions changes_, images_;  // U - C and C
  double cost_without_ = 0.0;
  int solves_when_full_ = 0;
};

}  // namespace asterflow
