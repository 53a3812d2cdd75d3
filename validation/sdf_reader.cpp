#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_extras.h>
#include <signorini/validation/sdf_joints.h>
#include <signorini/validation/sdf_reader.h>
#include <signorini/validation/sdf_shapes.h>
#include <signorini/validation/sdf_survey.h>
#include <signorini/validation/urdf_extras.h>
#include <signorini/validation/xml_check.h>
#include <signorini/validation/xml_includes.h>
#include <signorini/validation/xml_split.h>

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <mutex>
#include <numbers>
#include <regex>
#include <sdf/sdf.hh>
#include <set>
#include <span>
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

  /// Without those about <inertial auto>, which its older versions do not know and we act on.
  [[nodiscard]] std::vector<std::string> lines() const {
    const std::regex colours("\x1b\\[[0-9;]*m");
    std::istringstream text(std::regex_replace(text_.str(), colours, ""));
    std::vector<std::string> found;
    for (std::string line; std::getline(text, line);) {
      const bool is_known = line.find("Attribute[auto] in element[inertial]") != std::string::npos;
      if (!is_known && !squeezed(line).empty()) found.push_back(squeezed(line));
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
  SceneBuilder(Scene& scene, const UrdfExtras& extras, const SdfExtras& sdf_extras,
               const SdfSurvey& survey)
      : scene_(scene),
        extras_(extras),
        sdf_extras_(sdf_extras),
        survey_(survey),
        shapes_(std::filesystem::path(scene.source).parent_path().string()) {}

  void add_world(const sdf::World& world) {
    has_world_ = true;
    scene_.gravity = vector(world.Gravity());
    if (const sdf::Physics* physics = world.PhysicsDefault(); physics != nullptr) {
      scene_.step = physics->MaxStepSize();
    }
    read_extensions(*world.Element());
    add_models(world);
  }

  void add_models(const sdf::World& world) {
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
      body_of_link_[name + "::" + link.Name()] = static_cast<int>(scene_.bodies.size()) - 1;
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
    add_joints(model, pose, name, body_of_link_, survey_, scene_);
  }

  void finish() {
    if (!has_world_) {
      scene_.notices.push_back(
          "a model without a world: gravity 0 0 -9.8 m/s^2 and a step of 0.001 s are SDFormat's "
          "defaults; nothing to stand on unless --ground adds it");
    }
    std::sort(scene_.never_collide.begin(), scene_.never_collide.end());
    if (!scene_.never_collide.empty()) {
      scene_.notices.push_back(
          fmt::format("{} pairs of bodies do not collide: links of one model without "
                      "<self_collide>, or joined",
                      scene_.never_collide.size()));
    }
    for (const std::string& line : shapes_.notices()) scene_.notices.push_back(line);
    scene_.files.insert(scene_.files.end(), shapes_.files().begin(), shapes_.files().end());
    for (const std::string& body : default_inertia_) {
      scene_.notices.push_back("body '" + body +
                               "' has no <inertial>: 1 kg and 1 kg m^2 about every axis, "
                               "SDFormat's default");
    }
    if (!names_by_computed_mass_.empty()) scene_.notices.push_back(computed_inertia_notice());
  }

 private:
  /// Bodies of equal mass together, the first of them by name.
  [[nodiscard]] std::string computed_inertia_notice() const {
    constexpr std::size_t kNamed = 3;
    std::string notice = "<inertial auto=\"true\">, computed from the shapes: ";
    std::string_view separator;
    for (const auto& [mass, names] : names_by_computed_mass_) {
      const auto first = std::span(names).first(std::min(kNamed, names.size()));
      notice += fmt::format("{}{} '{}'{} {}{}", separator,
                            names.size() == 1 ? "body" : fmt::format("{} bodies", names.size()),
                            fmt::join(first, "', '"), names.size() > kNamed ? " .." : "", mass,
                            names.size() == 1 ? "" : " each");
      separator = ", ";
    }
    return notice;
  }

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
    if (const auto e = world.FindElement("signorini:error"); e != nullptr) {
      scene_.error = squeezed(e->GetValue()->GetAsString());
    }
    if (const auto e = world.FindElement("signorini:error_scale"); e != nullptr) {
      scene_.error_scale = numbers(*e).x();
    }
    if (const auto e = world.FindElement("signorini:kind"); e != nullptr) {
      scene_.kind = kind(squeezed(e->GetValue()->GetAsString()), *e);
    }
    if (const auto e = world.FindElement("signorini:stepper"); e != nullptr) {
      scene_.stepper = stepper(squeezed(e->GetValue()->GetAsString()), *e);
    }
    if (const auto e = world.FindElement("signorini:pairing"); e != nullptr) {
      scene_.rule = pairing_rule(squeezed(e->GetValue()->GetAsString()), *e);
    }
  }

  std::string kind(const std::string& word, const sdf::Element& where) {
    const auto kinds = scene_kinds();
    if (std::find(kinds.begin(), kinds.end(), word) != kinds.end()) return word;
    throw InputError(survey_.locate(where) +
                     ": <signorini:kind>: must be stands, slides, bounces or free, got '" + word +
                     "'");
  }

  Stepper stepper(const std::string& word, const sdf::Element& where) {
    for (const Stepper one : {Stepper::kTime, Stepper::kEvents}) {
      if (to_string(one) == word) return one;
    }
    throw InputError(survey_.locate(where) +
                     ": <signorini:stepper>: must be time-stepping or event-driven, got '" + word +
                     "'");
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

    Body body;
    body.name = name;
    body.kind = model.Static() ? BodyKind::kFixed : BodyKind::kDynamic;
    body.mass = inertial.MassMatrix().Mass();
    body.inertia = matrix(inertial.Moi());
    body.gravity_scale = link.Element()->Get<bool>("gravity", true).first ? 1.0 : 0.0;
    if (body.is_dynamic() && survey_.was_emptied(*link.Element())) {
      scene_.notices.push_back("skipped: body '" + name + "' has no supported shape left");
      return false;
    }
    if (body.is_dynamic() && !link.Element()->HasElement("inertial")) {
      default_inertia_.push_back(name);
    }
    // Poses in the link's frame until the centre of mass is known.
    std::vector<collision::Collider> colliders;
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
      colliders.push_back(
          read_collision(*link.CollisionByIndex(i), body, link.CollisionCount() > 1, link.Name()));
    }
    Vec3 com = vector(inertial.Pose().Pos());
    if (body.is_dynamic() && sdf_extras_.auto_inertia.contains(SdfSurvey::path(*link.Element()))) {
      com = compute_inertia(link, colliders, body);
    } else if (body.is_dynamic() && link.Element()->HasElement("inertial") &&
               !gives(link, "mass")) {
      scene_.notices.push_back("body '" + name +
                               "' has an <inertial> without <mass>: 1 kg, SDFormat's default "
                               "(auto=\"true\" is known in the scene's own file alone, not in an "
                               "included one)");
    } else if (body.is_dynamic() && link.Element()->HasElement("inertial") &&
               !gives(link, "inertia")) {
      scene_.notices.push_back("body '" + name +
                               "' has a <mass> without <inertia>: 1 kg m^2 about every axis, "
                               "SDFormat's default");
    }
    BodyState state;
    state.x = link_pose * com;
    state.q = link_pose.orientation;
    set_initial_velocity(*link.Element(), body, state);
    for (collision::Collider& collider : colliders) {
      collider.local.position -= com;
      scene_.colliders.push_back(std::move(collider));
    }
    scene_.bodies.push_back(body);
    scene_.state.push_back(state);
    return true;
  }

  /// Whether the link's <inertial> has this element in the file.
  static bool gives(const sdf::Link& link, const std::string& element) {
    const auto given = link.Element()->GetElement("inertial")->FindElement(element);
    return given != nullptr && given->GetExplicitlySetInFile();
  }

  /// <inertial auto="true">: mass and inertia from the shapes and their <density>, that of the
  /// collision, else of the <inertial>, else 1000 kg/m^3 (SDFormat's default).
  /// @return the centre of mass in the link's frame
  Vec3 compute_inertia(const sdf::Link& link, const std::vector<collision::Collider>& colliders,
                       Body& body) {
    if (colliders.empty()) {
      throw InputError(
          survey_.locate(*link.Element()) +
          ": <inertial auto=\"true\">: the link has no <collision> to compute it from");
    }
    const double of_link = density(*link.Element()->GetElement("inertial"), 1000.0);
    std::vector<collision::MassProperties> parts;
    Vec3 com = Vec3::Zero();
    body.mass = 0.0;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
      collision::MassProperties part = collision::mass_properties(
          colliders[i].shape, density(*link.CollisionByIndex(i)->Element(), of_link));
      part.centre = colliders[i].local * part.centre;
      const Mat3 turn = colliders[i].local.orientation.toRotationMatrix();
      part.inertia = turn * part.inertia * turn.transpose();
      com += part.mass * part.centre;
      body.mass += part.mass;
      parts.push_back(part);
    }
    com /= body.mass;
    body.inertia.setZero();
    for (const collision::MassProperties& part : parts) {
      const Vec3 arm = part.centre - com;
      body.inertia +=
          part.inertia + part.mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
    }
    names_by_computed_mass_[fmt::format("{:.6g} kg", body.mass)].push_back(body.name);
    return com;
  }

  static double density(sdf::Element& element, double otherwise) {
    const auto found = element.FindElement("density");
    return found == nullptr || found->GetValue() == nullptr ? otherwise : numbers(*found).x();
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

  /// The body's number is the next one's; the pose is in the link's frame.
  collision::Collider read_collision(const sdf::Collision& collision, const Body& body,
                                     bool several, const std::string& link_name) {
    ignition::math::Pose3d raw;
    require(collision.SemanticPose().Resolve(raw), "<pose>", *collision.Element());
    collision::Collider collider;
    collider.local = to_pose(raw);
    collider.body = static_cast<int>(scene_.bodies.size());
    collider.name = several ? body.name + "/" + collision.Name() : body.name;
    collider.material = material(*collision.Element(), link_name);
    if (collider.material.friction_ratio != 1.0) {
      collider.friction_direction = friction_direction(*collision.Element());
    }
    collider.filter = filter(*collision.Element());
    ShapeUse use;
    use.is_dynamic = body.is_dynamic();
    use.body = body.name;
    use.where = survey_.locate(*collision.Element());
    use.capsule_as_cylinder = collision.Name().find(kCapsuleMark) != std::string::npos;
    const auto asked = sdf_extras_.optimization.find(SdfSurvey::path(*collision.Element()));
    if (asked != sdf_extras_.optimization.end()) use.optimization = asked->second;
    collider.shape = shapes_.read(collision.Element()->GetElement("geometry"), use, collider.local);
    return collider;
  }

  /// Two collide if their <collide_bitmask>s have a bit in common; SDFormat's default is 0xffff.
  collision::CollisionFilter filter(sdf::Element& collision) {
    std::uint32_t mask = 0xffff;
    const auto surface = collision.FindElement("surface");
    const auto contact = surface == nullptr ? nullptr : surface->FindElement("contact");
    const auto element = contact == nullptr ? nullptr : contact->FindElement("collide_bitmask");
    if (element != nullptr) mask = element->Get<unsigned int>();
    return {mask, mask};
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
        if (is_anisotropic(*ode)) {
          result.friction_ratio = ode->Get<double>("mu2", 1.0).first / result.friction;
        }
      }
      if (const auto bullet = friction->FindElement("bullet"); bullet != nullptr) {
        result.rolling_friction = bullet->Get<double>("rolling_friction", 0.0).first;
      }
      if (const auto torsional = friction->FindElement("torsional"); torsional != nullptr) {
        result.spinning_friction = spinning_friction(*torsional);
      }
    }
    if (const auto bounce = surface->FindElement("bounce"); bounce != nullptr) {
      result.restitution = bounce->Get<double>("restitution_coefficient", 0.0).first;
    }
    return result;
  }

  /// A patch of radius a under an even pressure falling to its rim: 3 pi/16 a mu (SDFormat's).
  static double spinning_friction(const sdf::Element& torsional) {
    if (!torsional.Get<bool>("use_patch_radius", true).first) return 0.0;  // said by the survey
    return 3.0 * std::numbers::pi / 16.0 * torsional.Get<double>("coefficient", 1.0).first *
           torsional.Get<double>("patch_radius", 0.0).first;
  }

  /// @pre is_anisotropic() of its surface
  static Vec3 friction_direction(sdf::Element& collision) {
    const auto ode = collision.FindElement("surface")->FindElement("friction")->FindElement("ode");
    return vector(ode->Get<ignition::math::Vector3d>("fdir1"));
  }

  Scene& scene_;
  const UrdfExtras& extras_;
  const SdfExtras& sdf_extras_;
  const SdfSurvey& survey_;
  ShapeReader shapes_;
  bool has_world_ = false;
  std::vector<std::string> default_inertia_;
  BodyOfLink body_of_link_;
  std::map<std::string, std::vector<std::string>> names_by_computed_mass_;
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
  collider.filter = {0xffffffffU, 0xffffffffU};
  scene.bodies.push_back(body);
  scene.state.emplace_back();
  scene.colliders.push_back(collider);
  scene.notices.push_back(fmt::format(
      "added: a fixed half-space z <= {} m, friction 1, restitution 1 (--ground)", height));
}

