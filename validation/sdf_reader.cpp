#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/sdf_survey.h>
#include <signorini/validation/urdf_extras.h>
#include <signorini/validation/xml_check.h>

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <mutex>
#include <regex>
#include <sdf/sdf.hh>
#include <set>
#include <sstream>
#include <tinyxml2.h>

namespace signorini::validation {
namespace {

Vec3 vector(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

Pose to_pose(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  return {vector(pose.Pos()), Quat(q.W(), q.X(), q.Y(), q.Z()).normalized()};
}

Mat3 matrix(const ignition::math::Matrix3d& m) {
  Mat3 result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result(i, j) = m(i, j);
  }
  return result;
}

/// Three numbers that check_numbers() has seen; libsdformat keeps the text of unknown elements.
Vec3 numbers(const sdf::Element& element) {
  std::istringstream stream(element.GetValue()->GetAsString());
  stream.imbue(std::locale::classic());
  Vec3 v = Vec3::Zero();
  stream >> v.x() >> v.y() >> v.z();
  return v;
}

std::string squeezed(const std::string& text) {
  return std::regex_replace(std::regex_replace(text, std::regex("\\s+"), " "), std::regex("^ | $"),
                            "");
}

/// libsdformat writes its warnings to a global stream: held back while this lives, one line each.
class ConsoleCapture {
 public:
  ConsoleCapture() : lock_(mutex_) { stream().SetStream(&text_); }
  ~ConsoleCapture() { stream().SetStream(&std::cerr); }
  ConsoleCapture(const ConsoleCapture&) = delete;
  ConsoleCapture& operator=(const ConsoleCapture&) = delete;

  [[nodiscard]] std::vector<std::string> lines() const {
    const std::regex colours("\x1b\\[[0-9;]*m");
    std::istringstream text(std::regex_replace(text_.str(), colours, ""));
    std::vector<std::string> found;
    for (std::string line; std::getline(text, line);) {
      if (!squeezed(line).empty()) found.push_back(squeezed(line));
    }
    return found;
  }

 private:
  static sdf::Console::ConsoleStream& stream() { return sdf::Console::Instance()->GetMsgStream(); }

  inline static std::mutex mutex_;
  std::lock_guard<std::mutex> lock_;
  std::ostringstream text_;
};

[[noreturn]] void fail(const std::string& source, const sdf::Errors& errors,
                       const ConsoleCapture& console) {
  std::string message = source + ": ";
  message += errors.empty() ? "libsdformat could not read it" : errors.front().Message();
  for (const std::string& line : console.lines()) message += "; " + line;
  throw InputError(message);
}

/// Builds a Scene from libsdformat's objects.
class SceneBuilder {
 public:
  SceneBuilder(Scene& scene, const UrdfExtras& extras, const SdfSurvey& survey)
      : scene_(scene), extras_(extras), survey_(survey) {}

  void add_world(const sdf::World& world) {
    scene_.gravity = vector(world.Gravity());
    if (const sdf::Physics* physics = world.PhysicsDefault(); physics != nullptr) {
      scene_.step = physics->MaxStepSize();
    }
    read_extensions(*world.Element());
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      add_model(*world.ModelByIndex(i), Pose(), "");
    }
  }

  void add_model(const sdf::Model& model, const Pose& parent, const std::string& prefix) {
    ignition::math::Pose3d raw;
    require(model.SemanticPose().Resolve(raw), "<pose>", *model.Element());
    const Pose pose = parent * to_pose(raw);
    const std::string name = prefix + model.Name();
    std::vector<std::pair<int, bool>> links;  // body, self_collide
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const std::string body =
          model.LinkCount() + model.ModelCount() == 1 ? name : name + "::" + link.Name();
      if (!add_link(model, link, pose, body)) continue;
      links.emplace_back(static_cast<int>(scene_.bodies.size()) - 1,
                         link.Element()->Get<bool>("self_collide", model.SelfCollide()).first ||
                             model.SelfCollide());
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      for (std::size_t j = i + 1; j < links.size(); ++j) {
        if (links[i].second || links[j].second) continue;
        scene_.never_collide.push_back(std::minmax(links[i].first, links[j].first));
      }
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      add_model(*model.ModelByIndex(i), pose, name + "::");
    }
  }

