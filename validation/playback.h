#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace signorini::validation {

/// What is needed to draw a scene in three dimensions and to play its runs. SI units, world axes;
/// orientations are unit quaternions (w, x, y, z). Fields of report.json: docs/report-schema.md.
struct Playback {
  struct Placement {
    std::array<double, 3> position = {0.0, 0.0, 0.0};          ///< m
    std::array<double, 4> orientation = {1.0, 0.0, 0.0, 0.0};  ///< w, x, y, z
  };

  struct DrawnBody {
    std::string name;
    std::string kind;   ///< "dynamic", "fixed", "kinematic"
    Placement initial;  ///< of the body frame, whose origin is the centre of mass
  };

  /// Triangles, counter-clockwise from outside (hull) or from the front (mesh).
  struct Surface {
    std::vector<std::array<double, 3>> vertices;  ///< m
    std::vector<std::array<int, 3>> triangles;    ///< into vertices
    std::size_t whole_triangles = 0;              ///< how many there are before thinning
  };

  struct DrawnShape {
    std::string name;
    int body = 0;      ///< into bodies
    std::string kind;  ///< "sphere", "box", ...: see sizes
    /// m. sphere: radius; box: half extents; capsule: radius, half length of the segment along z;
    /// cylinder: radius, half length along z; cone: radius of the base in z = -h, h, the apex being
    /// in z = +h; ellipsoid: radii; hull, mesh, half_space (z <= 0): none.
    std::vector<double> sizes;
    int surface = -1;  ///< into surfaces: of hull and mesh
    Placement local;   ///< shape frame in the body frame
  };

  /// What holds two bodies together: drawn from the centre of each that moves to its anchor, and
  /// between the anchors of distances and sliders.
  struct DrawnJoint {
    std::string name;
    std::string kind;  ///< "hinge", "ball", ... (core/model/joint.h)
    int body_a = 0;    ///< into bodies
    int body_b = 0;    ///< the same
    std::array<double, 3> anchor_a = {0.0, 0.0, 0.0};  ///< in the frame of A, m
    std::array<double, 3> anchor_b = {0.0, 0.0, 0.0};  ///< in the frame of B, m
  };

  /// A contact as the engine left it after the steps since the frame before.
  struct DrawnContact {
    int body_a = 0;  ///< into bodies
    int body_b = 0;
    std::array<double, 3> point = {0.0, 0.0,
                                   0.0};  ///< between the two bodies, at the last step's start, m
    std::array<double, 3> force = {0.0, 0.0,
                                   0.0};  ///< on A, mean over the steps, friction included, N
  };

  struct Frame {
    double time = 0.0;                   ///< s
    std::vector<Placement> poses;        ///< of the bodies that are not fixed, in their order
    std::vector<DrawnContact> contacts;  ///< of the steps since the frame before
    std::size_t all_contacts = 0;        ///< how many there are before thinning
  };

  struct PlaybackTrack {
    std::string engine;  ///< "signorini" or "bullet"
    std::vector<Frame> frames;
  };

  std::array<double, 3> gravity = {0.0, 0.0, 0.0};  ///< m/s^2
  std::vector<DrawnBody> bodies;
  std::vector<DrawnShape> shapes;
  std::vector<DrawnJoint> joints;
  std::vector<Surface> surfaces;
  std::vector<PlaybackTrack> tracks;
};

}  // namespace signorini::validation
