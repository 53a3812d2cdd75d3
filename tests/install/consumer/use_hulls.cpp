#include <signorini/collision/hull_builder.h>

int main() {
  const signorini::collision::ConvexHull hull = signorini::collision::hull_of_points(
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {0.1, 0.1, 0.1}});
  return hull.data != nullptr ? 0 : 1;
}
