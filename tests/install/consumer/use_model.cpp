#include <signorini/core/model/body.h>

int main() {
  const signorini::Body body = {.mass = 2.0, .inertia = signorini::Mat3::Identity()};
  signorini::BodyState state;
  set_velocity(body, {.linear = signorini::Vec3::UnitX()}, state);
  return state.p.x() == 2.0 ? 0 : 1;
}
