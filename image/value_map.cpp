#include "image/value_map.hpp"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "image/isolines.hpp"

namespace fluxel {

namespace {

// In pixels of the picture that is made.
constexpr double kLongSide = 720, kShortSide = 60;  // of the map
constexpr double kLeastPicture = 360,
                 kMostPicture = 4096;  // of a camera's picture: smaller ones are drawn larger
constexpr int kMostCells = 8192;       // along a side; of more, several are drawn as one by their mean
constexpr double kMargin = 16, kTitle = 48, kAxis = 52, kLegendGap = 24, kLegend = 20, kLegendText = 84;
constexpr double kLegendHeight = 240;  // at least
constexpr double kText = 13, kLine = 20;
constexpr double kRoomOfValue = 34;    // of a cell whose value is written into it
constexpr double kBetweenLabels = 60;  // of isolines

constexpr const char* kFont = "sans-serif";

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

Surface make_surface(int width, int height) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(fmt::format("a picture of {} x {} pixels cannot be drawn: {}", width, height,
                                         cairo_status_to_string(cairo_surface_status(surface.get()))));
  return surface;
}

/// The pixels' words of a row: 0x00RRGGBB.
std::uint32_t* row_of(cairo_surface_t* surface, int row) {
  return reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface) +
                                          static_cast<std::ptrdiff_t>(row) *
                                              cairo_image_surface_get_stride(surface));
}

/// The map with so many columns and rows that they can be drawn.
ValueMap reduced(const ValueMap& map) {
  const int across = (map.columns + kMostCells - 1) / kMostCells,
            down = (map.rows + kMostCells - 1) / kMostCells;
  if (across <= 1 && down <= 1) return map;
  ValueMap small = map;
  small.columns = (map.columns + across - 1) / across;
  small.rows = (map.rows + down - 1) / down;
  small.values.clear();
  for (int row = 0; row < small.rows; ++row)
    for (int column = 0; column < small.columns; ++column) {
      double sum = 0;
      int count = 0;
      for (int y = down * row; y < std::min(down * (row + 1), map.rows); ++y)
        for (int x = across * column; x < std::min(across * (column + 1), map.columns); ++x)
          if (const double value =
                  map.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.columns) +
                             static_cast<std::size_t>(x)];
              !std::isnan(value))
            sum += value, ++count;
      small.values.push_back(count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN());
    }
  return small;
}

/// The widest of a map's texts in pixels.
double width_of_text(const ValueMap& map) {
  const Surface surface = make_surface(1, 1);
  const Context at(cairo_create(surface.get()), cairo_destroy);
  cairo_set_font_size(at.get(), kText);
  double widest = 0;
  const auto add = [&](const std::string& text, cairo_font_weight_t weight) {
    cairo_select_font_face(at.get(), kFont, CAIRO_FONT_SLANT_NORMAL, weight);
    cairo_text_extents_t extents;
    cairo_text_extents(at.get(), text.c_str(), &extents);
    widest = std::max(widest, extents.x_advance);
  };
  add(map.title, CAIRO_FONT_WEIGHT_BOLD);
  for (const std::string& line : map.lines) add(line, CAIRO_FONT_WEIGHT_NORMAL);
  return widest;
}

/// A map's parts, and where they are.
class MapDrawing {
 public:
  MapDrawing(const ValueMap& map, const ColourScale& scale)
      : map_(map),
        scale_(scale),
        is_plan_(map.size.x > 0),
        size_(map_size(map)),
        left_(is_plan_ ? kAxis + kMargin : kMargin),
        width_(static_cast<int>(std::ceil(std::max(left_ + size_.x + kLegendGap + kLegend + kLegendText,
                                                   left_ + width_of_text(map) + kMargin)))),
        height_(static_cast<int>(std::ceil(kTitle + std::max(size_.y, kLegendHeight) +
                                           (is_plan_ ? kAxis : kMargin) +
                                           kLine * static_cast<double>(map.lines.size()) + kMargin))),
        surface_(make_surface(width_, height_)),
        context_(cairo_create(surface_.get()), cairo_destroy) {}