/// Worlds of more models than this are read in pieces: some 3 MB of memory a model, and a start of
/// libsdformat a piece.
constexpr int kMostModelsAtOnce = 100;

sdf::SDFPtr parse(const std::string& text, const std::string& file, SceneFormat format,
                  const std::string& source, const ConsoleCapture& console) {
  const auto document = std::make_shared<sdf::SDF>();
  sdf::init(document);
  sdf::Errors errors;
  const sdf::ParserConfig config;
  // An SDF file is read from disk so that its relative <include> paths hold.
  const bool from_file = !file.empty() && format == SceneFormat::kSdf;
  bool good = false;
  try {
    good = from_file ? sdf::readFile(file, config, document, errors)
                     : sdf::readString(text, config, document, errors);
  } catch (const std::exception& error) {  // a version that is no number
    throw InputError(fmt::format("{}: libsdformat: {}", source, error.what()));
  }
  if (!good || !errors.empty()) fail(source, errors, console);
  return document;
}

/// Adds the world or the model of one document; of a piece of a world, the models alone.
void add_document(const std::string& text, const std::string& file, SceneFormat format,
                  const std::string& source, const ConsoleCapture& console, SdfSurvey& survey,
                  SceneBuilder& builder, bool is_piece = false) {
  const sdf::SDFPtr document = parse(text, file, format, source, console);
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
  if (is_piece) {
    builder.add_models(*root.WorldByIndex(0));
  } else if (root.WorldCount() == 1) {
    builder.add_world(*root.WorldByIndex(0));
  } else {
    builder.add_model(*root.Model(), Pose(), "");
  }
}

