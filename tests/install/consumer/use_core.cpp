#include <signorini/core/response/single_impulse.h>

int main() {
  signorini::Bodies bodies(2);
  bodies[1].kind = signorini::BodyKind::kFixed;
  signorini::State state(2);
  state[0].p = signorini::Vec3(0.0, 0.0, -1.0);
  signorini::Contact contact;
  contact.body_a = 0;
  contact.body_b = 1;
  contact.point_a = contact.point_b = signorini::Vec3::Zero();
  contact.normal = signorini::Vec3::UnitZ();
  contact.gap = 0.0;
  return signorini::single_impulse(bodies, state, contact).f_min == 1.0 ? 0 : 1;
}
