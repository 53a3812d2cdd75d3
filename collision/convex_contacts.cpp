#include <signorini/collision/convex_contacts.h>
#include <signorini/collision/facet_clip.h>
#include <signorini/collision/narrow.h>
#include <signorini/collision/polyhedron_separation.h>
#include <signorini/collision/separation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace signorini::collision {
namespace {

using Kind = Stratum::Kind;

/// Lines within this angle (radians) of parallel touch along a stretch, not in a point.
constexpr double kParallelLines = 1e-7;

/// The pieces of a contact, in the order of A and B.
struct Side {
  Vec3 point = Vec3::Zero();  ///< of the rounded shape
  Feature feature = 0;
  LocalSurface surface;
};

Contact between(const Side& a, const Side& b, const Vec3& N, double gap, NormalOwner owner) {
  Contact contact =
      narrow::make_contact(a.point, b.point, N, gap, feature_pair_id(a.feature, b.feature), owner);
  contact.surface_a = a.surface;
  contact.surface_b = b.surface;
  return contact;
}

/// What a query works on: kept from query to query of a thread.
struct ContactMemory {
  Separation separation;
  Facet reference;
  Facet incident;
  std::vector<FacetPoint> points;
};

ContactMemory& memory() {
  thread_local ContactMemory of_this_thread;
  return of_this_thread;
}

// A face meets the other shape.

struct FaceContacts {
  bool of_a;
  Vec3 outward;     ///< of the face
  double rounding;  ///< of the other shape
  double highest;   ///< contacts above it are left out, m
  std::vector<Contact>& contacts;

  void add(const Vec3& on_face, Feature face, const Vec3& core, double height, Feature incident,
           const LocalSurface& surface) {
    const double gap = height - rounding;
    if (gap > highest) {
      return;
    }
    const Side reference{on_face, face, LocalSurface::face()};
    const Side other{core - rounding * outward, incident, surface};
    contacts.push_back(of_a ? between(reference, other, -outward, gap, NormalOwner::kFaceA)
                            : between(other, reference, outward, gap, NormalOwner::kFaceB));
  }
};

/// The free piece of a shape's surface that reaches furthest along n.
Stratum piece_towards(const Convex& shape, const Vec3& n) {
  thread_local std::vector<Stratum> pieces;
  pieces.clear();
  shape.add_strata(n, 0.0, pieces);
  const Stratum* best = nullptr;
  for (const Stratum& piece : pieces) {
    if (piece.is_free() && (best == nullptr || n.dot(piece.point(n)) > n.dot(best->point(n)))) {
      best = &piece;
    }
  }
  return *best;
}

/// The other shape's point nearest to the face's plane, and its piece of surface.
struct Deepest {
  Stratum piece;
  Vec3 core;
  LocalSurface surface;

  Deepest(const Convex& shape, const Vec3& towards)
      : piece(piece_towards(shape, towards)), core(shape.support(towards)) {
    const bool is_flat = piece.kind == Kind::kRim && core.isApprox(piece.anchor, 0.0);
    surface = is_flat ? LocalSurface::vertex() : piece.surface(towards, core, shape.rounding());
  }
};

double least_gap(const std::vector<Contact>& contacts, std::size_t first) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k < contacts.size(); ++k) {
    least = std::min(least, contacts[k].gap);
  }
  return least;
}

// Two lines.

/// A line of a shape as a segment of its core.
struct Segment {
  const Stratum& line;
  Vec3 outward;
  Vec3 direction;
  Vec3 origin;
  double rounding;

  Segment(const Convex& shape, const Stratum& stratum, const Vec3& n)
      : line(stratum),
        outward(n),
        direction(stratum.direction(n)),
        origin(stratum.line_point(n)),
        rounding(shape.rounding()) {}

  [[nodiscard]] Vec3 at(double t) const { return origin + t * direction; }
  [[nodiscard]] Side middle(double t) const {
    return {at(t) + rounding * outward, line.feature, line.surface(outward, at(t), rounding)};
  }
  /// Its end (0: low, 1: high): a vertex, a rim or a ball.
  [[nodiscard]] Side end(int which) const {
    const Vec3 core = at(line.range[which]);
    LocalSurface surface{Vec3::UnitX(), rounding, rounding};
    if (line.end_radii[which] > 0.0) {
      const Vec3 out = outward - outward.dot(line.axis) * line.axis;
      surface = {line.axis.cross(out).normalized(), line.end_radii[which] / out.norm(), 0.0};
    }
    return {core + rounding * outward, line.ends[which], surface};
  }
};

