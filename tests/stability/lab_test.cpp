#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "bench/stability/lab.hpp"
#include "tests/stability/world.hpp"

namespace fluxel::lab {
namespace {

class Lab : public testing::TestWithParam<Situation> {};

TEST_P(Lab, AdaptiveMethodsStaySafe) {
  for (const Method& method : methods()) {
    if (method.form_factor.rule != FormFactor::adaptive) continue;
    for (const double value : GetParam().coarse_values) {
      const Measurement found = GetParam().measure(test::world(), method, value);
      EXPECT_TRUE(found.converged) << method.name << " at " << value;
      EXPECT_LE(found.error, GetParam().threshold) << method.name << " at " << value;
    }
  }
}

std::string test_name(const testing::TestParamInfo<Situation>& info) {
  std::string name = info.param.name;
  std::ranges::replace_if(
      name, [](unsigned char letter) { return std::isalnum(letter) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Situations, Lab, testing::ValuesIn(situations()), test_name);

}  // namespace

// GoogleTest says which situation a test is about.
void PrintTo(const Situation& situation, std::ostream* stream) { *stream << situation.title; }

}  // namespace fluxel::lab
