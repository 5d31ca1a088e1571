#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/options.hpp"
#include "scene/readers/scene_file.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel {
namespace {

using test_messages::expect_words;

const std::string kGeometry = "[[geometry]]\nfile = \"triangle.obj\"\n";

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read_scene_text("dir/scene.toml", text, [](const std::filesystem::path&) {
      return std::optional<std::string>("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A key of so many parts: a.a. ... .a
std::string dotted(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

// The parser holds a table for each part, one in another, and takes them down by recursion.
TEST(TomlDepth, KeysOfManyPartsAreRefusedBeforeTheParserRunsOutOfStack) {
  const std::string key = dotted(40000);
  expect_words(error_of(key + " = 1\n"), {"dir/scene.toml:1:", "more than 32 dots"});
  expect_words(error_of("\n[" + key + "]\n"), {"dir/scene.toml:2:", "more than 32 dots"});
  expect_words(error_of("# \"\nx = \"\\\"\"\n" + key + " = 1"), {"dir/scene.toml:3:", "32 dots"});
  expect_words(error_of("x = \"\"\"\n'''\n\"\"\"\"\"\ny = {z = 1, " + key + " = 1}"), {"dir/scene.toml:4:"});
  expect_words(error_of("x = " + std::string(40000, '[')), {"dir/scene.toml:1:", "32 brackets"});
  expect_words(error_of("\nx = {" + dotted(30) + " = {" + dotted(34) + " = 1}}"), {"dir/scene.toml:2:"});
}

TEST(TomlDepth, DotsInTextsCommentsAndNumbersDoNotCount) {
  const std::string dots(100, '.'), brackets(100, '[');
  std::string numbers;
  for (int i = 0; i < 100; ++i) numbers += "1.5, ";
  EXPECT_EQ(error_of("title = \"" + dots + brackets + "\"  # " + dots + brackets + "\nabout = \"\"\"\n" +
                     dots + "\n'''\"\"\"\n" + kGeometry),
            "no error");
  EXPECT_EQ(error_of("title = '" + dots + "\\'\nabout = '''" + dots + "\"\"\"'''\n" + kGeometry), "no error");
  expect_words(error_of(kGeometry + "translate = [" + numbers + "1]\n"), {":3:", "array of 3"});
}

}  // namespace
}  // namespace fluxel