  DisplayPicture draw() {
    cairo_t* const at = context_.get();
    cairo_set_source_rgb(at, 1, 1, 1);
    cairo_paint(at);
    cairo_select_font_face(at, kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(at, kText);
    draw_cells();
    if (is_plan_) {
      if (writes_values()) {
        draw_values();
      } else {
        draw_isolines();
      }
      draw_axes();
    }
    draw_legend();
    draw_text();
    return finished();
  }

 private:
  static glm::dvec2 map_size(const ValueMap& map) {
    if (map.size.x > 0) {
      const double scale = kLongSide / std::max(map.size.x, map.size.y);
      return {std::max(kShortSide, scale * map.size.x), std::max(kShortSide, scale * map.size.y)};
    }
    const double least = std::min(map.columns, map.rows);
    const double most = std::max(map.columns, map.rows);
    const double whole =
        std::max(1.0, std::min(std::ceil(kLeastPicture / least), std::floor(kMostPicture / most)));
    return {whole * map.columns, whole * map.rows};
  }

  [[nodiscard]] glm::dvec2 cell() const { return {size_.x / map_.columns, size_.y / map_.rows}; }

  [[nodiscard]] double value(int column, int row) const {
    return map_.values[static_cast<std::size_t>(row) * static_cast<std::size_t>(map_.columns) +
                       static_cast<std::size_t>(column)];
  }

  void draw_cells() {
    const Surface cells = make_surface(map_.columns, map_.rows);
    cairo_surface_flush(cells.get());
    for (int row = 0; row < map_.rows; ++row) {
      std::uint32_t* const words = row_of(cells.get(), row);
      for (int column = 0; column < map_.columns; ++column) {
        const double of = value(column, row);
        const auto [r, g, b] = std::isnan(of) ? kNone : scale_colour(scale_.place(of));
        words[column] = std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | std::uint32_t{b};
      }
    }
    cairo_surface_mark_dirty(cells.get());
    cairo_t* const at = context_.get();
    cairo_save(at);
    cairo_translate(at, left_, kTitle);
    cairo_rectangle(at, 0, 0, size_.x, size_.y);
    cairo_clip(at);
    cairo_scale(at, cell().x, cell().y);
    cairo_set_source_surface(at, cells.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(at), CAIRO_FILTER_NEAREST);
    cairo_paint(at);
    cairo_restore(at);
    draw_frame(left_, kTitle, size_.x, size_.y);
  }

  void draw_frame(double x, double y, double width, double height) {
    cairo_t* const at = context_.get();
    cairo_set_source_rgb(at, 0.2, 0.2, 0.2);
    cairo_set_line_width(at, 1);
    cairo_rectangle(at, x, y, width, height);
    cairo_stroke(at);
  }

  void draw_isolines() {
    cairo_t* const at = context_.get();
    std::vector<glm::dvec2> labels;
    for (const double level : scale_.marks()) {
      const auto lines = isolines(map_.values, map_.columns, level);
      const double shade = shade_on(level);
      cairo_set_source_rgba(at, shade, shade, shade, 0.8);
      cairo_set_line_width(at, 1.2);
      for (const auto& [from, to] : lines) {
        cairo_move_to(at, left_ + from.x * cell().x, kTitle + from.y * cell().y);
        cairo_line_to(at, left_ + to.x * cell().x, kTitle + to.y * cell().y);
      }
      cairo_stroke(at);
      // The first piece from the line's middle on that is far enough from other labels.
      for (std::size_t k = 0; k < lines.size(); ++k) {
        const auto& [from, to] = lines[(k + lines.size() / 2) % lines.size()];
        const glm::dvec2 place(left_ + (from.x + to.x) / 2 * cell().x,
                               kTitle + (from.y + to.y) / 2 * cell().y);
        const bool is_free = std::ranges::all_of(labels, [&](const glm::dvec2& other) {
          return std::hypot(place.x - other.x, place.y - other.y) > kBetweenLabels;
        });
        if (!is_free) continue;
        labels.push_back(place);
        write_on(number(level), place, level);
        break;
      }
    }
  }

  [[nodiscard]] bool writes_values() const { return std::min(cell().x, 1.5 * cell().y) >= kRoomOfValue; }

  void draw_values() {
    for (int row = 0; row < map_.rows; ++row)
      for (int column = 0; column < map_.columns; ++column)
        if (const double of = value(column, row); !std::isnan(of))
          write_on(number(of), {left_ + (column + 0.5) * cell().x, kTitle + (row + 0.5) * cell().y}, of);
  }

  /// Of what is drawn on the colour of a value: white on dark ones, black on bright ones.
  [[nodiscard]] double shade_on(double of) const { return scale_.place(of) < 0.6 ? 1 : 0; }

  /// Text in the middle of a place of that value's colour.
  void write_on(const std::string& text, const glm::dvec2& middle, double of) {
    const double shade = shade_on(of);
    cairo_set_source_rgb(context_.get(), shade, shade, shade);
    cairo_set_font_size(context_.get(), kText - 2);
    write(text, middle, 0.5);
    cairo_set_font_size(context_.get(), kText);
  }

  /// `share` of the text's width lies left of the place, which is half way up its letters.
  void write(const std::string& text, const glm::dvec2& place, double share) {
    cairo_text_extents_t extents;
    cairo_text_extents(context_.get(), text.c_str(), &extents);
    cairo_move_to(context_.get(), place.x - share * extents.x_advance, place.y + 0.36 * kText);
    cairo_show_text(context_.get(), text.c_str());
  }

  void draw_axes() {
    constexpr double kTick = 5;
    cairo_t* const at = context_.get();
    const double bottom = kTitle + size_.y;
    cairo_set_source_rgb(at, 0.2, 0.2, 0.2);
    for (const double metres : round_values(0, map_.size.x, std::max(1, static_cast<int>(size_.x / 70)))) {
      const double x = left_ + metres / map_.size.x * size_.x;
      cairo_move_to(at, x, bottom);
      cairo_line_to(at, x, bottom + kTick);
      cairo_stroke(at);
      write(number(metres), {x, bottom + kTick + 0.8 * kText}, 0.5);
    }
    for (const double metres : round_values(0, map_.size.y, std::max(1, static_cast<int>(size_.y / 50)))) {
      const double y = bottom - metres / map_.size.y * size_.y;
      cairo_move_to(at, left_, y);
      cairo_line_to(at, left_ - kTick, y);
      cairo_stroke(at);
      write(number(metres), {left_ - kTick - 3, y}, 1);
    }
    write("m", {left_ + size_.x / 2, bottom + kTick + 2.1 * kText}, 0.5);
    write("m", {kMargin, kTitle + size_.y / 2}, 0.5);
  }

  void draw_legend() {
    cairo_t* const at = context_.get();
    const double x = left_ + size_.x + kLegendGap, height = std::max(size_.y, kLegendHeight);
    const int steps = static_cast<int>(height);
    for (int k = 0; k < steps; ++k) {
      const auto [r, g, b] = scale_colour(1 - (k + 0.5) / steps);
      cairo_set_source_rgb(at, r / 255.0, g / 255.0, b / 255.0);
      cairo_rectangle(at, x, kTitle + k, kLegend, 1.5);
      cairo_fill(at);
    }
    draw_frame(x, kTitle, kLegend, height);
    for (const double mark : scale_.marks()) {
      const double y = kTitle + (1 - scale_.place(mark)) * height;
      cairo_move_to(at, x + kLegend, y);
      cairo_line_to(at, x + kLegend + 4, y);
      cairo_stroke(at);
      write(number(mark), {x + kLegend + 8, y}, 0);
    }
    write(map_.unit, {x, kTitle - 0.9 * kText}, 0);
  }

  void draw_text() {
    cairo_t* const at = context_.get();
    cairo_set_source_rgb(at, 0, 0, 0);
    double y = kTitle + std::max(size_.y, kLegendHeight) + (is_plan_ ? kAxis : kMargin);
    for (const std::string& line : map_.lines) {
      write(line, {left_, y}, 0);
      y += kLine;
    }
    cairo_select_font_face(at, kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_BOLD);
    write(map_.title, {left_, kTitle / 2 - 6}, 0);
  }

  [[nodiscard]] static std::string number(double value) { return fmt::format("{:.4g}", value); }

  DisplayPicture finished() {
    cairo_surface_flush(surface_.get());
    DisplayPicture picture;
    picture.width = width_;
    picture.height = height_;
    picture.rgb.reserve(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int row = 0; row < height_; ++row) {
      const std::uint32_t* const words = row_of(surface_.get(), row);
      for (int column = 0; column < width_; ++column)
        for (const int shift : {16, 8, 0})
          picture.rgb.push_back(static_cast<std::uint8_t>(words[column] >> shift & 0xFFu));
    }
    return picture;
  }

  static constexpr std::array<std::uint8_t, 3> kNone{0xe0, 0xe0, 0xe0};  // where nothing was measured

  ValueMap map_;
  const ColourScale& scale_;
  bool is_plan_;
  glm::dvec2 size_;  // of the map
  double left_;      // of the map
  int width_, height_;
  Surface surface_;
  Context context_;
};

}  // namespace

DisplayPicture draw_value_map(const ValueMap& map, const ColourScale& scale) {
  return MapDrawing(reduced(map), scale).draw();
}

}  // namespace fluxel
