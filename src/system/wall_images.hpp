#pragma once
// Images of the forces of fibers that are close to a wall: the cortex or a body. A force f at a distance d from the wall is
// felt there over a spot of the size d; where that is less than the spacing of the wall's nodes, they see a flow that they
// cannot resolve and leave most of the force unscreened. What is put behind the wall does not change the flow in front of
// it, as the wall's own flow makes up for it. So every close force gets the image that keeps a plane wall at rest
// [Blake 1971, Eq. 9], at the mirrored point,
//   u = -G f - 2 d (a . grad) G e + d^2 lap G a,   a = f - 2 (f . e) e,
// G the Stokeslet, e the normal into the fluid, and the nodes see only what the curvature of the wall leaves of the force;
// less still where images follow the curvature (surface/curvature_image.hpp). Images fade out where the nodes resolve forces
// by themselves (surface/image_wall.hpp).
//
// The nodes of an axisymmetric periphery receive what is left as its projection onto what they resolve instead of samples
// (surface/screened_forces.hpp); samples will do inside a preconditioner.
//
// Images in a body are joined by a force, a torque and a stresslet at its centre that make up for theirs: load and first
// moment of the body remain those that its nodes show.
//
// A force stands for a length w of its fiber. The fiber meets its own images no closer than it is resolved: as if it
// were at the distance max(d, w / 2).

#include "base/rigid.hpp"
#include "surface/screened_forces.hpp"

#include <memory>

namespace asterflow {

class WallImages {
 public:
  // screened: of this wall; null: nodes take samples.
  explicit WallImages(ImageWall const& wall, std::shared_ptr<ScreenedForces const> screened = nullptr);

  // The frame of the wall is at `pose`.
  // positions [n] um of forces and the lengths `weights` [n] um that they stand for; fiber i owns [first[i], first[i + 1]).
  // Overwrites.
  void place(RigidPose const& pose, ConstPoints positions, ConstVector weights, std::vector<std::size_t> const& first);

  std::size_t size() const { return images_.size(); }
  std::size_t n_merged() const { return merged_.size(); }  // that rough velocities sum
  std::size_t memory() const {  // bytes
    return images_.capacity() * sizeof(Image) + shares_.capacity() * sizeof(Share) + merged_.capacity() * sizeof(std::size_t);
  }

  // velocity [n_target] += flow of the images of `strengths` [n], pN over viscosity, at points in the fluid. Real: double or float.
  template <class Real>
  void add_velocity(ConstPoints strengths, ConstPoints targets, Points velocity) const;
  // The same of plane images in single precision, close neighbours merged: for the inside of a preconditioner.
  void add_rough_velocity(ConstPoints strengths, ConstPoints targets, Points velocity) const;
  // velocity [node] += flow of the images at the wall's own nodes, and of the forces what projection changes of its samples.
  void add_velocity_at_wall(ConstPoints strengths, ConstPoints wall_nodes, Points velocity) const;
  // velocity [n] at the forces += what a fiber feels of its own images, less that flow.
  void add_own_resolution(ConstPoints strengths, ConstPoints positions, Points velocity) const;

 private:
  struct Image {
    std::size_t source, first, end;  // of its fiber
    Vec3d position;   // um, of the force
    Vec3d foot;       // um, on the wall
    Vec3d direction;  // of the foot, in the frame of the wall
    Vec3d normal;     // e
    LocalGeometry shape;  // of a periphery at the foot
    double depth;     // d / reach
    double nearness = 0.0;  // factor that fades images out, 0 to 1
    double distance;  // d, um
    double resolved;  // max(d, w / 2), um
  };
  // Where the force of an image goes when neighbours on a fiber merge: in parts to two that stay.
  struct Share {
    std::size_t to[2];  // in merged_
    double second;      // part
  };
  struct Moments {  // of images about the centre, over viscosity
    Vec3d force;    // um^2/s
    Matrix3 first = Matrix3::Zero();  // position x force, um^3/s
  };

  void merge();
  std::size_t last_to_merge(std::size_t first) const;
  Moments moments(ConstPoints strengths) const;
  void add_centre(ConstPoints strengths, ConstPoints targets, Points velocity) const;

  ImageWall wall_;
  Vec3d centre_;  // um, of the wall
  std::vector<Image> images_;
  std::vector<std::size_t> merged_;  // those of images_ that stay when neighbours merge
  std::vector<Share> shares_;        // [image]
  std::shared_ptr<ScreenedForces const> screened_;
  std::vector<TablePoint> places_;  // [image]
};

// Of a periphery; null where it is not axisymmetric.
std::shared_ptr<ScreenedForces const> make_screened_forces(ImageWall const& periphery, double accuracy);

}  // namespace asterflow
