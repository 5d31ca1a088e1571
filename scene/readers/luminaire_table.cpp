#include "scene/readers/luminaire_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "scene/readers/photometric_formats.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kMaxLuminaires = 100'000;
constexpr double kMaxSize = 10000;            // [m], as of the openings of photometric files
constexpr double kMaxTurn = 36000;            // [degrees], of which all digits still count
constexpr std::size_t kMaxNameBytes = 200;    // of which there may be so many copies
constexpr double kMaxLuminaireNumber = 1e15;  // as of numbers elsewhere
constexpr glm::dvec3 kDown{0, -1, 0};         // `--up` is y unless told

/// A photometric file that has been read, as one of the scene's tables.
struct KnownFile {
  std::uint32_t table = 0;
  double flux = 0;  ///< of the table [lm] or [W]
  glm::dvec2 size{0};
  bool round = false;
};

/// Goes through the tables [[luminaires]].
class LuminaireTables {
 public:
  LuminaireTables(const TomlFile& toml, const TextLookup& lookup, UnitMerger& units, SceneInput& scene)
      : toml_(toml), lookup_(lookup), units_(units), scene_(scene) {}

  void read(const toml::node& node) {
    const toml::table& table = toml_.table(node, "[[luminaires]]");
    toml_.require_known_keys(table, "[[luminaires]]",
                             {"name", "file", "intensity", "position", "aim", "turn", "flux",
                              "maintenance_factor", "size", "rows", "columns", "row_step", "column_step"});
    const KnownFile photometry = read_photometry(table);
    Luminaire luminaire;
    luminaire.name = read_name(table);
    luminaire.position = toml_.vector(require(table, "position"), "luminaire position");
    luminaire.intensity = photometry.table;
    luminaire.size = photometry.size;
    luminaire.round = photometry.round;
    luminaire.scale = Rgb(read_scale(table, photometry.flux));
    if (const toml::node* const size = table.get("size")) read_size(*size, luminaire);
    read_directions(table, luminaire);
    add_copies(table, luminaire);
  }

 private:
  [[nodiscard]] const toml::node& require(const toml::table& table, const char* key) const {
    if (const toml::node* const found = table.get(key)) return *found;
    throw toml_.error(table.source(), fmt::format("[[luminaires]] lacks {}", key),
                      "it needs name, position, and file or intensity");
  }

  [[nodiscard]] std::string read_name(const toml::table& table) const {
    const toml::node& node = require(table, "name");
    std::string name = toml_.text(node, "luminaire name");
    if (name.empty() || name.size() > kMaxNameBytes)
      throw toml_.error(node.source(), "luminaire name is empty or too long",
                        fmt::format("1 to {} bytes", kMaxNameBytes));
    return name;
  }

  [[nodiscard]] double positive(const toml::node& node, const std::string& name) const {
    const double value = toml_.number(node, name);
    if (!(value > 0 && value <= kMaxLuminaireNumber))
      throw toml_.error(node.source(),
                        fmt::format("{} must be greater than 0 and at most {}", name, kMaxLuminaireNumber));
    return value;
  }

  KnownFile read_photometry(const toml::table& table) {
    const toml::node* const file = table.get("file");
    const toml::node* const candelas = table.get("intensity");
    if ((file == nullptr) == (candelas == nullptr))
      throw toml_.error(table.source(), "[[luminaires]] needs one of file and intensity");
    return file != nullptr ? read_file(*file) : read_isotropic(*candelas);
  }

  KnownFile read_file(const toml::node& node) {
    const std::filesystem::path path =
        (toml_.path.parent_path() / toml_.text(node, "luminaire file")).lexically_normal();
    if (const auto known = files_.find(path); known != files_.end()) return known->second;
    const PhotometricFormat* const format = photometric_format(path);
    if (format == nullptr)
      throw toml_.error(node.source(), fmt::format("'{}' is no photometric file", path.string()),
                        "known: " + photometric_extensions());
    const std::optional<std::string> text = lookup_(path);
    if (!text)
      throw toml_.error(node.source(), fmt::format("cannot find the photometric file '{}'", path.string()));
    PhotometricFile file = format->read(path, *text);
    scale(file.table, factor(node, path.string(), file.units));
    for (const std::string& note : file.notes)
      scene_.notes.push_back(fmt::format("{}: {}", path.string(), note));
    const KnownFile known = add_table(std::move(file.table), file.size, file.round);
    files_.emplace(path, known);
    return known;
  }

  /// A luminaire without a file: the same intensity in all directions.
  KnownFile read_isotropic(const toml::node& node) {
    const double candelas = positive(node, "luminaire intensity");
    IntensityTable table{{0}, {0, std::numbers::pi}, {candelas, candelas}};
    scale(table, factor(node, "a luminaire's intensity in candelas", Units::photometric));
    return add_table(std::move(table), {0, 0}, false);
  }

  KnownFile add_table(IntensityTable table, glm::dvec2 size, bool round) {
    const KnownFile known{static_cast<std::uint32_t>(scene_.intensities.size()), flux(table), size, round};
    scene_.intensities.push_back(std::move(table));
    return known;
  }

  [[nodiscard]] double factor(const toml::node& node, const std::string& what, Units units) {
    return units_.factor(units, what, [&](const std::string& fault, const std::string& hint) {
      return toml_.error(node.source(), fault, hint);
    });
  }

  static void scale(IntensityTable& table, double by) {
    for (double& intensity : table.intensity) intensity *= by;
  }

