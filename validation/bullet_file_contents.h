#pragma once

#include "tools/byte_archive.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace signorini::validation {

/// What a .bullet file holds, as plain numbers that a child process hands over. SI units; a pose is
/// x, y, z and a quaternion w, x, y, z.
using FilePose = std::array<double, 7>;
using FileVector = std::array<double, 3>;

enum class FileShapeKind : unsigned char {
  kSphere,     ///< size: radius
  kBox,        ///< half extents
  kCapsule,    ///< radius, half length, along z
  kCylinder,   ///< radius, half length, along z
  kCone,       ///< radius, half height, along z
  kHalfSpace,  ///< z <= 0
  kHull,       ///< points
  kMesh,       ///< points and triangles
};

struct FileShape {
  FileShapeKind kind = FileShapeKind::kSphere;
  FileVector size = {};
  FilePose pose = {};  ///< in the body, whose origin is the centre of mass
  std::vector<FileVector> points;
  std::vector<std::array<int, 3>> triangles;
};
void visit_fields(auto& archive, tools::Reflects<FileShape> auto& shape) {
  archive(shape.kind, shape.size, shape.pose, shape.points, shape.triangles);
}

struct FileBody {
  std::string name;
  double mass = 0.0;        ///< 0: fixed
  FileVector moments = {};  ///< about its own axes, kg m^2
  FilePose pose = {};
  FileVector linear = {};
  FileVector angular = {};
  double friction = 0.0;
  double restitution = 0.0;
  double gravity_scale = 1.0;
  std::vector<FileShape> shapes;
};
void visit_fields(auto& archive, tools::Reflects<FileBody> auto& body) {
  archive(body.name, body.mass, body.moments, body.pose, body.linear, body.angular, body.friction,
          body.restitution, body.gravity_scale, body.shapes);
}

enum class FileJointKind : unsigned char { kFixed, kBall, kHinge, kSlider };

/// As core's Joint, whose A is Bullet's B and the other way round.
struct FileJoint {
  std::string name;
  FileJointKind kind = FileJointKind::kBall;
  int body_a = -1;  ///< -1: the world
  int body_b = -1;
  FilePose in_a = {};  ///< the joint's frame; its axis is z (hinge) or x (slider)
  FilePose in_b = {};
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double motor_speed = 0.0;
  double motor_impulse = 0.0;  ///< of a step, N m s; 0: no motor
  bool bodies_collide = false;
};
void visit_fields(auto& archive, tools::Reflects<FileJoint> auto& joint) {
  archive(joint.name, joint.kind, joint.body_a, joint.body_b, joint.in_a, joint.in_b, joint.lower,
          joint.upper, joint.motor_speed, joint.motor_impulse, joint.bodies_collide);
}

struct FileContents {
  FileVector gravity = {};
  std::vector<FileBody> bodies;
  std::vector<FileJoint> joints;
  std::vector<std::string> unsupported;  ///< what ours cannot do, each naming object and field
  std::vector<std::string> notices;
};
void visit_fields(auto& archive, tools::Reflects<FileContents> auto& contents) {
  archive(contents.gravity, contents.bodies, contents.joints, contents.unsupported,
          contents.notices);
}

/// What Bullet made of the file's own world: one sample a record, 13 numbers a body (pose, linear
/// and angular velocity).
struct FileRun {
  std::vector<std::vector<double>> samples;
  double seconds = 0.0;  ///< of the steps
  int iterations = 0;    ///< of its solver
};
void visit_fields(auto& archive, tools::Reflects<FileRun> auto& run) {
  archive(run.samples, run.seconds, run.iterations);
}

}  // namespace signorini::validation