/// The ends of the stretch along which two parallel lines face each other.
void find_on_parallel_lines(const Segment& a, const Segment& b, const Vec3& N, double margin,
                            double slack, std::vector<Contact>& contacts) {
  const double same_way = a.direction.dot(b.direction) < 0.0 ? -1.0 : 1.0;
  const double shift = a.direction.dot(b.origin - a.origin);  // of b's origin, along a
  for (const int end : {0, 1}) {
    const int end_b = same_way > 0.0 ? end : 1 - end;
    const double of_a = a.line.range[end];
    const double of_b = shift + same_way * b.line.range[end_b];
    const bool is_end_of_a = end == 0 ? of_a >= of_b - slack : of_a <= of_b + slack;
    const double t = is_end_of_a ? of_a : of_b;
    Side side_a = is_end_of_a ? a.end(end) : a.middle(t);
    Side side_b = is_end_of_a ? b.middle(same_way * (t - shift)) : b.end(end_b);
    const double gap = N.dot(side_a.point - side_b.point);
    side_b.point = side_a.point - gap * N;
    if (gap <= margin) {
      contacts.push_back(between(side_a, side_b, N, gap, NormalOwner::kCurved));
    }
  }
}

/// The nearest points of two lines, held within their ends (of parallel lines that do not face each
/// other: of their ends). Returns how far they are from lying across each other.
double cross(const Segment& a, const Segment& b, const Vec3& N, double distance, Contact& contact) {
  const Vec3& u = a.direction;
  const Vec3& v = b.direction;
  const Vec3 offset = b.origin - a.origin;
  const double sine_squared = u.cross(v).squaredNorm();
  const double crossing = sine_squared > 0.0 ? (u - u.dot(v) * v).dot(offset) / sine_squared : 0.0;
  const double s0 = std::clamp(crossing, a.line.range[0], a.line.range[1]);
  const double t = std::clamp(v.dot(s0 * u - offset), b.line.range[0], b.line.range[1]);
  const double s = std::clamp(u.dot(offset + t * v), a.line.range[0], a.line.range[1]);
  Side side_a = a.middle(s);
  Side side_b = b.middle(t);
  const Vec3 middle = 0.5 * (side_a.point + side_b.point);
  const double misfit = (side_a.point - side_b.point - distance * N).norm();
  side_a.point = middle + 0.5 * distance * N;
  side_b.point = middle - 0.5 * distance * N;
  const auto is_edge = [](const Segment& segment) {
    return segment.line.slope == 0.0 && segment.line.radius == 0.0 && segment.rounding == 0.0;
  };
  contact = between(side_a, side_b, N, distance,
                    is_edge(a) && is_edge(b) ? NormalOwner::kEdgeEdge : NormalOwner::kCurved);
  return misfit;
}

// One point.

/// The surface of a shape at a point of its core, by the piece that carries the normal.
Side side_of(const Convex& shape, const Stratum& piece, const Vec3& outward, const Vec3& core) {
  return {core + shape.rounding() * outward, piece.feature,
          piece.surface(outward, core, shape.rounding())};
}

/// How far a point is from a piece that carries the normal; beside a face: +infinity.
double distance_to(const Convex& shape, const Stratum& piece, const Vec3& outward,
                   const Vec3& core) {
  if (piece.is_free()) {
    return (core - piece.point(outward)).norm();
  }
  if (piece.kind == Kind::kFace) {
    Facet& facet = memory().reference;
    shape.facet(outward, facet);
    return is_over(facet, core, 1e-6 * shape.size()) ? 0.0
                                                     : std::numeric_limits<double>::infinity();
  }
  const Vec3 origin = piece.line_point(outward);
  const Vec3 direction = piece.direction(outward);
  const double t = std::clamp(direction.dot(core - origin), piece.range[0], piece.range[1]);
  return (core - origin - t * direction).norm();
}