  void finish() {
    std::sort(scene_.never_collide.begin(), scene_.never_collide.end());
    if (!scene_.never_collide.empty()) {
      scene_.notices.push_back(
          fmt::format("{} pairs of links of one model do not collide: no <self_collide>",
                      scene_.never_collide.size()));
    }
    if (planes_ > 0) {
      scene_.notices.push_back(fmt::format(
          "<plane><size> ignored ({} planes): each is a whole half-space (in Bullet: a large box)",
          planes_));
    }
    for (const std::string& body : default_inertia_) {
      scene_.notices.push_back("body '" + body +
                               "' has no <inertial>: 1 kg and 1 kg m^2 about every axis, "
                               "SDFormat's default");
    }
  }

 private:
  void require(const sdf::Errors& errors, const std::string& field, const sdf::Element& where) {
    if (errors.empty()) return;
    throw InputError(survey_.locate(where) + ": " + field + ": " + errors.front().Message());
  }

  void read_extensions(sdf::Element& world) {
    if (const auto e = world.FindElement("signorini:title"); e != nullptr) {
      scene_.title = squeezed(e->GetValue()->GetAsString());
    }
    if (const auto e = world.FindElement("signorini:description"); e != nullptr) {
      scene_.description = squeezed(e->GetValue()->GetAsString());
    }
    if (const auto e = world.FindElement("signorini:duration"); e != nullptr) {
      scene_.duration = numbers(*e).x();
    }
    if (const auto e = world.FindElement("signorini:pairing"); e != nullptr) {
      scene_.rule = pairing_rule(squeezed(e->GetValue()->GetAsString()), *e);
    }
  }

  PairingRule pairing_rule(const std::string& word, const sdf::Element& where) {
    for (const PairingRule rule : {PairingRule::kMultiply, PairingRule::kMinimum,
                                   PairingRule::kMaximum, PairingRule::kMean}) {
      if (to_string(rule) == word) return rule;
    }
    throw InputError(survey_.locate(where) +
                     ": <signorini:pairing>: must be multiply, minimum, maximum or mean, got '" +
                     word + "'");
  }

