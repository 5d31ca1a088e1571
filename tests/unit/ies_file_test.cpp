#include "scene/readers/ies_file.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "scene/text_file.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::ies_file_test {
namespace {

using test_messages::expect_words;

constexpr double kPi = std::numbers::pi;

const std::string kIes =
    "IESNA:LM-63-2002\n[TEST] 17\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 50\n0 90 180\n0\n100 50 0\n";

/// kIes with `from` replaced by `to`.
std::string replaced(const std::string& from, const std::string& to, std::string text = kIes) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read_ies_text("a.ies", text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(IesFile, ReadsAnglesAndIntensities) {
  const PhotometricFile file = read_ies_text("a.ies", kIes);
  EXPECT_EQ(file.table.C, std::vector<double>{0});
  EXPECT_EQ(file.table.gamma, (std::vector<double>{0, kPi / 2, kPi}));
  EXPECT_EQ(file.table.intensity, (std::vector<double>{100, 50, 0}));
  EXPECT_EQ(file.units, Units::photometric);
  EXPECT_EQ(file.size, glm::dvec2(0));
  EXPECT_FALSE(file.round);
  EXPECT_TRUE(file.notes.empty());
}

// The flux is that of another program's integral over 400,001 angles of each plane, linear between the
// file's. Lamps lie along C = 0 (its keyword ALGN), as does the length.
TEST(IesFile, ReadsAMeasuredLuminaire) {
  const std::filesystem::path path = FLUXEL_SOURCE_DIR "/scenes/luminaires/ledalite-apex55.ies";
  const PhotometricFile file = read_ies_text(path, read_text_file(path).value());
  EXPECT_NEAR(flux(file.table), 5296.654924, 1e-5);
  EXPECT_EQ(largest_intensity(file.table), 1065.2);
  EXPECT_EQ(file.table.C.size(), 17u);
  EXPECT_EQ(file.table.gamma.size(), 73u);
  EXPECT_NEAR(file.size.x, 4.04 * 0.3048, 1e-12);
  EXPECT_NEAR(file.size.y, 0.85 * 0.3048, 1e-12);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_words(file.notes[0], {"height", "flat"});
}

/// A file of planes at `C` with 10 + the value of `I`, and 5 at 90 degrees.
template <class Function>
PhotometricFile read_planes(const std::vector<double>& C, Function I) {
  std::string angles, intensities;
  for (const double c : C) {
    angles += std::to_string(c) + " ";
    intensities += std::to_string(10 + I(c)) + " 5\n";
  }
  return read_ies_text("a.ies", "TILT=NONE\n1 -1 1 2 " + std::to_string(C.size()) +
                                    " 1 2 0 0 0 1 1 50\n0 90\n" + angles + "\n" + intensities);
}

void expect_equal_tables(const IntensityTable& a, const IntensityTable& b) {
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.gamma, b.gamma);
  EXPECT_EQ(a.intensity, b.intensity);
}

TEST(IesFile, ExpandsSymmetries) {
  const std::vector<double> turn{0, 30, 90, 150, 180, 210, 270, 330, 360};
  // Of both planes: a function of the angle from the nearer half of C = 0.
  const auto quarter = [](double C) { return std::round(std::abs(std::remainder(C, 180))); };
  const IntensityTable all = read_planes(turn, quarter).table;
  ASSERT_EQ(all.C.size(), turn.size());
  EXPECT_EQ(all.C.back(), 2 * kPi);
  EXPECT_EQ(all.at(1, 0), 40);
  EXPECT_EQ(all.at(3, 0), 40);
  EXPECT_EQ(all.at(7, 0), 40);
  expect_equal_tables(read_planes({0, 30, 90}, quarter).table, all);
  expect_equal_tables(read_planes({0, 30, 90, 150, 180}, quarter).table, all);
  expect_equal_tables(read_planes({90, 150, 180, 210, 270}, quarter).table, all);

  const auto left_right = [](double C) { return C <= 180 ? C : 360 - C; };
  expect_equal_tables(read_planes({0, 30, 90, 150, 180}, left_right).table,
                      read_planes(turn, left_right).table);

  const auto front_back = [](double C) { return std::abs(std::remainder(C - 90, 360)); };
  expect_equal_tables(read_planes({90, 150, 180, 210, 270}, front_back).table,
                      read_planes(turn, front_back).table);
}

TEST(IesFile, InterpolatesC0WhereNoPlaneIsThere) {
  const IntensityTable table = read_planes({90, 150, 210, 270}, [](double C) { return C; }).table;
  EXPECT_EQ(table.C.front(), 0);
  EXPECT_EQ(table.C.back(), 2 * kPi);
  EXPECT_DOUBLE_EQ(table.at(0, 0), 10 + (150 + 210) / 2.0);  // between 330 (as 210) and 30 (as 150)
  EXPECT_EQ(table.at(0, 0), table.at(table.C.size() - 1, 0));
}

TEST(IesFile, ClosesATurnThatEndsEarly) {
  const PhotometricFile file = read_planes({0, 90, 180, 270}, [](double C) { return C; });
  EXPECT_EQ(file.table.C.size(), 5u);
  EXPECT_EQ(file.table.at(4, 0), 10);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_words(file.notes[0], {"270", "interpolated"});
}

double largest_of(const std::string& text) { return largest_intensity(read_ies_text("a.ies", text).table); }

TEST(IesFile, MultipliesByItsFactors) {
  EXPECT_DOUBLE_EQ(largest_of(replaced("1 1000 1", "1 1000 2.5")), 250);
  EXPECT_DOUBLE_EQ(largest_of(replaced("1 1 50", "0.9 1 50")), 90);
  EXPECT_DOUBLE_EQ(largest_of(replaced("1 1000", "2 -1")), 100);  // absolute
}

// Until 1991 the second number is a factor; since 1995 it is for future use, and since 2019 it says who
// measured.
TEST(IesFile, TakesTheLampFactorOfOldFilesOnly) {
  const std::string factor = replaced("1 1 50", "1 0.5 50");
  EXPECT_DOUBLE_EQ(largest_of(factor), 100);
  EXPECT_DOUBLE_EQ(largest_of(replaced("IESNA:LM-63-2002", "IES:LM-63-2019", factor)), 100);
  EXPECT_DOUBLE_EQ(largest_of(replaced("IESNA:LM-63-2002", "IESNA:LM-63-1995", factor)), 100);
  EXPECT_DOUBLE_EQ(largest_of(replaced("IESNA:LM-63-2002", "IESNA91", factor)), 50);
  EXPECT_DOUBLE_EQ(largest_of(replaced("IESNA:LM-63-2002\n", "", factor)), 50);
}

TEST(IesFile, ReadsRadiometricFiles) {
  const std::string unit = "[_IntensityUnits]   mW/sr\nTILT";
  EXPECT_DOUBLE_EQ(largest_of(replaced("TILT", unit)), 0.1);
  EXPECT_EQ(read_ies_text("a.ies", replaced("TILT", unit)).units, Units::radiometric);
  EXPECT_DOUBLE_EQ(largest_of(replaced("TILT", "[_INTENSITYUNITS] W/sr\nTILT")), 100);
  EXPECT_EQ(read_ies_text("a.ies", replaced("TILT", "[_INTENSITYUNITS] cd\nTILT")).units, Units::photometric);
  expect_words(error_of(replaced("TILT", "[_INTENSITYUNITS] cd/klm\nTILT")),
               {"a.ies:3:", "'CD/KLM'", "mW/sr"});
}

struct Opening {
  const char* year;
  const char* size;  ///< width, length, height
  glm::dvec2 expected;
  bool round;
};

// Table 1 of LM-63-2002, and the list of LM-63-1991 and 1995; length lies along C = 0.
TEST(IesFile, ReadsTheShapesOfOpenings) {
  for (const Opening& opening : {
           Opening{"2002", "0 0 0", {0, 0}, false},     // point
           Opening{"2002", "1 2 0", {2, 1}, false},     // rectangle
           Opening{"2002", "1 2 3", {2, 1}, false},     // with luminous sides
           Opening{"2002", "-2 -2 0", {2, 2}, true},    // circle
           Opening{"2002", "-1 -2 0", {2, 1}, true},    // ellipse
           Opening{"2002", "-2 -2 1", {2, 2}, true},    // vertical cylinder
           Opening{"2002", "-2 -2 -2", {2, 2}, true},   // sphere
           Opening{"2002", "-1 2 -1", {2, 1}, false},   // horizontal cylinder along C = 0
           Opening{"2002", "2 -1 -1", {1, 2}, false},   // and along C = 90
           Opening{"2002", "-1 0 -1", {0, 1}, false},   // vertical circle
           Opening{"1995", "1 2 0.5", {2, 1}, false},   // box
           Opening{"1995", "-2 0 0", {2, 2}, true},     // circle
           Opening{"1995", "-2 0 -2", {2, 2}, true},    // sphere
           Opening{"1995", "-2 0 1", {2, 2}, true},     // vertical cylinder
           Opening{"1995", "0 2 -1", {2, 1}, false},    // horizontal cylinder along C = 0
           Opening{"1995", "2 0 -1", {1, 2}, false},    // and along C = 90
           Opening{"1995", "-1 2 0", {2, 1}, true},     // ellipses
           Opening{"1995", "2 -1 0", {1, 2}, true},     //
           Opening{"1995", "-1 2 -0.5", {2, 1}, true},  // ellipsoid
       }) {
    const std::string name = std::string(opening.year) + ": " + opening.size;
    const PhotometricFile file = read_ies_text(
        "a.ies",
        replaced("2002", opening.year, replaced("2 0 0 0\n", "2 " + std::string(opening.size) + "\n")));
    EXPECT_EQ(file.size, opening.expected) << name;
    EXPECT_EQ(file.round, opening.round) << name;
    const std::string size = opening.size;
    EXPECT_EQ(file.notes.size(), size.ends_with(" 0") ? 0u : 1u) << name;
  }
  EXPECT_DOUBLE_EQ(read_ies_text("a.ies", replaced("2 0 0 0\n", "1 1 2 0\n")).size.x, 2 * 0.3048);  // feet
}

TEST(IesFile, TakesNumbersInAnyLayout) {
  const IntensityTable table = read_ies_text("a.ies", kIes).table;
  std::string text =
      "IESNA91\r\n[MANUFAC] \xE9\xFF\x01 Lumi\xE8re\r\n[BLOCK\r\nTilt=none  \r\n1,1000 1\t3 1 1 2 0, 0 ,0 "
      "+1.0 1. 50 0\r\n\r\n90 1.8e2\r\n0 100\r\n50\r\n.0\r\n";
  expect_equal_tables(read_ies_text("a.ies", text).table, table);
  std::erase(text, '\n');
  expect_equal_tables(read_ies_text("a.ies", text).table, table);
}

TEST(IesFile, PassesOverTheTiltOfLamps) {
  const PhotometricFile file = read_ies_text("a.ies", replaced("NONE", "INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8"));
  expect_equal_tables(file.table, read_ies_text("a.ies", kIes).table);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_words(file.notes[0], {"TILT", "left out"});
}

TEST(IesFile, NotesTrailingText) {
  for (const std::string& rest : {std::string("\x1A"), std::string(2, '\0'), std::string("the end 3\n")}) {
    const PhotometricFile file = read_ies_text("a.ies", kIes + rest);
    ASSERT_EQ(file.notes.size(), 1u);
    expect_words(file.notes[0], {"follows the last intensity"});
    EXPECT_EQ(file.table.intensity.size(), 3u);
  }
}

TEST(IesFile, NotesAnglesThatTheStandardDoesNotKnow) {
  const auto notes_of = [](const std::string& from, const std::string& to) {
    return read_ies_text("a.ies", replaced(from, to)).notes;
  };
  for (const char* angles : {"\n5 90 180\n", "\n0 90 170\n", "\n0 30 60\n"}) {
    const std::vector<std::string> notes = notes_of("\n0 90 180\n", angles);
    ASSERT_EQ(notes.size(), 1u) << angles;
    expect_words(notes[0], {"vertical angles", "no light goes beyond"});
  }
  EXPECT_TRUE(notes_of("\n0 90 180\n", "\n0 45 90\n").empty());
  EXPECT_TRUE(notes_of("\n0 90 180\n", "\n90 100 180\n").empty());

  const std::vector<std::string> alone = notes_of("180\n0\n", "180\n45\n");
  ASSERT_EQ(alone.size(), 1u);
  expect_words(alone[0], {"horizontal angle 45", "alone"});

  const PhotometricFile turned = read_planes({0, 120, 240, 360}, [](double C) { return C == 360 ? 1 : 0; });
  ASSERT_EQ(turned.notes.size(), 1u);
  expect_words(turned.notes[0], {"0 and 360 degrees differ"});
  EXPECT_EQ(turned.table.at(3, 0), 10);
}

struct BadIes {
  const char* from;
  const char* to;
  std::vector<std::string> words;
};

TEST(IesFile, RefusesBadFilesWithTheirLine) {
  for (const BadIes& bad : {
           BadIes{"TILT=NONE", "", {"a.ies:8:", "no IES file", "TILT="}},
           BadIes{"NONE", "lamp.tlt", {"a.ies:3:", "TILT=LAMP.TLT", "TILT=INCLUDE"}},
           BadIes{"NONE", "", {"a.ies:3:", "TILT="}},
           BadIes{"NONE", "INCLUDE\n1\n2\n0 90\n1\n", {"a.ies:", "whole number"}},
           BadIes{"NONE", "INCLUDE\n1\n2\n90 0\n1 1\n", {"a.ies:6:", "tilt angle: 0 follows 90", "ascend"}},
           BadIes{"1 1 2 0", "1 2 2 0", {"a.ies:4:", "type B", "type C"}},
           BadIes{"1 1 2 0", "1 3 2 0", {"a.ies:4:", "type A"}},
           BadIes{"1 1 2 0", "1 4 2 0", {"a.ies:4:", "photometric type 4"}},
           BadIes{"1 1 2 0", "1 1 3 0", {"a.ies:4:", "units type 3", "metres"}},
           BadIes{"1 1000 1", "1 1000 0", {"a.ies:4:", "multiplier 0"}},
           BadIes{"1 1000 1", "1 1000 -1", {"a.ies:4:", "multiplier -1"}},
           BadIes{"1 1 50", "-1 1 50", {"a.ies:5:", "ballast factor -1"}},
           BadIes{"1 1000", "x 1000", {"a.ies:4:", "number of lamps: 'x' is not a number"}},
           BadIes{"1000 1 3", "1000 1 2.5", {"a.ies:4:", "vertical angles: 2.5", "whole number"}},
           BadIes{"1000 1 3", "1000 1 1", {"a.ies:4:", "vertical angles: 1", "from 2"}},
           BadIes{"1000 1 3", "1000 1 -3", {"a.ies:4:", "vertical angles: -3"}},
           BadIes{"1000 1 3 1", "1000 1 3 0", {"a.ies:4:", "horizontal angles: 0", "from 1"}},
           BadIes{"1000 1 3", "1000 1 1000000000", {"a.ies:7:", "vertical angle: 0 follows 180"}},
           BadIes{"1000 1 3", "1000 1 1e10", {"a.ies:4:", "vertical angles: 10000000000"}},
           BadIes{"1000 1 3 1", "1000 1 3 1000000000", {"a.ies:8:", "horizontal angle: 50 follows 100"}},
           BadIes{"2 0 0 0", "2 1e9 0 0", {"a.ies:4:", "width", "too large"}},
           BadIes{"2 0 0 0", "2 nan 0 0", {"a.ies:4:", "width", "not a finite number"}},
           BadIes{"0 90 180", "0 180 90", {"a.ies:6:", "vertical angle: 90 follows 180"}},
           BadIes{"0 90 180", "0 90 90", {"a.ies:6:", "90 follows 90"}},
           BadIes{"0 90 180", "0 90 181", {"a.ies:6:", "181", "0 to 180"}},
           BadIes{"0 90 180", "-1 90 180", {"a.ies:6:", "-1", "0 to 180"}},
           BadIes{"100 50 0\n", "100 50\n", {"a.ies:8:", "ends before intensity 3 of 3"}},
           BadIes{"100 50 0", "100 50 0 0", {"a.ies:8:", "more numbers than it promises"}},
           BadIes{"100 50 0", "100 -50 0", {"a.ies:8:", "-50 is negative"}},
           BadIes{"100 50 0", "100 inf 0", {"a.ies:8:", "'inf' is not a finite number"}},
           BadIes{"100 50 0", "100 1e400 0", {"a.ies:8:", "not a finite number"}},
           BadIes{"100 50 0", "100 1e16 0", {"a.ies:8:", "too large"}},
           BadIes{"100 50 0", "0 0 0", {"a.ies:8:", "no flux"}},
           BadIes{"100 50 0", "100 fifty 0", {"a.ies:8:", "'fifty' is not a number"}},
       }) {
    expect_words(error_of(replaced(bad.from, bad.to)), bad.words);
  }
  expect_words(error_of(""), {"a.ies:", "no IES file"});
  const std::string two_planes = replaced("1000 1 3 1", "1000 1 2 2", replaced("0 90 180", "0 90"));
  for (const std::string range : {"0 45", "10 90", "90 180", "45 360"})
    expect_words(error_of(replaced("0\n100 50 0", range + "\n1 1 1 1", two_planes)),
                 {"a.ies:8:", "horizontal angles go from", "0 to 90"});
  expect_words(error_of(kIes.substr(0, kIes.find("180"))), {"a.ies:6:", "ends before vertical angle 3 of 3"});
}

}  // namespace
}  // namespace fluxel::ies_file_test