  [[nodiscard]] double read_scale(const toml::table& table, double flux_of_file) const {
    double scale = 1;
    if (const toml::node* const value = table.get("flux")) {
      if (table.contains("intensity"))
        throw toml_.error(value->source(), "luminaire flux and intensity say the same",
                          "leave out one of them");
      scale = positive(*value, "luminaire flux") / flux_of_file;
    }
    if (const toml::node* const value = table.get("maintenance_factor")) {
      const double factor = positive(*value, "maintenance_factor");
      if (factor > 1) throw toml_.error(value->source(), "maintenance_factor must be 1 at most");
      scale *= factor;
    }
    return scale;
  }

  /// One number is the diameter of a round opening, two are the sides of a rectangle.
  void read_size(const toml::node& node, Luminaire& luminaire) const {
    luminaire.round = !node.is_array();
    if (luminaire.round) {
      luminaire.size = glm::dvec2(toml_.number(node, "luminaire size"));
    } else {
      const toml::array& sides = toml_.array(node, "luminaire size", 2);
      luminaire.size = {toml_.number(sides[0], "luminaire size"), toml_.number(sides[1], "luminaire size")};
    }
    if (!(std::min(luminaire.size.x, luminaire.size.y) >= 0 &&
          std::max(luminaire.size.x, luminaire.size.y) <= kMaxSize))
      throw toml_.error(node.source(), fmt::format("luminaire size is not between 0 and {:g} m", kMaxSize));
    if (luminaire.size == glm::dvec2(0)) luminaire.round = false;
  }

  /// Of `turn`, a number of degrees or the direction to which C = 0 shall point.
  void read_directions(const toml::table& table, Luminaire& luminaire) const {
    const toml::node* const aim = table.get("aim");
    luminaire.aim = aim != nullptr ? toml_.direction(*aim, "luminaire aim") : kDown;
    const toml::node* const turn = table.get("turn");
    if (turn != nullptr && turn->is_array()) {
      luminaire.ahead = toml_.direction_beside(luminaire.aim, *turn, "luminaire turn", "its aim");
      return;
    }
    const glm::dvec3 start = beside(luminaire.aim, {1, 0, 0}).value_or(glm::dvec3(0, 1, 0));
    const double angle = turn != nullptr ? toml_.number(*turn, "luminaire turn") : 0;
    if (!(std::abs(angle) <= kMaxTurn))
      throw toml_.error(turn->source(),
                        fmt::format("luminaire turn is not within {0:g} degrees of 0", kMaxTurn));
    const double radians = std::remainder(angle, 360) / 180 * std::numbers::pi;
    luminaire.ahead =
        glm::normalize(std::cos(radians) * start + std::sin(radians) * glm::cross(start, luminaire.aim));
  }

  [[nodiscard]] std::size_t read_count(const toml::table& table, const char* key) const {
    const toml::node* const node = table.get(key);
    if (node == nullptr) return 1;
    const std::int64_t value = node->is_integer() ? node->as_integer()->get() : 0;
    if (value < 1 || static_cast<std::uint64_t>(value) > kMaxLuminaires)
      throw toml_.error(node->source(),
                        fmt::format("luminaire {} must be a whole number from 1 to {}", key, kMaxLuminaires));
    return static_cast<std::size_t>(value);
  }

  /// The step from one of `count` copies to the next.
  [[nodiscard]] glm::dvec3 read_step(const toml::table& table, const char* key, std::size_t count) const {
    const toml::node* const node = table.get(key);
    if (node == nullptr) {
      if (count > 1)
        throw toml_.error(table.source(), fmt::format("[[luminaires]] of an array lacks {}", key));
      return {0, 0, 0};
    }
    const glm::dvec3 step = toml_.vector(*node, fmt::format("luminaire {}", key));
    if (count > 1 && step == glm::dvec3(0))
      throw toml_.error(node->source(),
                        fmt::format("luminaire {} is 0: {} luminaires in one place", key, count));
    return step;
  }

  /// The luminaire, or those of an array of it: NAME-ROW-COLUMN.
  void add_copies(const toml::table& table, const Luminaire& luminaire) {
    const bool is_array = table.contains("rows") || table.contains("columns");
    const std::size_t rows = read_count(table, "rows"), columns = read_count(table, "columns");
    const glm::dvec3 row_step = read_step(table, "row_step", rows);
    const glm::dvec3 column_step = read_step(table, "column_step", columns);
    if (rows * columns + scene_.luminaires.size() > kMaxLuminaires)
      throw toml_.error(table.source(), fmt::format("more than {} luminaires", kMaxLuminaires));
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        Luminaire copy = luminaire;
        if (is_array) copy.name += fmt::format("-{}-{}", row + 1, column + 1);
        copy.position += static_cast<double>(row) * row_step + static_cast<double>(column) * column_step;
        add(table, std::move(copy));
      }
    }
  }

  void add(const toml::table& table, Luminaire luminaire) {
    if (!names_.insert(luminaire.name).second)
      throw toml_.error(table.source(), fmt::format("a second luminaire '{}'", luminaire.name));
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(luminaire.position[axis]) <= kMaxLuminaireNumber))
        throw toml_.error(table.source(), fmt::format("luminaire '{}' is too far away", luminaire.name));
    }
    scene_.luminaires.push_back(std::move(luminaire));
  }

  const TomlFile& toml_;
  const TextLookup& lookup_;
  UnitMerger& units_;
  SceneInput& scene_;
  std::map<std::filesystem::path, KnownFile> files_;
  std::set<std::string> names_;
};

}  // namespace

void read_luminaires(const TomlFile& toml, const toml::node& node, const TextLookup& lookup,
                     UnitMerger& units, SceneInput& scene) {
  if (!node.is_array()) throw toml.error(node.source(), "luminaires must stand as [[luminaires]]");
  LuminaireTables tables(toml, lookup, units, scene);
  for (const toml::node& luminaire : *node.as_array()) tables.read(luminaire);
}

}  // namespace fluxel