  /// @return false if the body was left out: dynamic, and nothing but unsupported shapes.
  bool add_link(const sdf::Model& model, const sdf::Link& link, const Pose& model_pose,
                const std::string& name) {
    ignition::math::Pose3d raw;
    require(link.SemanticPose().Resolve(raw, "__model__"), "<pose>", *link.Element());
    const Pose link_pose = model_pose * to_pose(raw);
    const ignition::math::Inertiald& inertial = link.Inertial();
    const Vec3 com = vector(inertial.Pose().Pos());

    Body body;
    body.name = name;
    body.kind = model.Static() ? BodyKind::kFixed : BodyKind::kDynamic;
    body.mass = inertial.MassMatrix().Mass();
    body.inertia = matrix(inertial.Moi());
    body.gravity_scale = link.Element()->Get<bool>("gravity", true).first ? 1.0 : 0.0;
    BodyState state;
    state.x = link_pose * com;
    state.q = link_pose.orientation;
    if (body.is_dynamic() && survey_.was_emptied(*link.Element())) {
      scene_.notices.push_back("skipped: body '" + name + "' has no supported shape left");
      return false;
    }
    if (body.is_dynamic() && !link.Element()->HasElement("inertial")) {
      default_inertia_.push_back(name);
    }
    set_initial_velocity(*link.Element(), body, state);
    scene_.bodies.push_back(body);
    scene_.state.push_back(state);
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
      add_collision(*link.CollisionByIndex(i), com, name, link.CollisionCount() > 1, link.Name());
    }
    return true;
  }

  void set_initial_velocity(sdf::Element& link, const Body& body, BodyState& state) {
    const auto linear = link.FindElement("signorini:linear_velocity");
    const auto angular = link.FindElement("signorini:angular_velocity");
    if (linear == nullptr && angular == nullptr) return;
    if (!body.is_dynamic()) {
      throw InputError(survey_.locate(link) +
                       ": initial velocity: a link of a static model cannot have one");
    }
    set_velocity(body,
                 {linear == nullptr ? Vec3::Zero().eval() : numbers(*linear),
                  angular == nullptr ? Vec3::Zero().eval() : numbers(*angular)},
                 state);
  }

  void add_collision(const sdf::Collision& collision, const Vec3& com, const std::string& body_name,
                     bool several, const std::string& link_name) {
    ignition::math::Pose3d raw;
    require(collision.SemanticPose().Resolve(raw), "<pose>", *collision.Element());
    Pose local = to_pose(raw);
    local.position -= com;
    collision::Collider collider;
    collider.body = static_cast<int>(scene_.bodies.size()) - 1;
    collider.name = several ? body_name + "/" + collision.Name() : body_name;
    collider.material = material(*collision.Element(), link_name);
    const sdf::Geometry& geometry = *collision.Geom();
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX:
        collider.shape = collision::Box{0.5 * vector(geometry.BoxShape()->Size())};
        break;
      case sdf::GeometryType::SPHERE:
        collider.shape = collision::Sphere{geometry.SphereShape()->Radius()};
        break;
      case sdf::GeometryType::PLANE: {
        const Vec3 normal = plane_normal(*collision.Element());
        local.orientation = local.orientation * Quat::FromTwoVectors(Vec3::UnitZ(), normal);
        collider.shape = collision::HalfSpace{};
        ++planes_;
        break;
      }
      default:
        throw InputError(survey_.locate(*collision.Element()) + ": collision shape not supported");
    }
    collider.local = local;
    scene_.colliders.push_back(collider);
  }

  /// libsdformat normalises a zero normal to zero without a word.
  Vec3 plane_normal(sdf::Element& collision) {
    const auto plane = collision.GetElement("geometry")->GetElement("plane");
    const Vec3 normal =
        vector(plane->Get<ignition::math::Vector3d>("normal", {0.0, 0.0, 1.0}).first);
    if (!(normal.norm() > 0.0)) {
      throw InputError(survey_.locate(*plane) + ": <normal>: must not be zero");
    }
    return normal.normalized();
  }

  Material material(sdf::Element& collision, const std::string& link_name) {
    if (const auto found = extras_.materials.find(link_name); found != extras_.materials.end()) {
      return found->second;
    }
    Material result{1.0, 0.0};  // SDFormat's defaults
    const auto surface = collision.FindElement("surface");
    if (surface == nullptr) return result;
    if (const auto friction = surface->FindElement("friction"); friction != nullptr) {
      if (const auto ode = friction->FindElement("ode"); ode != nullptr) {
        result.friction = ode->Get<double>("mu", 1.0).first;
      }
    }
    if (const auto bounce = surface->FindElement("bounce"); bounce != nullptr) {
      result.restitution = bounce->Get<double>("restitution_coefficient", 0.0).first;
    }
    return result;
  }

  Scene& scene_;
  const UrdfExtras& extras_;
  const SdfSurvey& survey_;
  int planes_ = 0;
  std::vector<std::string> default_inertia_;
};

