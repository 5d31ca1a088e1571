#include "scene/readers/radiance_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/format_limits.hpp"
#include "scene/readers/radiance_materials.hpp"
#include "scene/readers/radiance_primitives.hpp"
#include "scene/readers/round_surfaces.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr double kNoLength = 1e-30;  // below, a direction cannot be told

class RadianceReader {
 public:
  RadianceReader(const std::filesystem::path& file, const std::string& text)
      : primitives_(file, text), materials_(scene_) {
    scene_.name = file.stem().string();
    scene_.file = file;
    scene_.geometry.push_back({.file = file});
  }

  SceneInput run() {
    while (primitives_.next(primitive_)) {
      const RadianceRole role = primitive_.type->role;
      if (role == RadianceRole::elsewhere) {
        elsewhere_.push_back(fmt::format("line {} {} {}", primitive_.line, primitive_.type->name,
                                         in_quotes(primitive_.identifier)));
      } else if (role < RadianceRole::elsewhere) {
        add_surface();
      } else {
        materials_.define(primitive_);
      }
    }
    if (scene_.polygons.empty()) throw no_surface();
    join_cones_to_rings();
    add_notes();
    return std::move(scene_);
  }

 private:
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const {
    return input_error_at(
        scene_.file, primitive_.line,
        fmt::format("{} {}: {}", primitive_.type->name, in_quotes(primitive_.identifier), what), hint);
  }

  [[nodiscard]] InputError no_surface() const {
    const std::vector<std::string>& commands = primitives_.commands();
    return input_error_at(scene_.file, 0, "holds no surface that reflects or emits",
                          commands.empty() ? "" : "commands are not run: " + list_names(commands));
  }

  /// A circle that a ring or a cone ends in.
  struct Circle {
    glm::dvec3 centre{0}, axis{0};  ///< unit
    double radius = 0;

    [[nodiscard]] bool is_same(const Circle& other) const {
      constexpr double kSame = 1e-6;  // of the radius; files round
      return glm::distance(centre, other.centre) <= kSame * radius &&
             std::abs(radius - other.radius) <= kSame * radius &&
             1 - std::abs(glm::dot(axis, other.axis)) <= kSame;
    }
  };
  /// The side of a cone that has been read.
  struct Cone {
    std::array<Circle, 2> ends;
    bool inwards = false;
    std::size_t first = 0;  ///< of its polygons
  };

  /// Keeps what ends in circles.
  void note_circles(bool inwards) {
    using enum RadianceRole;
    const RadianceRole role = primitive_.type->role;
    if (role == ring) {
      const glm::dvec3 axis = glm::normalize(point(3));
      for (const std::size_t real : {std::size_t{6}, std::size_t{7}})
        rings_.push_back({point(0), axis, primitive_.reals[real]});
    } else if (role == cone || role == cup || role == cylinder || role == tube) {
      const glm::dvec3 axis = glm::normalize(point(3) - point(0));
      const double radius1 = primitive_.reals[primitive_.reals.size() - 1];
      cones_.push_back({{Circle{point(0), axis, primitive_.reals[6]}, Circle{point(3), axis, radius1}},
                        inwards,
                        scene_.polygons.size()});
    }
  }

  /// What a ring closes is closed, and so are cones that go on from there: else light would leave between
  /// them.
  void join_cones_to_rings() {
    std::vector<bool> closed(cones_.size(), false);
    std::vector<Circle> ends = rings_;
    std::erase_if(ends, [](const Circle& of) { return of.radius == 0; });
    while (!ends.empty()) {
      const Circle end = ends.back();
      ends.pop_back();
      for (std::size_t k = 0; k < cones_.size(); ++k) {
        if (closed[k] ||
            std::ranges::none_of(cones_[k].ends, [&](const Circle& of) { return end.is_same(of); }))
          continue;
        closed[k] = true;
        for (const Circle& of : cones_[k].ends)
          if (of.radius > 0) ends.push_back(of);
      }
    }
    for (std::size_t k = 0; k < cones_.size(); ++k)
      if (closed[k]) close(cones_[k]);
  }

  void close(const Cone& cone) {
    const auto& [ends, inwards, first] = cone;
    std::size_t number = first;
    for (Corners& corners :
         cone_faces(ends[0].centre, ends[1].centre, ends[0].radius, ends[1].radius, RoundEnds::closed)) {
      if (inwards) std::ranges::reverse(corners);
      scene_.polygons[number++].corners = std::move(corners);
    }
  }

