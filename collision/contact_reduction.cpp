#include <signorini/collision/contact_reduction.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini::collision {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kSameNormal = 1e-6;
/// Relative to the patch's diameter (squared: to its square).
constexpr double kSameDepth = 1e-6;
constexpr double kSameArea = 1e-6;
constexpr double kStraight = 1e-12;

/// A contact seen along the normal of its patch.
struct Point {
  Vec2 at;
  int contact;
};

double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 p = b - a;
  const Vec2 q = c - a;
  return p.x() * q.y() - p.y() * q.x();
}

double area_of(const std::vector<Point>& polygon) {
  double sum = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    sum += doubled_area(polygon[0].at, polygon[k - 1].at, polygon[k].at);
  }
  return 0.5 * sum;
}

struct Memory {
  std::vector<int> patch;
  std::vector<unsigned char> is_done;
  std::vector<unsigned char> stays;
  std::vector<Point> points;
  std::vector<Point> hull;
};

bool are_of_one_patch(const Contact& p, const Contact& q) {
  return p.body_a == q.body_a && p.body_b == q.body_b &&
         (p.normal - q.normal).norm() <= kSameNormal;
}

class Patch {
 public:
  Patch(const std::vector<Contact>& contacts, Memory& memory)
      : contacts_(contacts), patch_(memory.patch), points_(memory.points), hull_(memory.hull) {
    const Contact& first = contacts_[patch_[0]];
    const Vec3 u = first.normal.unitOrthogonal();
    const Vec3 v = first.normal.cross(u);
    points_.clear();
    for (const int k : patch_) {
      const Vec3 from_first = contacts_[k].point_a - first.point_a;
      points_.push_back({{u.dot(from_first), v.dot(from_first)}, k});
      diameter_ = std::max(diameter_, 2.0 * points_.back().at.norm());
    }
    make_hull_of_points();
    area_ = area_of(hull_);
  }

  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] double hull_area() const { return area_of(hull_); }

  /// Marks those that stay.
  void reduce(int most, std::vector<unsigned char>& stays) {
    const double as_deep = deepest_gap() + kSameDepth * diameter_;
    const auto is_deep = [&](const Point& p) { return contacts_[p.contact].gap <= as_deep; };
    auto deep_corners = std::count_if(hull_.begin(), hull_.end(), is_deep);
    std::size_t corners = static_cast<std::size_t>(most);
    if (deep_corners == 0) {
      stays[deepest_contact()] = 1;
      --corners;
    }
    while (hull_.size() > corners) {
      const int k =
          cheapest_corner([&](const Point& p) { return deep_corners == 1 && is_deep(p); });
      deep_corners -= is_deep(hull_[k]) ? 1 : 0;
      hull_.erase(hull_.begin() + k);
    }
    for (const Point& point : hull_) {
      stays[point.contact] = 1;
    }
  }

 private:
  /// Andrew's monotone chain; corners of less than kStraight diameter^2 are none.
  void make_hull_of_points() {
    std::sort(points_.begin(), points_.end(), [](const Point& p, const Point& q) {
      return p.at.x() != q.at.x()
                 ? p.at.x() < q.at.x()
                 : (p.at.y() != q.at.y() ? p.at.y() < q.at.y() : p.contact < q.contact);
    });
    const double straight = kStraight * diameter_ * diameter_;
    hull_.clear();
    const auto add_chain = [&](auto begin, auto end) {
      const std::size_t start = hull_.size();
      for (auto point = begin; point != end; ++point) {
        while (hull_.size() >= start + 2 &&
               doubled_area(hull_[hull_.size() - 2].at, hull_.back().at, point->at) <= straight) {
          hull_.pop_back();
        }
        hull_.push_back(*point);
      }
      hull_.pop_back();  // the next chain begins with it
    };
    if (points_.size() == 1 || !(diameter_ > 0.0)) {
      hull_.push_back(points_.front());
      return;
    }
    add_chain(points_.begin(), points_.end());
    add_chain(points_.rbegin(), points_.rend());
  }

  [[nodiscard]] double deepest_gap() const {
    double least = contacts_[patch_[0]].gap;
    for (const int k : patch_) {
      least = std::min(least, contacts_[k].gap);
    }
    return least;
  }

  /// Of those equally deep the one with the least id.
  [[nodiscard]] int deepest_contact() const {
    return *std::min_element(patch_.begin(), patch_.end(), [&](int p, int q) {
      const Contact& a = contacts_[p];
      const Contact& b = contacts_[q];
      return a.gap != b.gap ? a.gap < b.gap : a.feature_id < b.feature_id;
    });
  }

  /// The corner that costs the least area, of those that may leave.
  template <class MustStay>
  [[nodiscard]] int cheapest_corner(MustStay&& must_stay) const {
    const int n = static_cast<int>(hull_.size());
    int best = -1;
    double least = 0.0;
    for (int k = 0; k < n; ++k) {
      if (must_stay(hull_[k])) {
        continue;
      }
      const double cost =
          0.5 * doubled_area(hull_[(k + n - 1) % n].at, hull_[k].at, hull_[(k + 1) % n].at);
      const double tie = kSameArea * area_;
      const bool is_tied = best >= 0 && std::abs(cost - least) <= tie;
      if (best < 0 || cost < least - tie ||
          (is_tied &&
           contacts_[hull_[k].contact].feature_id > contacts_[hull_[best].contact].feature_id)) {
        best = k;
        least = cost;
      }
    }
    return best;
  }

  const std::vector<Contact>& contacts_;
  const std::vector<int>& patch_;
  std::vector<Point>& points_;
  std::vector<Point>& hull_;
  double diameter_ = 0.0;
  double area_ = 0.0;
};

}  // namespace

ReductionLoss reduce_contacts(std::vector<Contact>& contacts, int most) {
  if (most < 3) {
    throw std::invalid_argument("reduce_contacts: most: must be >= 3, got " + std::to_string(most));
  }
  thread_local Memory memory;
  const int count = static_cast<int>(contacts.size());
  memory.is_done.assign(count, 0);
  memory.stays.assign(count, 0);
  ReductionLoss loss;
  for (int i = 0; i < count; ++i) {
    if (memory.is_done[i] != 0) {
      continue;
    }
    memory.patch.clear();
    for (int k = i; k < count; ++k) {
      if (memory.is_done[k] == 0 && are_of_one_patch(contacts[i], contacts[k])) {
        memory.is_done[k] = 1;
        memory.patch.push_back(k);
      }
    }
    Patch patch(contacts, memory);
    loss.area_before += patch.area();
    patch.reduce(most, memory.stays);
    loss.area_after += patch.hull_area();
  }
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    if (memory.stays[k] != 0) {
      contacts[kept++] = contacts[k];
    }
  }
  contacts.resize(kept);
  loss.points = count - kept;
  return loss;
}

}  // namespace signorini::collision
