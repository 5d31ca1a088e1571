#include "scene/readers/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "core/input_error_at.hpp"
#include "scene/face_materials.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/camera_table.hpp"
#include "scene/readers/default_material.hpp"
#include "scene/readers/geometry_formats.hpp"
#include "scene/readers/geometry_merger.hpp"
#include "scene/readers/geometry_table.hpp"
#include "scene/readers/heat_keys.hpp"
#include "scene/readers/luminaire_table.hpp"
#include "scene/readers/optics_keys.hpp"
#include "scene/readers/primitive_table.hpp"
#include "scene/readers/receiver_table.hpp"
#include "scene/readers/task_table.hpp"
#include "scene/readers/toml_depth.hpp"
#include "scene/readers/toml_file.hpp"
#include "scene/readers/unit_merger.hpp"

namespace fluxel {
namespace {

constexpr double kMaxExitance = 1e15;  // as for Ke of an OBJ file

bool within(const Rgb& colour, double low, double high) {
  return colour.r >= low && colour.r <= high && colour.g >= low && colour.g <= high && colour.b >= low &&
         colour.b <= high;
}

toml::table parse(const std::filesystem::path& file, const std::string& text) {
  require_shallow_toml(file, text);
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& failure) {
    throw input_error_at(file, failure.source().begin.line, std::string(failure.description()),
                         "the file must be TOML 1.0");
  }
}

/// Of surfaces whose file gives them no material.
void name_default_material(const TomlFile& toml, const toml::node& node, SceneInput& part) {
  const std::string name = toml.text(node, "material");
  const auto found = std::ranges::find(part.materials, kDefaultMaterial, &InputMaterial::name);
  if (found == part.materials.end())
    throw toml.error(node.source(),
                     fmt::format("all surfaces of {} have materials of their own", part.file.string()),
                     "change those by [materials.NAME]");
  const bool taken = std::ranges::find(part.materials, name, &InputMaterial::name) != part.materials.end();
  if (name.empty() || (taken && name != found->name))
    throw toml.error(node.source(),
                     fmt::format("material '{}' is {}", name, taken ? "in that file already" : "no name"),
                     "give another name");
  found->name = name;
}

/// What the file of a table has, with the path at which it is found.
SceneInput read_geometry_file(const TomlFile& toml, const toml::table& table, const TextLookup& lookup,
                              UnitMerger& units, InputGeometry& geometry) {
  const toml::node* const name = table.get("file");
  if (name == nullptr)
    throw toml.error(table.source(), "[[geometry]] names no file",
                     "file = \"...\", or a shape: box = [4, 3, 2.5], rectangle = [0.6, 0.6]");
  for (const char* const key : {"inwards", "group", "material_of"})
    if (const toml::node* const value = table.get(key))
      throw toml.error(value->source(), fmt::format("{} is of shapes alone, not of a file", key));
  geometry.file = toml.path.parent_path() / toml.text(*name, "file");
  const GeometryFormat* const format = geometry_format(geometry.file);
  if (format == nullptr) {
    throw toml.error(name->source(), fmt::format("'{}' is no geometry file", geometry.file.string()),
                     "known: " + geometry_extensions());
  }
  const std::optional<std::string> text = lookup(geometry.file);
  if (!text) {
    throw toml.error(name->source(),
                     fmt::format("cannot find the geometry file '{}'", geometry.file.string()));
  }
  SceneInput part = format->read(geometry.file, *text, lookup);
  if (const toml::node* const material = table.get("material")) name_default_material(toml, *material, part);
  units.convert(part, [&](const std::string& fault, const std::string& hint) {
    return toml.error(name->source(), fault, hint);
  });
  return part;
}

void read_geometry(const TomlFile& toml, const toml::node& node, const TextLookup& lookup, UnitMerger& units,
                   GeometryMerger& merger) {
  const toml::table& table = toml.table(node, "[[geometry]]");
  InputGeometry geometry = read_placing(toml, table);
  if (names_primitive(table)) {
    geometry.file = toml.path;
    geometry.unit_given = true;
    merger.add(read_primitive(toml, table), geometry);
  } else {
    merger.add(read_geometry_file(toml, table, lookup, units, geometry), geometry);
  }
}

void read_all_geometry(const TomlFile& toml, const toml::table& root, const TextLookup& lookup,
                       UnitMerger& units, SceneInput& scene) {
  const toml::node* const node = root.get("geometry");
  if (node == nullptr)
    throw toml.error({}, "the scene has no geometry",
                     "[[geometry]] with file = \"...\" or box = [4, 3, 2.5]");
  if (!node->is_array()) throw toml.error(node->source(), "geometry must stand as [[geometry]]");
  if (node->as_array()->empty()) throw toml.error(node->source(), "the scene has no geometry");
  GeometryMerger merger(scene);
  for (const toml::node& part : *node->as_array()) read_geometry(toml, part, lookup, units, merger);
  set_mean_reflectance(scene);  // of all files' faces, as they are placed
}

void override_material(const TomlFile& toml, const toml::table& table, TemperatureUnit unit,
                       InputMaterial& material) {
  const std::string where = fmt::format("[materials.{}]", material.name);
  toml.require_known_keys(
      table, where,
      {"rho", "E", "sides", "mirror", "transmission", "diffuse_transmission", "refraction_index",
       "emissivity", "temperature", "heat_flux", "convection_coefficient", "air_temperature"});
  if (const toml::node* const value = table.get("rho")) {
    material.rho = toml.colour(*value, where + " rho");
    if (!within(material.rho, 0, 1)) {
      throw toml.error(value->source(), where + " rho: reflectance outside 0..1");
    }
  }
  if (const toml::node* const value = table.get("E")) {
    material.E = toml.colour(*value, where + " E");
    if (!within(*material.E, 0, kMaxExitance)) {
      throw toml.error(value->source(), where + " E: exitance negative or too large");
    }
  }
  if (const toml::node* const value = table.get("sides"))
    material.sides = toml.sides(*value, where + " sides");
  read_optics(toml, table, where, material);
  replace_heat(read_heat(toml, table, where, unit), material.heat);
}

void override_materials(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  for (const auto& [key, value] : toml.table(node, "[materials]")) {
    const auto found =
        std::find_if(scene.materials.begin(), scene.materials.end(),
                     [&, &name = key](const auto& material) { return material.name == name.str(); });
    if (found == scene.materials.end()) {
      std::vector<std::string> known;
      for (const InputMaterial& material : scene.materials) known.push_back(material.name);
      throw toml.error(key.source(), fmt::format("no geometry has a material '{}'", key.str()),
                       known_names(key.str(), known));
    }
    const toml::table& table = toml.table(value, fmt::format("[materials.{}]", key.str()));
    override_material(toml, table, scene.temperature_unit, *found);
    if (table.contains("rho"))
      set_reflectance(MaterialId{static_cast<std::uint32_t>(found - scene.materials.begin())}, found->rho,
                      scene);
  }
}

void add_option(const TomlFile& toml, const toml::key& key, std::string value, SceneInput& scene) {
  std::string name(key.str());
  for (const InputCamera& camera : scene.cameras)
    if (const std::optional<std::size_t> line = camera.line_of(name))
      throw toml.error(key.source(), fmt::format("option '{}' is set twice", name),
                       fmt::format("first in line {}", *line));
  scene.options.push_back({std::move(name), std::move(value), key.source().begin.line});
}

void read_options(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  for (const auto& [key, value] : toml.table(node, "[options]")) {
    const std::string name = fmt::format("option '{}'", key.str());
    if (const auto* const text = value.as_string()) {
      add_option(toml, key, text->get(), scene);
    } else if (const auto* const flag = value.as_boolean()) {
      add_option(toml, key, flag->get() ? "true" : "false", scene);
    } else if (const auto* const whole = value.as_integer()) {
      add_option(toml, key, fmt::format("{}", whole->get()), scene);
    } else if (value.is_floating_point()) {
      add_option(toml, key, fmt::format("{}", toml.number(value, name)), scene);
    } else {
      throw toml.error(value.source(), name + " must be a text, a number or true or false",
                       value.is_array() ? "lists as a text: \"vtu,glb\"" : "");
    }
  }
}

Units read_units(const TomlFile& toml, const toml::node& node) {
  const std::string value = toml.text(node, "units");
  if (value == "radiometric") return Units::radiometric;
  if (value == "photometric") return Units::photometric;
  throw toml.error(node.source(), fmt::format("units is '{}'", value), "radiometric or photometric");
}

TemperatureUnit read_temperature_unit(const TomlFile& toml, const toml::node& node) {
  const std::string value = toml.text(node, "temperature_unit");
  if (value == "kelvin") return TemperatureUnit::kelvin;
  if (value == "celsius") return TemperatureUnit::celsius;
  throw toml.error(node.source(), fmt::format("temperature_unit is '{}'", value), "kelvin or celsius");
}

std::optional<double> read_efficacy(const TomlFile& toml, const toml::table& root) {
  constexpr double kMostEfficacy = 683;  // [lm/W], of light of 555 nm
  const toml::node* const node = root.get("luminous_efficacy");
  if (node == nullptr) return std::nullopt;
  const double efficacy = toml.number(*node, "luminous_efficacy");
  if (!(efficacy > 0 && efficacy <= kMostEfficacy))
    throw toml.error(node->source(), fmt::format("luminous_efficacy is {:g}", efficacy),
                     fmt::format("greater than 0 and at most {:g} lm/W", kMostEfficacy));
  return efficacy;
}

/// Behind the scene file's own, of which the first is taken where none is asked for.
void add_cameras(std::vector<InputCamera> of_files, SceneInput& scene) {
  if (of_files.empty()) return;
  for (InputCamera& own : scene.cameras)
    if (!own.name) own.name = FileValue<std::string>{"camera", 0};
  std::ranges::move(of_files, std::back_inserter(scene.cameras));
}

}  // namespace

