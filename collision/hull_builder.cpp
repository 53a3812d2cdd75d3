#include <signorini/collision/hull.h>
#include <signorini/collision/hull_builder.h>
#include <signorini/core/model/number_text.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace signorini::collision {
namespace {

/// Qhull's state; frees what Qhull allocated.
class Qhull {
 public:
  explicit Qhull(std::vector<double>& coordinates) : log_(std::tmpfile(), &std::fclose) {
    if (log_ == nullptr) {
      throw std::runtime_error("hull: no temporary file for Qhull's messages");
    }
    qh_zero(&state_, log_.get());
    char command[] = "qhull Pp";
    failure_ = qh_new_qhull(&state_, 3, static_cast<int>(coordinates.size() / 3),
                            coordinates.data(), False, command, nullptr, log_.get());
  }
  ~Qhull() {
    qh_freeqhull(&state_, qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&state_, &current, &total);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  [[nodiscard]] int failure() const { return failure_; }
  /// The faces as loops of point numbers, counter-clockwise from outside.
  [[nodiscard]] std::vector<std::vector<int>> faces() {
    std::vector<std::vector<int>> result;
    qhT* const qh = &state_;  // the name that Qhull's macros want
    facetT* facet = nullptr;
    FORALLfacets {
      setT* const around = qh_facet3vertex(qh, facet);
      std::vector<int>& loop = result.emplace_back();
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      FOREACHvertex_(around) {
        loop.push_back(qh_pointid(qh, vertex->point));
      }
      qh_settempfree(qh, const_cast<setT**>(&around));
      std::reverse(loop.begin(), loop.end());  // Qhull's run clockwise (qh_ORIENTclock)
    }
    return result;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> log_;
  qhT state_{};
  int failure_ = 0;
};

/// Drops the points that no face uses.
ConvexHull of_used_points(const std::vector<Vec3>& points, std::vector<std::vector<int>> faces) {
  std::vector<int> number(points.size(), -1);
  for (const std::vector<int>& loop : faces) {
    for (const int v : loop) {
      number[v] = 0;
    }
  }
  std::vector<Vec3> vertices;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (number[v] == 0) {
      number[v] = static_cast<int>(vertices.size());
      vertices.push_back(points[v]);
    }
  }
  for (std::vector<int>& loop : faces) {
    for (int& v : loop) {
      v = number[v];
    }
  }
  return make_hull(std::move(vertices), std::move(faces));
}

}  // namespace

ConvexHull hull_of_points(const std::vector<Vec3>& points) {
  if (points.size() < 4) {
    throw std::invalid_argument("hull: points: must be at least 4, got " +
                                std::to_string(points.size()));
  }
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) {
      throw std::invalid_argument("hull: point " + std::to_string(i) + ": must be finite, got " +
                                  number_text(points[i]));
    }
    coordinates.insert(coordinates.end(), points[i].data(), points[i].data() + 3);
  }
  Qhull qhull(coordinates);
  if (qhull.failure() != 0) {
    throw std::invalid_argument("hull: points: must not lie in a plane (Qhull ends with code " +
                                std::to_string(qhull.failure()) + ")");
  }
  return of_used_points(points, qhull.faces());
}

}  // namespace signorini::collision