Scene read(const std::string& text, const std::string& file, const std::string& source,
           const ReadOptions& options) {
  tinyxml2::XMLDocument xml;
  const SceneFormat format = parse_xml(text, source, xml);
  check_numbers(xml, format, source);
  Scene scene;
  if (format == SceneFormat::kSdf) scene.files = check_includes(xml, file, source);
  scene.source = source;
  scene.text = text;
  scene.name = std::filesystem::path(source).stem().string();
  UrdfExtras extras;
  const SdfExtras sdf_extras = read_sdf_extras(xml);
  std::string checked_text = text;
  if (format == SceneFormat::kUrdf) {
    extras = read_urdf_extras(xml, source, options.skip_unsupported);
    tinyxml2::XMLPrinter printer;
    xml.Print(&printer);
    checked_text = printer.CStr();
  }

  const ConsoleCapture console;
  SdfSurvey survey(source, options.skip_unsupported);
  SceneBuilder builder(scene, extras, sdf_extras, survey);
  if (format == SceneFormat::kSdf && can_be_split(xml, kMostModelsAtOnce)) {
    const SplitWorld split = split_world(xml, source, kMostModelsAtOnce);
    for (const auto& [name, count] : split.without_physics) {
      survey.count_without_physics(name, count);
    }
    add_document(split.world, "", format, source, console, survey, builder);
    for (const std::string& models : split.models) {
      add_document(models, "", format, source, console, survey, builder, true);
    }
  } else {
    add_document(checked_text, file, format, source, console, survey, builder);
  }
  builder.finish();
  std::sort(scene.files.begin(), scene.files.end());
  scene.files.erase(std::unique(scene.files.begin(), scene.files.end()), scene.files.end());
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
  std::ifstream file;
  std::ostringstream text;
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) file.open(path, std::ios::binary);
  if (!file.is_open() || !(text << file.rdbuf())) {
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
