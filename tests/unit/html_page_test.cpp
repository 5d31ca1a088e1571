// The page of a run: what is packed for it, and that names cannot end its script.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "output/html/base64.hpp"
#include "output/html/html_page.hpp"
#include "output/html/shown_mesh.hpp"

namespace fluxel {
namespace {

TEST(Base64, IsThatOfTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\xfe\xfd\0", 4)), "//79AA==");
}

/// n x n squares of two patches beside each other, B growing along x.
MeshToShow squares(int n) {
  MeshToShow mesh;
  MeshLayer layer{"temperature", 1, {}};
  const float edge = 1.0F / static_cast<float>(n);
  for (std::uint32_t patch = 0; patch < 2; ++patch)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const float x = static_cast<float>(patch) + static_cast<float>(i) * edge,
                    y = static_cast<float>(j) * edge;
        Outline<glm::vec3> outline;
        outline.corner = {glm::vec3(x, y, 0), {x + edge, y, 0}, {x + edge, y + edge, 0}, {x, y + edge, 0}};
        outline.corners = 4;
        mesh.outlines.push_back(outline);
        mesh.patch.push_back(patch);
        mesh.group.push_back(patch);
        layer.values.push_back(x + edge / 2);
      }
  mesh.groups = {"a", "b"};
  mesh.layers.push_back(layer);
  return mesh;
}

std::size_t count_of(const nlohmann::ordered_json& shown, const std::string& name) {
  for (const auto& part : shown["layout"])
    if (part["name"] == name) return part["count"];
  return 0;
}

TEST(ShownMesh, HasEachElementWhereTheyAreFew) {
  const auto shown = shown_mesh(squares(4), 32);
  EXPECT_FALSE(shown["decimated"]);
  EXPECT_EQ(count_of(shown, "corners"), 32u);
  EXPECT_EQ(count_of(shown, "positions"), 32u * 12);
  EXPECT_EQ(shown["size"][0], 2);
  EXPECT_EQ(shown["step"], 2);
}

/// The bytes that were packed: base64 is undone letter by letter.
std::string unpacked(const nlohmann::ordered_json& shown) {
  const std::string text = shown["packed"],
                    letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(letters.find(letter));
    have += 6;
    if (have >= 8) bytes += static_cast<char>(bits >> (have -= 8) & 255U);
  }
  std::string out(1 << 24, '\0');
  uLongf size = out.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  out.resize(size);
  return out;
}

TEST(ShownMesh, JoinsWithinPatchesWhereTheyAreMany) {
  const auto shown = shown_mesh(squares(64), 200);
  EXPECT_TRUE(shown["decimated"]);
  EXPECT_EQ(shown["elements"], 2 * 64 * 64);
  const std::size_t count = count_of(shown, "corners");
  EXPECT_LE(count, 200u);
  EXPECT_GE(count, 60u);
  // What is shown covers all, without overlaps, and no hull reaches across x = 1, where the patches meet.
  const std::string bytes = unpacked(shown);
  const auto* corners = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto position = [&](std::size_t vertex, std::size_t axis) {
    std::uint16_t value = 0;
    std::copy_n(bytes.data() + count + 2 * (3 * vertex + axis), 2, reinterpret_cast<char*>(&value));
    return 2.0 * value / 65535;
  };
  double area = 0;
  std::size_t first = 0;
  for (std::size_t k = 0; k < count; first += corners[k++]) {
    bool left = false, right = false;
    for (std::size_t c = 0; c < corners[k]; ++c) {
      const std::size_t a = first + c, b = first + (c + 1) % corners[k];
      area += 0.5 * (position(a, 0) * position(b, 1) - position(b, 0) * position(a, 1));
      left = left || position(a, 0) < 1 - 1e-3;
      right = right || position(a, 0) > 1 + 1e-3;
    }
    EXPECT_FALSE(left && right);
  }
  EXPECT_NEAR(area, 2, 1e-3);
}

TEST(ShownMesh, ValuesBesideALampKeepTheirDigits) {
  MeshToShow mesh = squares(1);
  mesh.layers.front().values = {3e8F, 5.97F};
  const std::string bytes = unpacked(shown_mesh(mesh));
  std::array<float, 2> values{};
  std::copy_n(bytes.data() + 2 + 2 * 24, sizeof values, reinterpret_cast<char*>(values.data()));
  EXPECT_NEAR(values[0], 3e8F, 3e4F);
  EXPECT_NEAR(values[1], 5.97F, 6e-4F);
  mesh.layers.front().values = {1300, 700};
  const std::string exact = unpacked(shown_mesh(mesh));
  std::copy_n(exact.data() + 2 + 2 * 24, sizeof values, reinterpret_cast<char*>(values.data()));
  EXPECT_EQ(values, (std::array<float, 2>{1300, 700}));
}

TEST(ShownMesh, AnyNumbersMayNamePatches) {
  MeshToShow mesh = squares(16);
  for (std::uint32_t& patch : mesh.patch) patch = patch == 0 ? 4'294'967'295U : 7U;
  const auto shown = shown_mesh(mesh, 64);
  EXPECT_LE(count_of(shown, "corners"), 64u);
  EXPECT_EQ(shown["left_out"], 0);
}

TEST(ShownMesh, KeepsTheLargestWherePatchesAreTooMany) {
  MeshToShow mesh = squares(8);
  for (std::size_t k = 0; k < mesh.patch.size(); ++k) mesh.patch[k] = static_cast<std::uint32_t>(k);
  const auto shown = shown_mesh(mesh, 50);
  EXPECT_EQ(count_of(shown, "corners"), 50u);
  EXPECT_EQ(shown["left_out"], 2 * 64 - 50);
}

TEST(HtmlPage, NoNameEndsTheScript) {
  const std::filesystem::path out = std::filesystem::path(testing::TempDir()) / "fluxel-page.html";
  HtmlPage page;
  page.kind = "solve";
  page.name = "</title><script>alert(1)</script>\xff";
  page.report["warnings"] = {"</script><!-- <script>", "\xff"};
  write_html_page(out, page);
  std::ifstream file(out, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  std::filesystem::remove(out);
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<script"), 2u) << "data and program";
  EXPECT_EQ(count("</script>"), 2u);
  EXPECT_EQ(count("</title>"), 1u);
  EXPECT_EQ(count("<!--"), 0u);
}

}  // namespace
}  // namespace fluxel
