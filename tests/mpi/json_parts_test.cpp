#include "output/json_parts.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fluxel::json_parts_test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(JsonParts, WhatIsUnknownIsLeftOut) {
  const Json json{{"none", nullptr},
                  {"infinite", kInfinite},
                  {"pair", {1, kInfinite}},
                  {"bounds", {{1, 2}, {3, nullptr}}},
                  {"zero", 0.0},
                  {"text", ""},
                  {"empty", Json::array()},
                  {"rows", Json::array({{{"a", nullptr}, {"b", 1}}, Json::object()})},
                  {"part", {{"c", -kInfinite}}}};
  const Json known{{"zero", 0.0},
                   {"text", ""},
                   {"empty", Json::array()},
                   {"rows", Json::array({{{"b", 1}}, Json::object()})},
                   {"part", Json::object()}};
  EXPECT_EQ(without_unknown(json).dump(), known.dump());
}

}  // namespace
}  // namespace fluxel::json_parts_test
