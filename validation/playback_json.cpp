#include <signorini/validation/playback_json.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

namespace signorini::validation {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 32767.0;  ///< of 16 bits, on either side of the middle

/// Numbers to look at: 7 digits.
double rounded(double value) {
  return std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr);
}

template <typename Numbers>
Json numbers(const Numbers& values) {
  Json result = Json::array();
  for (const double value : values) result.push_back(rounded(value));
  return result;
}

/// The values x of a track as x = middle + step k with k in [-32767, 32767].
class Quantiser {
 public:
  void include(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  void finish() {
    if (low_ > high_) low_ = high_ = 0.0;
    middle_ = rounded(0.5 * low_ + 0.5 * high_);
    // Rounded upwards, so that the ends stay inside.
    step_ = rounded(std::max(high_ - middle_, middle_ - low_) / kSteps * (1.0 + 1e-6));
  }
  [[nodiscard]] double middle() const { return middle_; }
  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] std::int16_t operator()(double value) const {
    if (!(step_ > 0.0)) return 0;
    return static_cast<std::int16_t>(
        std::lround(std::clamp((value - middle_) / step_, -kSteps, kSteps)));
  }

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double middle_ = 0.0;
  double step_ = 0.0;
};

/// 16-bit integers, low byte first, as base64 (RFC 4648, with padding).
class Packed {
 public:
  void add(std::uint16_t value) {
    bytes_.push_back(static_cast<unsigned char>(value & 0xffU));
    bytes_.push_back(static_cast<unsigned char>(value >> 8U));
  }
  void add(std::int16_t value) { add(static_cast<std::uint16_t>(value)); }

  [[nodiscard]] std::string base64() const {
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes_.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes_.size(); i += 3) {
      const std::size_t count = std::min<std::size_t>(3, bytes_.size() - i);
      std::uint32_t group = 0;
      for (std::size_t k = 0; k < 3; ++k) group = (group << 8U) | (k < count ? bytes_[i + k] : 0U);
      for (std::size_t k = 0; k < 4; ++k) {
        text += k <= count ? kAlphabet[(group >> (18U - 6U * k)) & 63U] : '=';
      }
    }
    return text;
  }

 private:
  std::vector<unsigned char> bytes_;
};

Json poses_json(const Playback::PlaybackTrack& track) {
  const std::size_t count = track.frames.empty() ? 0 : track.frames.front().poses.size();
  std::vector<std::array<Quantiser, 3>> axes(count);
  for (const Playback::Frame& frame : track.frames) {
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) axes[i][k].include(frame.poses[i].position[k]);
    }
  }
  Json middle = Json::array();
  Json step = Json::array();
  for (std::array<Quantiser, 3>& body : axes) {
    for (Quantiser& axis : body) {
      axis.finish();
      middle.push_back(axis.middle());
      step.push_back(axis.step());
    }
  }
  Packed data;
  for (const Playback::Frame& frame : track.frames) {
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) data.add(axes[i][k](frame.poses[i].position[k]));
      for (const double q : frame.poses[i].orientation) {
        data.add(static_cast<std::int16_t>(std::lround(kSteps * std::clamp(q, -1.0, 1.0))));
      }
    }
  }
  return {{"middle", middle}, {"step", step}, {"data", data.base64()}};
}

Json contacts_json(const Playback::PlaybackTrack& track) {
  std::array<Quantiser, 3> point;
  double greatest = 0.0;
  Json count = Json::array();
  Json all = Json::array();
  for (const Playback::Frame& frame : track.frames) {
    count.push_back(frame.contacts.size());
    all.push_back(frame.all_contacts);
    for (const Playback::DrawnContact& contact : frame.contacts) {
      for (int k = 0; k < 3; ++k) {
        point[k].include(contact.point[k]);
        greatest = std::max(greatest, std::abs(contact.force[k]));
      }
    }
  }
  for (Quantiser& axis : point) axis.finish();
  Quantiser force;
  force.include(-greatest);
  force.include(greatest);
  force.finish();
  Packed bodies;
  Packed data;
  for (const Playback::Frame& frame : track.frames) {
    for (const Playback::DrawnContact& contact : frame.contacts) {
      bodies.add(static_cast<std::uint16_t>(contact.body_a));
      bodies.add(static_cast<std::uint16_t>(contact.body_b));
      for (int k = 0; k < 3; ++k) data.add(point[k](contact.point[k]));
      for (int k = 0; k < 3; ++k) data.add(force(contact.force[k]));
    }
  }
  return {{"count", count},
          {"count_whole", all},
          {"point_middle", {point[0].middle(), point[1].middle(), point[2].middle()}},
          {"point_step", {point[0].step(), point[1].step(), point[2].step()}},
          {"force_step", force.step()},
          {"bodies", bodies.base64()},
          {"data", data.base64()}};
}

Json track_json(const Playback::PlaybackTrack& track) {
  Json time = Json::array();
  for (const Playback::Frame& frame : track.frames) time.push_back(rounded(frame.time));
  return {{"engine", track.engine},
          {"time", time},
          {"poses", poses_json(track)},
          {"contacts", contacts_json(track)}};
}

Json body_json(const Playback::DrawnBody& body) {
  return {{"name", body.name},
          {"kind", body.kind},
          {"position", numbers(body.initial.position)},
          {"orientation", numbers(body.initial.orientation)}};
}

Json shape_json(const Playback::DrawnShape& shape) {
  return {{"name", shape.name},
          {"body", shape.body},
          {"kind", shape.kind},
          {"sizes", numbers(shape.sizes)},
          {"surface", shape.surface < 0 ? Json(nullptr) : Json(shape.surface)},
          {"position", numbers(shape.local.position)},
          {"orientation", numbers(shape.local.orientation)}};
}

Json joint_json(const Playback::DrawnJoint& joint) {
  return {{"name", joint.name},
          {"kind", joint.kind},
          {"body_a", joint.body_a},
          {"body_b", joint.body_b},
          {"anchor_a", numbers(joint.anchor_a)},
          {"anchor_b", numbers(joint.anchor_b)}};
}

Json surface_json(const Playback::Surface& surface) {
  Json vertices = Json::array();
  for (const auto& vertex : surface.vertices) {
    for (const double x : vertex) vertices.push_back(rounded(x));
  }
  Json triangles = Json::array();
  for (const auto& triangle : surface.triangles) {
    for (const int vertex : triangle) triangles.push_back(vertex);
  }
  return {{"vertices", vertices},
          {"triangles", triangles},
          {"triangles_whole", surface.whole_triangles}};
}

}  // namespace

Json playback_json(const Playback& playback) {
  Json result = {{"gravity", numbers(playback.gravity)},
                 {"bodies", Json::array()},
                 {"shapes", Json::array()},
                 {"joints", Json::array()},
                 {"surfaces", Json::array()},
                 {"tracks", Json::array()}};
  for (const auto& body : playback.bodies) result["bodies"].push_back(body_json(body));
  for (const auto& shape : playback.shapes) result["shapes"].push_back(shape_json(shape));
  for (const auto& joint : playback.joints) result["joints"].push_back(joint_json(joint));
  for (const auto& surface : playback.surfaces) result["surfaces"].push_back(surface_json(surface));
  for (const auto& track : playback.tracks) result["tracks"].push_back(track_json(track));
  return result;
}

}  // namespace signorini::validation
