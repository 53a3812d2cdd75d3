#include <signorini/collision/pair_query.h>

int main() {
  const signorini::collision::Shape ball = signorini::collision::Sphere{0.5};
  const signorini::Pose here;
  const signorini::Pose there{signorini::Vec3(2.0, 0.0, 0.0), signorini::Quat::Identity()};
  return signorini::collision::signed_distance(ball, here, ball, there) == 1.0 ? 0 : 1;
}