  void add_surface() {
    using enum RadianceRole;
    for (const double value : primitive_.reals)
      if (std::abs(value) > kMaxCoordinate)
        throw error(fmt::format("{} is too large", value), fmt::format("at most {}", kMaxCoordinate));
    std::vector<Corners> faces = make_faces();
    const RadianceRole role = primitive_.type->role;
    const bool inwards = role == bubble || role == cup || role == tube;
    const std::optional<MaterialId> material = materials_.of_surface(primitive_);
    if (!material) return;
    note_circles(inwards);
    const GroupId group = find_group();
    for (Corners& corners : faces) {
      if (inwards) std::ranges::reverse(corners);
      scene_.polygons.push_back({std::move(corners), *material, group});
    }
  }

  [[nodiscard]] std::vector<Corners> make_faces() const {
    using enum RadianceRole;
    switch (primitive_.type->role) {
      case sphere:
      case bubble:
        return sphere_faces(point(0), radius(3));
      case cone:
      case cup:
        return make_cone(radius_or_tip(6), radius_or_tip(7));
      case cylinder:
      case tube:
        return make_cone(radius(6), radius(6));
      case ring:
        return make_ring();
      default:
        return {polygon_corners()};
    }
  }

  [[nodiscard]] std::vector<Corners> make_cone(double radius0, double radius1) const {
    if (radius0 == 0 && radius1 == 0) throw error("both radii are 0");
    if (!(glm::distance(point(0), point(3)) > kNoLength)) throw error("its ends are one point");
    return cone_faces(point(0), point(3), radius0, radius1);
  }

  [[nodiscard]] std::vector<Corners> make_ring() const {
    const double radius0 = radius_or_tip(6), radius1 = radius_or_tip(7);
    if (radius0 == radius1) throw error("both radii are the same, so that it has no area");
    if (!(glm::length(point(3)) > kNoLength)) throw error("its direction is 0");
    return ring_faces(point(0), point(3), radius0, radius1);
  }

  [[nodiscard]] Corners polygon_corners() const {
    Corners corners;
    corners.reserve(primitive_.reals.size() / 3);
    for (std::size_t k = 0; k < primitive_.reals.size(); k += 3) corners.push_back(point(k));
    return corners;
  }

  [[nodiscard]] glm::dvec3 point(std::size_t real) const {
    return {primitive_.reals[real], primitive_.reals[real + 1], primitive_.reals[real + 2]};
  }

  [[nodiscard]] double radius_or_tip(std::size_t real) const {
    const double value = primitive_.reals[real];
    if (value < 0)
      throw error(fmt::format("radius {} is negative", value), "bubble, cup and tube face inwards");
    return value;
  }

  [[nodiscard]] double radius(std::size_t real) const {
    const double value = radius_or_tip(real);
    if (value == 0) throw error("the radius is 0");
    return value;
  }

  [[nodiscard]] GroupId find_group() {
    const auto next = static_cast<std::uint32_t>(scene_.groups.size());
    const auto [entry, added] = groups_.try_emplace(primitive_.identifier, GroupId{next});
    if (added) scene_.groups.push_back(primitive_.identifier);
    return entry->second;
  }

  void add_notes() {
    const std::string file = scene_.file.string();
    if (!primitives_.commands().empty()) {
      scene_.notes.push_back(fmt::format("{}: commands are not run (Radiance's xform does): {}", file,
                                         list_names(primitives_.commands())));
    }
    if (!elsewhere_.empty()) {
      scene_.notes.push_back(
          fmt::format("{}: left out, since there is no sun or sky, nor scenes within scenes: {}", file,
                      list_names(elsewhere_)));
    }
    materials_.add_notes();
  }

  RadiancePrimitives primitives_;
  SceneInput scene_;
  RadianceMaterials materials_;
  RadiancePrimitive primitive_;
  std::unordered_map<std::string, GroupId> groups_;
  std::vector<std::string> elsewhere_;
  std::vector<Circle> rings_;
  std::vector<Cone> cones_;
};

}  // namespace

SceneInput read_radiance(const std::filesystem::path& file, const std::string& text, const TextLookup&) {
  return RadianceReader(file, text).run();
}

}  // namespace fluxel
