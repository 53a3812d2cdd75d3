#pragma once

#include <signorini/core/model/body.h>
#include <signorini/core/model/contact.h>

#include <cmath>
#include <random>

namespace signorini::scenes {

/// Bodies, their state and what touches.
struct Scene {
  Bodies bodies;
  State state;
  ContactSet contacts;

  int add(const Body& body, const Vec3& x, const Velocity& motion = {}) {
    bodies.push_back(body);
    state.emplace_back();
    state.back().x = x;
    set_velocity(body, motion, state.back());
    return static_cast<int>(bodies.size()) - 1;
  }
  Contact& touch(int a, int b, const Vec3& point, const Vec3& normal, double e) {
    Contact contact;
    contact.body_a = a;
    contact.body_b = b;
    contact.point_a = contact.point_b = point;
    contact.normal = normal;
    contact.gap = 0.0;
    contact.material.restitution = e;
    contacts.push_back(contact);
    return contacts.back();
  }
  [[nodiscard]] Velocity velocity_of(int body) const { return velocity(bodies[body], state[body]); }
};

inline Body fixed_body() {
  Body body;
  body.kind = BodyKind::kFixed;
  return body;
}

inline Body kinematic_body() {
  Body body;
  body.kind = BodyKind::kKinematic;
  return body;
}

inline Body ball(double mass = 1.0, double radius = 0.5) {
  Body body;
  body.mass = mass;
  body.inertia = 0.4 * mass * radius * radius * Mat3::Identity();
  return body;
}

/// A solid box with the edge lengths `size`.
inline Body box(double mass, const Vec3& size) {
  Body body;
  body.mass = mass;
  const Vec3 squares = size.cwiseAbs2() / 12.0;
  body.inertia = (mass * (Vec3::Constant(squares.sum()) - squares)).asDiagonal();
  return body;
}

/// The wedge of the notes: a unit mass that cannot be turned (the contacts act through its centre),
/// V- = (0, -s), N0 = (1, 1)/sqrt 2, N1 = (-2, 1)/sqrt 5.
inline Scene wedge(double s, double e) {
  Scene scene;
  const int mass = scene.add(ball(), Vec3::Zero(), {Vec3(0, -s, 0), Vec3::Zero()});
  const int ground = scene.add(fixed_body(), Vec3(0, -1, 0));
  scene.touch(mass, ground, Vec3::Zero(), Vec3(1, 1, 0) / std::sqrt(2.0), e);
  scene.touch(mass, ground, Vec3::Zero(), Vec3(-2, 1, 0) / std::sqrt(5.0), e);
  return scene;
}

/// A ball between two opposite walls, touching both, moving at the first one with speed s.
inline Scene opposite_walls(double s, double e) {
  Scene scene;
  const int mass = scene.add(ball(), Vec3::Zero(), {Vec3(-s, 0, 0), Vec3::Zero()});
  const int walls = scene.add(fixed_body(), Vec3::Zero());
  scene.touch(mass, walls, Vec3(-0.5, 0, 0), Vec3(1, 0, 0), e);
  scene.touch(mass, walls, Vec3(0.5, 0, 0), Vec3(-1, 0, 0), e);
  return scene;
}

/// A row of equal touching balls, the first one running at the others with speed s.
inline Scene cradle(int balls, double s, double e) {
  Scene scene;
  for (int i = 0; i < balls; ++i) {
    scene.add(ball(), Vec3(i, 0, 0), {Vec3(i == 0 ? s : 0.0, 0, 0), Vec3::Zero()});
  }
  for (int i = 0; i + 1 < balls; ++i) {
    scene.touch(i + 1, i, Vec3(i + 0.5, 0, 0), Vec3(1, 0, 0), e);
  }
  return scene;
}

/// A box with a face flat on the ground, four corners touching, turned about the vertical. `v` is
/// its velocity. Contacts in the order 0, 1, 2, 3 around the face.
inline Scene box_on_ground(double mass, const Vec3& size, double yaw, const Vec3& v, double e) {
  Scene scene;
  const int brick = scene.add(box(mass, size), Vec3(0.3, -0.2, 0.5 * size.z()));
  scene.state[brick].q = Quat(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
  set_velocity(scene.bodies[brick], {v, Vec3::Zero()}, scene.state[brick]);
  const int ground = scene.add(fixed_body(), Vec3::Zero());
  for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    const Vec3 corner(0.5 * i * size.x(), 0.5 * j * size.y(), -0.5 * size.z());
    scene.touch(brick, ground, scene.state[brick].pose() * corner, Vec3::UnitZ(), e);
  }
  return scene;
}

/// A unit mass that hits the floor under an overhang (N1 at 120 degrees from N0) from which it
/// separates: the Newton form and the notes' form gain energy.
inline Scene overhang(double e) {
  Scene scene;
  const int mass = scene.add(ball(), Vec3::Zero(), {Vec3(0, -1, 0), Vec3::Zero()});
  const int ground = scene.add(fixed_body(), Vec3(0, -1, 0));
  scene.touch(mass, ground, Vec3::Zero(), Vec3(0, 1, 0), e);
  scene.touch(mass, ground, Vec3::Zero(), Vec3(0.5 * std::sqrt(3.0), -0.5, 0), e);
  return scene;
}

/// A rod on two supports at x = -1 and x = 1, hit from above at x = b by a ball of speed s. The
/// contacts: left support, right support, ball.
inline Scene rod_on_two_supports(double b, double s, double e) {
  Scene scene;
  const int rod = scene.add(box(1.0, Vec3(4.0, 0.1, 0.1)), Vec3::Zero());
  const int ground = scene.add(fixed_body(), Vec3::Zero());
  const int hammer = scene.add(ball(), Vec3(b, 0.55, 0), {Vec3(0, -s, 0), Vec3::Zero()});
  scene.touch(rod, ground, Vec3(-1, -0.05, 0), Vec3::UnitY(), e);
  scene.touch(rod, ground, Vec3(1, -0.05, 0), Vec3::UnitY(), e);
  scene.touch(hammer, rod, Vec3(b, 0.05, 0), Vec3::UnitY(), e);
  return scene;
}

inline Vec3 random_vector(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

/// `dynamic` bodies in any pose and motion, one fixed and one kinematic, with random contacts
/// between them.
inline Scene random_scene(std::mt19937_64& random, int dynamic, int contacts) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Scene scene;
  for (int i = 0; i < dynamic + 2; ++i) {
    Body body = box(std::pow(10.0, uniform(random)), Vec3(1.0, 0.5 + uniform(random), 2.0));
    if (i >= dynamic) {
      body.kind = i == dynamic ? BodyKind::kFixed : BodyKind::kKinematic;
    }
    scene.add(body, random_vector(random));
    scene.state.back().q =
        Quat(uniform(random) + 0.1, uniform(random), uniform(random), uniform(random)).normalized();
    set_velocity(body, {random_vector(random), random_vector(random)}, scene.state.back());
  }
  std::uniform_int_distribution<int> any(0, dynamic + 1);
  std::uniform_int_distribution<int> any_dynamic(0, dynamic - 1);
  while (static_cast<int>(scene.contacts.size()) < contacts) {
    const int a = any(random);
    const int b = any_dynamic(random);
    if (a != b) {
      const bool swapped = uniform(random) < 0.5;
      scene.touch(swapped ? b : a, swapped ? a : b, random_vector(random),
                  random_vector(random).normalized(), uniform(random));
    }
  }
  return scene;
}

}  // namespace signorini::scenes