void add_ground(Scene& scene, double height) {
  Body body;
  body.kind = BodyKind::kFixed;
  body.name = "ground (added)";
  collision::Collider collider;
  collider.body = static_cast<int>(scene.bodies.size());
  collider.shape = collision::HalfSpace{};
  collider.local.position = Vec3(0.0, 0.0, height);
  collider.material = {1.0, 1.0};
  collider.name = body.name;
  scene.bodies.push_back(body);
  scene.state.emplace_back();
  scene.colliders.push_back(collider);
  scene.notices.push_back(fmt::format(
      "added: a fixed half-space z <= {} m, friction 1, restitution 1 (--ground)", height));
}

sdf::SDFPtr parse(const std::string& text, const std::string& file, SceneFormat format,
                  const std::string& source, const ConsoleCapture& console) {
  const auto document = std::make_shared<sdf::SDF>();
  sdf::init(document);
  sdf::Errors errors;
  const sdf::ParserConfig config;
  // An SDF file is read from disk so that its relative <include> paths hold.
  const bool from_file = !file.empty() && format == SceneFormat::kSdf;
  const bool good = from_file ? sdf::readFile(file, config, document, errors)
                              : sdf::readString(text, config, document, errors);
  if (!good || !errors.empty()) fail(source, errors, console);
  return document;
}

Scene read(const std::string& text, const std::string& file, const std::string& source,
           const ReadOptions& options) {
  tinyxml2::XMLDocument xml;
  const SceneFormat format = parse_xml(text, source, xml);
  check_numbers(xml, format, source);
  if (format == SceneFormat::kSdf && !options.skip_unsupported) check_shapes(xml, source);
  Scene scene;
  scene.source = source;
  scene.name = std::filesystem::path(source).stem().string();
  UrdfExtras extras;
  std::string checked_text = text;
  if (format == SceneFormat::kUrdf) {
    extras = read_urdf_extras(xml, source, options.skip_unsupported);
    tinyxml2::XMLPrinter printer;
    xml.Print(&printer);
    checked_text = printer.CStr();
  }

  const ConsoleCapture console;
  const sdf::SDFPtr document = parse(checked_text, file, format, source, console);
  SdfSurvey survey(source, options.skip_unsupported);
  survey.walk(document->Root());
  sdf::Root root;
  if (const sdf::Errors errors = root.Load(document); !errors.empty()) {
    fail(source, errors, console);
  }
  if (root.WorldCount() > 1) {
    throw InputError(fmt::format("{}: <world>: one expected, got {}", source, root.WorldCount()));
  }
  if (root.WorldCount() == 0 && root.Model() == nullptr) {
    throw InputError(source + ": holds neither a <world> nor a model");
  }
  SceneBuilder builder(scene, extras, survey);
  if (root.WorldCount() == 1) {
    builder.add_world(*root.WorldByIndex(0));
  } else {
    scene.notices.push_back(
        "a model without a world: gravity 0 0 -9.8 m/s^2 and a step of 0.001 s are SDFormat's "
        "defaults; nothing to stand on unless --ground adds it");
    builder.add_model(*root.Model(), Pose(), "");
  }
  builder.finish();
  for (const auto* lines : {&extras.notices}) {
    scene.notices.insert(scene.notices.end(), lines->begin(), lines->end());
  }
  for (const std::string& line : survey.notices()) scene.notices.push_back(line);
  for (const std::string& line : console.lines()) scene.notices.push_back("libsdformat: " + line);
  if (options.ground.has_value()) add_ground(scene, *options.ground);
  if (scene.title.empty()) scene.title = scene.name;
  validate(scene);
  return scene;
}

}  // namespace

Scene read_scene_file(const std::string& path, const ReadOptions& options) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || std::filesystem::is_directory(path) || !(text << file.rdbuf())) {
    throw InputError(path + ": cannot be read: expected an SDFormat or URDF file");
  }
  return read(text.str(), path, path, options);
}

Scene read_scene_text(const std::string& text, const std::string& source,
                      const ReadOptions& options) {
  return read(text, "", source, options);
}

std::string sdformat_version() {
  return SDF_VERSION_FULL;
}

}  // namespace signorini::validation
