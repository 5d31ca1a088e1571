#include "output/html/html_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <string_view>

#include "core/file.hpp"
#include "core/options.hpp"
#include "core/version.hpp"
#include "image/colour_scale.hpp"
#include "metrics/diverging_colours.hpp"
#include "output/html/base64.hpp"
#include "output/html/html_assets.hpp"

namespace fluxel {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPlans = 24;
constexpr int kPaletteColours = 33;
constexpr int kReadAgain = 3;  // [s]

/// Not every system that this is built on has it.
constexpr bool kHasThree = !html_assets::kThreeMinJs.empty();

/// Of a file or a user: as text of HTML.
std::string escaped(std::string_view text) {
  std::string safe;
  for (const char letter : text) switch (letter) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += letter;
    }
  return safe;
}

/// UTF-8, not cut within a letter.
std::string shortened(std::string text) {
  constexpr std::size_t kMost = 120;
  if (text.size() <= kMost) return text;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  text.resize(end);
  return text;
}

/// JSON in a script ends where HTML sees "</script" or "<!--": a "<" within strings is written by its number.
std::string json_of_script(const Json& json) {
  std::string safe;
  for (const char letter : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    letter == '<' ? safe += "\\u003c" : safe += letter;
  return safe;
}

Json palette_json() {
  Json colours = Json::array();
  for (int k = 0; k < kPaletteColours; ++k) colours.push_back(scale_colour(k / (kPaletteColours - 1.0)));
  return colours;
}

Json diverging_json() {
  std::vector<double> places;
  places.reserve(kPaletteColours);
  for (int k = 0; k < kPaletteColours; ++k) places.push_back(2 * k / (kPaletteColours - 1.0) - 1);
  const std::vector<std::uint8_t> rgb = diverging_colours(places, 1);
  Json colours = Json::array();
  for (std::size_t k = 0; k + 2 < rgb.size(); k += 3) colours.push_back({rgb[k], rgb[k + 1], rgb[k + 2]});
  return colours;
}

Json data_of(const HtmlPage& page) {
  Json json{{"kind", page.kind},
            {"name", page.name},
            {"version", version()},
            {"live", page.is_live},
            {"dry", page.is_dry},
            {"written", std::time(nullptr)},
            {"of", page.error_of},
            {"units",
             {{"flux", page.units.flux},
              {"exitance", page.units.exitance},
              {"irradiance", page.units.exitance},
              {"radiance", page.units.radiance},
              {"temperature", page.temperature_unit}}},
            {"report", page.report},
            {"palette", palette_json()},
            {"diverging", diverging_json()}};
  if (!page.command.empty()) json["command"] = page.command;
  if (!page.unreached.empty()) json["unreached"] = page.unreached;
  if (!page.matrix.empty()) json["matrix"] = page.matrix;
  Json pictures = Json::array();
  std::size_t plans = 0;
  for (const PagePicture& picture : page.pictures) {
    const bool is_plan = picture.of == PagePicture::Of::receiver;
    if (is_plan && ++plans > kMostPlans) continue;
    pictures.push_back({{"caption", picture.caption},
                        {"png", base64(picture.png)},
                        {"seen", picture.of == PagePicture::Of::camera},
                        {"receiver", is_plan}});
  }
  if (plans > kMostPlans) json["plans_left_out"] = plans - kMostPlans;
  json["pictures"] = pictures;
  if (page.mesh && kHasThree) json["mesh"] = *page.mesh;
  if (page.mesh && !kHasThree) json["mesh_left_out"] = true;
  return json;
}

}  // namespace

void write_html_page(const std::filesystem::path& file, const HtmlPage& page) {
  using namespace html_assets;
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  if (page.is_live) text += fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", kReadAgain);
  // A name may be that of a file, of any bytes.
  const std::string title = shortened(
      Json::parse(Json(page.name).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>());
  text +=
      fmt::format("<title>{} - Fluxel</title>\n<style>\n{}</style>\n</head>\n<body>\n<main id=\"page\">\n",
                  escaped(title), kPageCss);
  text +=
      "<noscript><p>This page needs JavaScript, which draws it from the data that it "
      "holds.</p></noscript>\n</main>\n";
  text += fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n",
                      json_of_script(data_of(page)));
  if (page.mesh && kHasThree)
    text += fmt::format("<script>/* three.js r111, MIT licence, the three.js authors */\n{}\n{}</script>\n",
                        kThreeMinJs, kOrbitControlsJs);
  text += fmt::format("<script>\n{}{}{}{}{}</script>\n</body>\n</html>\n", kDomJs, kChartsJs, kMeshJs,
                      kSectionsJs, kPageJs);
  write_bytes_atomically(file, text);
}

}  // namespace fluxel