/// The point of the free piece, and the other shape's across it. Returns how far that is from the
/// other piece.
double meet_at_point(const Convex& a, const Convex& b, const Meeting& meeting, double distance,
                     Contact& contact) {
  const Vec3& N = meeting.normal;
  const double cores = distance + a.rounding() + b.rounding();
  const bool from_a = meeting.a.is_free();
  const Vec3 core_b = from_a ? Vec3(meeting.a.point(-N) - cores * N)
                             : (meeting.b.is_free() ? meeting.b.point(N) : b.support(N));
  const Vec3 core_a = core_b + cores * N;
  NormalOwner owner = NormalOwner::kCurved;
  if (meeting.a.kind == Kind::kFace || meeting.b.kind == Kind::kFace) {
    owner = meeting.a.kind == Kind::kFace ? NormalOwner::kFaceA : NormalOwner::kFaceB;
  }
  contact = between(side_of(a, meeting.a, -N, core_a), side_of(b, meeting.b, N, core_b), N,
                    distance, owner);
  return from_a ? distance_to(b, meeting.b, N, core_b) : distance_to(a, meeting.a, -N, core_a);
}

/// The one contact of two pieces, and how far they are from meeting there.
double meet(const Convex& a, const Convex& b, const Meeting& meeting, double distance,
            Contact& contact) {
  if (meeting.a.kind == Kind::kLine && meeting.b.kind == Kind::kLine) {
    return cross(Segment(a, meeting.a, -meeting.normal), Segment(b, meeting.b, meeting.normal),
                 meeting.normal, distance, contact);
  }
  return meet_at_point(a, b, meeting, distance, contact);
}

/// Two parallel lines that face each other along a stretch.
bool are_parallel(const Convex& a, const Convex& b, const Meeting& meeting) {
  if (meeting.a.kind != Kind::kLine || meeting.b.kind != Kind::kLine) {
    return false;
  }
  const Segment line_a(a, meeting.a, -meeting.normal);
  const Segment line_b(b, meeting.b, meeting.normal);
  if (line_a.direction.cross(line_b.direction).norm() > kParallelLines) {
    return false;
  }
  const Vec3& u = line_a.direction;
  const Vec3 between_lines = line_a.origin - line_b.origin;
  const Vec3 across = between_lines - between_lines.dot(u) * u;
  const double beside = (across - across.dot(meeting.normal) * meeting.normal).norm();
  const double first = u.dot(line_b.at(meeting.b.range[0]) - line_a.origin);
  const double last = u.dot(line_b.at(meeting.b.range[1]) - line_a.origin);
  return beside <= preference_tolerance(a, b) &&
         std::max(std::min(first, last), meeting.a.range[0]) <
             std::min(std::max(first, last), meeting.a.range[1]);
}

/// The contact set of a preferred face. False, and nothing added, where the face misses the deepest
/// point (a rim beside its edge).
bool find_all_on_face(const Convex& a, const Convex& b, const FacingFace& face, double distance,
                      double margin, std::vector<Contact>& contacts) {
  const std::size_t before = contacts.size();
  const double enough = distance + preference_tolerance(a, b);
  find_contacts_on_face(a, b, face, margin, contacts);
  if (margin < enough && !(least_gap(contacts, before) <= enough)) {
    // Of faces nearly flush all points that are found may lie a little above the margin.
    contacts.resize(before);
    find_contacts_on_face(a, b, face, enough, contacts);
  }
  if (least_gap(contacts, before) <= enough) {
    return true;
  }
  contacts.resize(before);
  return false;
}

/// What the separating axes of two polyhedra say.
enum class AxesSay { kAll, kTouching, kNothing };

/// kAll: the contact set is complete. kTouching: they are no further apart than the margin, but the
/// set is not found here.
AxesSay find_polyhedron_contacts(const Convex& a, const Convex& b, double margin,
                                 std::vector<Contact>& contacts) {
  PolyhedronSeparation found;
  separate_polyhedra(a, b, found);
  if (found.separation > margin) {
    return AxesSay::kAll;
  }
  if (!found.is_distance) {
    return AxesSay::kNothing;
  }
  if (found.face) {
    return find_all_on_face(a, b, *found.face, found.separation, margin, contacts)
               ? AxesSay::kAll
               : AxesSay::kTouching;
  }
  Contact contact;
  if (meet(a, b, found.edges, found.separation, contact) > preference_tolerance(a, b)) {
    return AxesSay::kTouching;
  }
  contacts.push_back(contact);
  return AxesSay::kAll;
}

}  // namespace

