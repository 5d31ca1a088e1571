#include "scene/readers/task_table.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/option_names.hpp"
#include "scene/quantity_names.hpp"

namespace fluxel {

namespace {

constexpr std::size_t kMostLetters = 128;
constexpr double kMaxIlluminance = 1e6;  // [lx]
constexpr double kMaxUGR = 40;
constexpr std::size_t kMaxObservers = 1000;  // each looks at all luminaires

/// Of a table, among those of its kind that have been read.
template <class Named>
std::string read_new_name(const TomlFile& toml, const toml::node& node, const std::string& what,
                          const std::vector<Named>& others) {
  std::string name = toml.text(node, what + " name");
  const bool is_printed = std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == 0x7F; });
  if (name.empty() || name.size() > kMostLetters || !is_printed)
    throw toml.error(node.source(), what + " name is empty, too long or no single line",
                     fmt::format("1 to {} bytes", kMostLetters));
  if (std::ranges::find(others, name, &Named::name) != others.end())
    throw toml.error(node.source(), fmt::format("a second {} '{}'", what, name));
  return name;
}

/// The name of one of those that have been read.
template <class Named>
std::string read_known_name(const TomlFile& toml, const toml::node& node, const std::string& key,
                            const std::string& what, const std::vector<Named>& known) {
  std::string name = toml.text(node, key);
  if (std::ranges::find(known, name, &Named::name) != known.end()) return name;
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const Named& of : known) names.push_back(of.name);
  throw toml.error(node.source(), fmt::format("{}: there is no {} '{}'", key, what, name),
                   names.empty() ? fmt::format("add [[{}s]]", what) : known_names(name, names));
}

double read_within(const TomlFile& toml, const toml::node& node, const std::string& name, double most) {
  const double value = toml.number(node, name);
  if (!(value > 0 && value <= most))
    throw toml.error(node.source(), fmt::format("{} must be greater than 0 and at most {:g}", name, most));
  return value;
}

Observer read_observer(const TomlFile& toml, const toml::table& table, const SceneInput& scene) {
  const std::string needs = "it needs name, eye, direction and up";
  const auto value = [&](const char* key) -> const toml::node& {
    return toml.require(table, key, "[[observers]]", needs);
  };
  toml.require_known_keys(table, "[[observers]]", {"name", "eye", "direction", "up"});
  Observer observer;
  observer.name = read_new_name(toml, value("name"), "observer", scene.observers);
  observer.eye = toml.point(value("eye"), "observer eye");
  observer.direction = toml.direction(value("direction"), "observer direction");
  observer.up = toml.direction_beside(observer.direction, value("up"), "observer up", "its direction");
  return observer;
}

LightingTask read_task(const TomlFile& toml, const toml::table& table, const SceneInput& scene) {
  const std::string needs = "it needs name, area and illuminance";
  const auto value = [&](const char* key) -> const toml::node& {
    return toml.require(table, key, "[[tasks]]", needs);
  };
  toml.require_known_keys(
      table, "[[tasks]]",
      {"name", "area", "surrounding", "background", "illuminance", "U0", "UGR", "observers"});
  LightingTask task;
  task.name = read_new_name(toml, value("name"), "task", scene.tasks);
  const auto receiver = [&](const toml::node& node, const char* key) {
    std::string name = read_known_name(toml, node, fmt::format("task {}", key), "receiver", scene.receivers);
    const Quantity quantity = std::ranges::find(scene.receivers, name, &Receiver::name)->quantity;
    const bool is_area = std::string_view(key) == "area";
    if (quantity == Quantity::radiance || (!is_area && quantity != Quantity::irradiance))
      throw toml.error(
          node.source(),
          fmt::format("task {}: receiver '{}' measures {}", key, name, name_of(kQuantityNames, quantity)),
          is_area ? "a task is about illuminance"
                  : "what is around a task area is about the illuminance of planes");
    return name;
  };
  task.area = receiver(value("area"), "area");
  if (const toml::node* const node = table.get("surrounding"))
    task.surrounding = receiver(*node, "surrounding");
  if (const toml::node* const node = table.get("background")) task.background = receiver(*node, "background");
  if (!task.background.empty() && task.surrounding.empty())
    throw toml.error(table.source(), fmt::format("task '{}' has a background and no surrounding", task.name),
                     "what a background needs is a third of the surrounding's illuminance");
  task.illuminance = read_within(toml, value("illuminance"), "task illuminance", kMaxIlluminance);
  if (const toml::node* const node = table.get("U0")) task.U0 = read_within(toml, *node, "task U0", 1);
  if (const toml::node* const node = table.get("UGR"))
    task.UGR = read_within(toml, *node, "task UGR", kMaxUGR);
  if (const toml::node* const node = table.get("observers")) {
    if (!node->is_array() || node->as_array()->empty())
      throw toml.error(node->source(), "task observers must be an array of names");
    for (const toml::node& name : *node->as_array()) {
      std::string observer = read_known_name(toml, name, "task observers", "observer", scene.observers);
      if (std::ranges::find(task.observers, observer) != task.observers.end())
        throw toml.error(name.source(), fmt::format("task observers: '{}' stands twice", observer));
      task.observers.push_back(std::move(observer));
    }
  }
  if (task.UGR.has_value() == task.observers.empty())
    throw toml.error(table.source(),
                     fmt::format("task '{}' needs both UGR and observers, or neither", task.name));
  return task;
}

void require_photometric(const TomlFile& toml, const toml::node& node, const std::string& what,
                         const SceneInput& scene) {
  if (scene.units != Units::photometric)
    throw toml.error(node.source(), what + ", and the scene is radiometric", "units = \"photometric\"");
}

}  // namespace

void read_observers(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  if (!node.is_array()) throw toml.error(node.source(), "observers must stand as [[observers]]");
  if (node.as_array()->size() > kMaxObservers)
    throw toml.error(node.source(), fmt::format("more than {} observers", kMaxObservers));
  require_photometric(toml, node, "[[observers]] are about luminance", scene);
  for (const toml::node& observer : *node.as_array())
    scene.observers.push_back(read_observer(toml, toml.table(observer, "[[observers]]"), scene));
}

void read_tasks(const TomlFile& toml, const toml::node& node, SceneInput& scene) {
  if (!node.is_array()) throw toml.error(node.source(), "tasks must stand as [[tasks]]");
  require_photometric(toml, node, "[[tasks]] ask for lux", scene);
  for (const toml::node& task : *node.as_array())
    scene.tasks.push_back(read_task(toml, toml.table(task, "[[tasks]]"), scene));
}

}  // namespace fluxel
