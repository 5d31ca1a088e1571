#include <string>
#include <utility>

#include "tests/closed_forms/cases.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/closed_forms/shapes.hpp"

namespace fluxel::closed_forms {

namespace {

/// Opposed unit squares with blockers at half height.
Case blocked(std::string id, std::string what, const std::vector<Rectangle>& blockers, double exact) {
  Case made{.id = std::move(id),
            .what = "opposed unit squares, gap 1, at half height " + std::move(what),
            .sender = {horizontal({0, 1, 0, 1}, 0)},
            .receiver = {reversed(horizontal({0, 1, 0, 1}, 1))},
            .blockers = {},
            .exact = exact,
            .occluded = true};
  for (const Rectangle& blocker : blockers) made.blockers.push_back(horizontal(blocker, 0.5));
  return made;
}

Case blocked_centre(std::string id, double side) {
  const std::vector<Rectangle> blocker{centred_blocker(side)};
  return blocked(std::move(id), "a centred square", blocker, opposed_squares_past(blocker));
}

std::vector<Rectangle> slats(int count) {
  std::vector<Rectangle> made;
  for (int i = 0; i < count; ++i) {
    made.push_back({.u_low = double(i) / count, .u_high = (i + 0.5) / count, .v_low = 0, .v_high = 1});
  }
  return made;
}

/// The outer walls x = 0 and y = 0 of a room with two arms 3 long, 1 wide, its inner walls as blockers.
Case l_shape(std::string id, std::string what, double height, double exact) {
  const double arm = 3, width = 1;
  Case made{.id = std::move(id), .what = std::move(what), .sender = {}, .receiver = {}, .blockers = {}};
  made.sender = {{{0, 0, 0}, {0, 0, height}, {arm, 0, height}, {arm, 0, 0}}};
  made.receiver = {facing_x({0, height, 0, arm}, 0)};
  made.blockers = {{{width, width, 0}, {arm, width, 0}, {arm, width, height}, {width, width, height}},
                   {{width, width, 0}, {width, width, height}, {width, arm, height}, {width, arm, 0}}};
  made.exact = exact;
  made.geometry_error = l_room(arm, width, height) / exact - 1;
  made.occluded = true;
  return made;
}

}  // namespace

std::vector<Case> occluded_cases() {
  // Blockers with the symmetry of half the square hide as much as they leave: by reflection in the middle
  // plane.
  const double free = opposed_rectangles(1, 1, 1);
  const Rectangle half{0, 0.5, 0, 1}, quadrant{0, 0.5, 0, 0.5};
  const std::vector<Rectangle> comb = slats(64);
  return {
      blocked("BH", "half the plane", {half}, free / 2),
      blocked("BQ", "a quadrant", {quadrant}, free * 3 / 4),
      blocked_centre("B25", 0.25),
      blocked_centre("B50", 0.5),
      blocked("BS", "64 slats, half open", comb, opposed_squares_past(comb)),
      l_shape("LR", "outer walls of an L-shaped room, arms 3, width 1, height 3", 3, l_room(3, 1, 3)),
      l_shape("2D", "outer walls of an infinite L-shaped corridor, arms 3, width 1, as a room 100 high", 100,
              l_corridor(3, 1)),
  };
}

}  // namespace fluxel::closed_forms