void find_contacts_on_face(const Convex& a, const Convex& b, const FacingFace& face, double margin,
                           std::vector<Contact>& contacts) {
  const Convex& owner = face.of_a ? a : b;
  const Convex& other = face.of_a ? b : a;
  const Vec3 outward = face.of_a ? Vec3(-face.normal) : face.normal;
  const double slack = preference_tolerance(a, b);
  Facet& reference = memory().reference;
  Facet& incident = memory().incident;
  std::vector<FacetPoint>& points = memory().points;
  owner.facet(outward, reference);
  other.facet(-outward, incident);
  clip_facet(incident, reference, slack, points);

  // Rounding of the heights must not lose the contacts of shapes that are margin apart.
  const double last_digits = 16.0 * std::numeric_limits<double>::epsilon() * (a.size() + b.size());
  const double highest = std::max(margin, face.separation + last_digits);
  FaceContacts found{face.of_a, outward, other.rounding(), highest, contacts};
  const std::size_t first = contacts.size();
  for (const FacetPoint& point : points) {
    found.add(point.on_reference, point.reference, point.on_incident, point.height, point.incident,
              point.surface);
  }
  if (!(face.separation < least_gap(contacts, first) - slack)) {
    return;
  }
  const Deepest deepest(other, -outward);
  if (is_over(reference, deepest.core, slack)) {
    const double height = face.separation + other.rounding();
    found.add(deepest.core - height * outward, reference.face, deepest.core, height,
              deepest.piece.feature, deepest.surface);
  }
}

void find_contacts(const Convex& a, const Convex& b, double margin,
                   std::vector<Contact>& contacts) {
  AxesSay axes = AxesSay::kNothing;
  if (a.polyhedron() != nullptr && b.polyhedron() != nullptr) {
    axes = find_polyhedron_contacts(a, b, margin, contacts);
  }
  if (axes == AxesSay::kAll) {
    return;
  }
  Separation& found = memory().separation;
  separate(a, b, found);
  find_contacts(a, b, found, axes == AxesSay::kTouching ? std::max(margin, found.distance) : margin,
                contacts);
}

void find_contacts(const Convex& a, const Convex& b, const Separation& found, double margin,
                   std::vector<Contact>& contacts) {
  if (found.distance > margin ||
      (found.face && find_all_on_face(a, b, *found.face, found.distance, margin, contacts))) {
    return;
  }
  const std::size_t before = contacts.size();
  double least = std::numeric_limits<double>::infinity();
  Contact nearest;
  for (const Meeting& meeting : found.meetings) {
    if (are_parallel(a, b, meeting)) {
      find_on_parallel_lines(
          Segment(a, meeting.a, -meeting.normal), Segment(b, meeting.b, meeting.normal),
          meeting.normal, std::max(margin, found.distance), preference_tolerance(a, b), contacts);
      if (contacts.size() > before) {
        return;
      }
    }
    Contact contact;
    const double misfit = meet(a, b, meeting, found.distance, contact);
    if (misfit < least || !std::isfinite(nearest.gap)) {
      least = misfit;
      nearest = contact;
    }
    if (misfit <= preference_tolerance(a, b)) {
      break;
    }
  }
  contacts.push_back(nearest);
}

void find_contacts(const Convex& a, const Vec3& n, const Vec3& on_plane, double margin,
                   std::vector<Contact>& contacts) {
  const Deepest deepest(a, -n);
  const double least = n.dot(deepest.core - on_plane) - a.rounding();
  if (least > margin) {
    return;
  }
  FaceContacts found{false, n, a.rounding(), margin, contacts};
  const std::size_t first = contacts.size();
  const auto add = [&](const Vec3& core, Feature feature, const LocalSurface& surface) {
    const double height = n.dot(core - on_plane);
    found.add(core - height * n, 0, core, height, feature, surface);
  };
  Facet& facet = memory().reference;
  a.facet(-n, facet);
  for (const FacetCorner& corner : facet.corners) {
    add(corner.point, corner.feature, corner.surface);
  }
  if (least < least_gap(contacts, first) - 1e-6 * a.size()) {
    add(deepest.core, deepest.piece.feature, deepest.surface);
  }
}

}  // namespace signorini::collision