SceneInput read_scene_text(const std::filesystem::path& file, const std::string& text,
                           const TextLookup& lookup) {
  const toml::table root = parse(file, text);
  const TomlFile toml{file};
  toml.require_known_keys(
      root, "the scene file",
      {"title", "about", "units", "luminous_efficacy", "temperature_unit", "geometry", "materials",
       "luminaires", "receivers", "observers", "tasks", "camera", "options"});
  SceneInput scene;
  scene.file = file;
  scene.name = file.stem().string();
  if (const toml::node* const title = root.get("title")) scene.name = toml.text(*title, "title");
  if (const toml::node* const about = root.get("about")) static_cast<void>(toml.text(*about, "about"));
  if (const toml::node* const units = root.get("units")) scene.units = read_units(toml, *units);
  if (const toml::node* const unit = root.get("temperature_unit"))
    scene.temperature_unit = read_temperature_unit(toml, *unit);
  UnitMerger units(scene, read_efficacy(toml, root));
  read_all_geometry(toml, root, lookup, units, scene);
  if (const toml::node* const materials = root.get("materials")) override_materials(toml, *materials, scene);
  if (const toml::node* const luminaires = root.get("luminaires"))
    read_luminaires(toml, *luminaires, lookup, units, scene);
  if (const toml::node* const receivers = root.get("receivers")) read_receivers(toml, *receivers, scene);
  if (const toml::node* const observers = root.get("observers")) read_observers(toml, *observers, scene);
  if (const toml::node* const tasks = root.get("tasks")) read_tasks(toml, *tasks, scene);
  std::vector<InputCamera> of_files = std::exchange(scene.cameras, {});
  if (const toml::node* const camera = root.get("camera")) scene.cameras = read_cameras(toml, *camera);
  if (const toml::node* const options = root.get("options")) read_options(toml, *options, scene);
  add_cameras(std::move(of_files), scene);
  return scene;
}

}  // namespace fluxel
