#include <signorini/core/model/contact_kinematics.h>

namespace signorini {

ContactClass classify(double d_dot, double threshold) {
  if (d_dot < -threshold) {
    return ContactClass::kColliding;
  }
  return d_dot > threshold ? ContactClass::kSeparating : ContactClass::kResting;
}

}  // namespace signorini
