#include "scene/readers/eulumdat_file.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "tests/unit/messages.hpp"

namespace fluxel::eulumdat_file_test {
namespace {

using test_messages::expect_words;

constexpr double kPi = std::numbers::pi;

/// The lines of a file of 1200 lm whose intensities are 100, 50 and 0 cd/klm at 0, 90 and 180 degrees of all
/// C.
std::vector<std::string> lines() {
  std::vector<std::string> lines{"Company", "1",      "1",    "1",   "0",    "3",      "90", "report",
                                 "name",    "number", "file", "me",  "0",    "0",      "0",  "0",
                                 "0",       "0",      "0",    "0",   "0",    "0",      "0",  "1.0",
                                 "0",       "1",      "2",    "LED", "1200", "3000 K", "80", "15"};
  lines.insert(lines.end(), 10, "0.5");  // direct ratios
  lines.insert(lines.end(), {"0", "0", "90", "180", "100", "50", "0"});
  return lines;
}

// Of the lines above, numbered from 1.
constexpr std::size_t kSymmetry = 3, kPlanes = 4, kGammas = 6, kLength = 16, kWidth = 17, kHeight = 20,
                      kLorl = 23, kFactor = 24, kTilt = 25, kSets = 26, kFlux = 29, kDirectRatios = 33,
                      kC = 43, kGamma = 44, kIntensity = 47;

std::string joined(const std::vector<std::string>& lines, const std::string& end = "\n") {
  std::string text;
  for (const std::string& line : lines) text += line + end;
  return text;
}

/// lines() with one replaced.
std::string with(std::size_t line, const std::string& value, std::vector<std::string> all = lines()) {
  all[line - 1] = value;
  return joined(all);
}

PhotometricFile read(const std::string& text) { return read_eulumdat_text("a.ldt", text); }

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_equal_tables(const IntensityTable& a, const IntensityTable& b) {
  EXPECT_EQ(a.C, b.C);
  EXPECT_EQ(a.gamma, b.gamma);
  EXPECT_EQ(a.intensity, b.intensity);
}

TEST(EulumdatFile, ReadsIntensitiesOfTheLampsFlux) {
  const PhotometricFile file = read(joined(lines()));
  EXPECT_EQ(file.table.C, std::vector<double>{0});
  EXPECT_EQ(file.table.gamma, (std::vector<double>{0, kPi / 2, kPi}));
  EXPECT_EQ(file.table.intensity, (std::vector<double>{120, 60, 0}));
  EXPECT_EQ(file.units, Units::photometric);
  EXPECT_EQ(file.size, glm::dvec2(0));
  EXPECT_FALSE(file.round);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_DOUBLE_EQ(largest_intensity(read(with(kFactor, "0.5")).table), 60);
}

TEST(EulumdatFile, TakesAnyEndsOfLinesAndDecimalCommas) {
  std::vector<std::string> all = lines();
  all[kFactor - 1] = "1,0";
  all[kIntensity - 1] = " 1,0e2 ";
  for (const std::string end : {"\r\n", "\n", "\r"})
    expect_equal_tables(read(joined(all, end)).table, read(joined(lines())).table);
}

/// A file of the symmetry, with planes at `C` and those of `stored` with 10 + `I` at gamma 0 and 5 at 90
/// degrees.
template <class Function>
IntensityTable read_planes(int symmetry, const std::vector<double>& C, const std::vector<double>& stored,
                           Function I) {
  std::vector<std::string> all = lines();
  all.resize(kC - 1);
  all[kSymmetry - 1] = std::to_string(symmetry);
  all[kPlanes - 1] = std::to_string(C.size());
  all[kGammas - 1] = "2";
  all[kFlux - 1] = "1000";
  for (const double c : C) all.push_back(std::to_string(c));
  all.insert(all.end(), {"0", "90"});
  for (const double c : stored) all.insert(all.end(), {std::to_string(10 + I(c)), "5"});
  return read(joined(all)).table;
}

TEST(EulumdatFile, ExpandsSymmetries) {
  const std::vector<double> turn{0, 30, 90, 150, 180, 210, 270, 330};
  const auto of_no_plane = [](double C) { return C; };
  const IntensityTable none = read_planes(0, turn, turn, of_no_plane);
  ASSERT_EQ(none.C.size(), turn.size() + 1);
  EXPECT_EQ(none.at(7, 0), 340);
  EXPECT_EQ(none.at(8, 0), 10);
  EXPECT_EQ(none.C.back(), 2 * kPi);

  expect_equal_tables(read_planes(1, turn, {0}, of_no_plane), read_planes(0, {0}, {0}, of_no_plane));

  const auto left_right = [](double C) { return C <= 180 ? C : 360 - C; };
  expect_equal_tables(read_planes(2, turn, {0, 30, 90, 150, 180}, left_right),
                      read_planes(0, turn, turn, left_right));

  // Stored from C270 by C0 to C90.
  const auto front_back = [](double C) { return std::abs(std::remainder(C - 90, 360)); };
  expect_equal_tables(read_planes(3, turn, {270, 330, 0, 30, 90}, front_back),
                      read_planes(0, turn, turn, front_back));

  const auto quarter = [](double C) { return std::abs(std::remainder(C, 180)); };
  expect_equal_tables(read_planes(4, turn, {0, 30, 90}, quarter), read_planes(0, turn, turn, quarter));
}

// The length lies along the lamps, which is C = 90 degrees [mm].
TEST(EulumdatFile, ReadsTheLuminousArea) {
  std::vector<std::string> all = lines();
  all[kLength - 1] = "1200";
  all[kWidth - 1] = "300,5";
  PhotometricFile file = read(joined(all));
  EXPECT_DOUBLE_EQ(file.size.x, 0.3005);
  EXPECT_DOUBLE_EQ(file.size.y, 1.2);
  EXPECT_FALSE(file.round);
  EXPECT_TRUE(file.notes.empty());
  all[kWidth - 1] = "0";
  all[kHeight - 1] = "45";
  file = read(joined(all));
  EXPECT_EQ(file.size, glm::dvec2(1.2));
  EXPECT_TRUE(file.round);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_words(file.notes[0], {"height", "0.045 m", "flat"});
}

TEST(EulumdatFile, TakesTheFirstSetOfLamps) {
  std::vector<std::string> all = lines();
  all[kSets - 1] = "2";
  all.insert(all.begin() + kDirectRatios - 1, {"1", "brighter", "9000", "4000", "80", "90"});
  const PhotometricFile file = read(joined(all));
  expect_equal_tables(file.table, read(joined(lines())).table);
  ASSERT_EQ(file.notes.size(), 1u);
  expect_words(file.notes[0], {"first of 2 sets", "1200 lm"});
}

// Of 120 (1 - gamma / pi), 2 pi times the integral of its product with sin(gamma): 240 pi = 753.98 lm, 62.8 %
// of the lamps' 1200 lm.
TEST(EulumdatFile, NotesAnotherLightOutputRatio) {
  EXPECT_NEAR(flux(read(joined(lines())).table), 240 * kPi, 1e-10);
  EXPECT_TRUE(read(with(kLorl, "62.8")).notes.empty());
  EXPECT_TRUE(read(with(kLorl, "65.5")).notes.empty());
  for (const std::string ratio : {"59.5", "66.5", "100"}) {
    const std::vector<std::string> notes = read(with(kLorl, ratio)).notes;
    ASSERT_EQ(notes.size(), 1u) << ratio;
    expect_words(notes[0], {"753.982 lm", ratio + " % of 1200 lm"});
  }
}

TEST(EulumdatFile, NotesTiltAndTrailingText) {
  const PhotometricFile file = read(with(kTilt, "15") + "\x1A");
  ASSERT_EQ(file.notes.size(), 2u);
  expect_words(file.notes[0], {"tilt of 15 degrees"});
  expect_words(file.notes[1], {"follows the last intensity"});
}

struct BadLine {
  std::size_t line;
  const char* value;
  std::vector<std::string> words;
};

TEST(EulumdatFile, RefusesBadFilesWithTheirLine) {
  for (const BadLine& bad : {
           BadLine{kSymmetry, "5", {"a.ldt:3:", "symmetry 5"}},
           BadLine{kSymmetry, "-1", {"a.ldt:3:", "symmetry: -1"}},
           BadLine{kSymmetry, "", {"a.ldt:3:", "symmetry: the line is empty"}},
           BadLine{kSymmetry, "2", {"a.ldt:", "symmetry 2 of 1 C planes", "divisible by 2"}},
           BadLine{kSymmetry, "4", {"a.ldt:", "divisible by 4"}},
           BadLine{kPlanes, "0", {"a.ldt:4:", "C planes: 0"}},
           BadLine{kPlanes, "1000000000", {"a.ldt:44:", "C angle: 0 follows 0"}},
           BadLine{kPlanes, "1e30", {"a.ldt:4:", "whole number"}},
           BadLine{kGammas, "1", {"a.ldt:6:", "from 2"}},
           BadLine{kGammas, "2.5", {"a.ldt:6:", "2.5"}},
           BadLine{kGammas, "many", {"a.ldt:6:", "'many' is not a number"}},
           BadLine{kGammas, "1000000000", {"a.ldt:47:", "gamma angle: 100 follows 180"}},
           BadLine{kLength, "-3", {"a.ldt:17:", "negative"}},
           BadLine{kLength, "1e9", {"a.ldt:16:", "too large"}},
           BadLine{kFactor, "0", {"a.ldt:24:", "conversion factor of intensities 0"}},
           BadLine{kFactor, "nan", {"a.ldt:24:", "not a finite number"}},
           BadLine{kSets, "0", {"a.ldt:26:", "sets of lamps: 0"}},
           BadLine{kSets, "1000000", {"a.ldt:26:", "too many"}},
           BadLine{kSets, "4", {"a.ldt:49:", "ends before"}},
           BadLine{kFlux, "0", {"a.ldt:29:", "flux of the lamps 0"}},
           BadLine{kFlux, "-1200", {"a.ldt:29:", "-1200"}},
           BadLine{kC, "361", {"a.ldt:43:", "361", "0 to 360"}},
           BadLine{kGamma, "90", {"a.ldt:45:", "gamma angle: 90 follows 90"}},
           BadLine{kGamma, "-1", {"a.ldt:44:", "-1 is not within 0 to 180"}},
           BadLine{kIntensity, "-1", {"a.ldt:47:", "-1 is negative"}},
           BadLine{kIntensity, "inf", {"a.ldt:47:", "not a finite number"}},
           BadLine{kIntensity, "1e16", {"a.ldt:47:", "too large"}},
           BadLine{kIntensity, "", {"a.ldt:49:", "ends before intensity 3 of 3"}},
           BadLine{kIntensity, "1 2", {"a.ldt:49:", "more numbers than it promises"}},
       }) {
    expect_words(error_of(with(bad.line, bad.value)), bad.words);
  }
  std::vector<std::string> all = lines();
  all[kIntensity - 1] = all[kIntensity] = "0";
  expect_words(error_of(joined(all)), {"a.ldt:49:", "no flux"});
  all.resize(kC + 1);
  expect_words(error_of(joined(all)), {"a.ldt:44:", "ends before gamma angle 2 of 3"});
  all.resize(20);
  expect_words(error_of(joined(all)), {"a.ldt:20:", "ends before"});
  expect_words(error_of(""), {"a.ldt", "ends before"});
}

TEST(EulumdatFile, RefusesPlanesThatDoNotFitTheSymmetry) {
  const auto one = [](double) { return 1; };
  const auto error = [&](int symmetry, const std::vector<double>& C) -> std::string {
    try {
      static_cast<void>(read_planes(symmetry, C, {0, 1}, one));
    } catch (const InputError& failure) {
      return failure.what();
    }
    return "no error";
  };
  expect_words(error(2, {0, 170}), {"from C 0 to C 170", "to C 180"});
  expect_words(error(3, {0, 90, 180, 280}), {"from C 280 to C 450", "from C 270"});
  expect_words(error(4, {10, 90, 180, 270}), {"from C 10 to C 90", "from C 0"});
}

}  // namespace
}  // namespace fluxel::eulumdat_file_test
