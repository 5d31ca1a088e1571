#include "reference/onward_ways.hpp"

namespace fluxel {

OnwardWays::OnwardWays(const SideLight& side, const MetPoint& met, const Rgb& weight)
    : side_(side),
      met_(met),
      weight_(weight),
      normal_(met.front ? met.at.normal : -met.at.normal),
      ways_(side, met.front, met.direction, normal_) {
  for (const WayShare& one : ways_.list()) all_ += largest_colour(weight * one.share);
}

Onward OnwardWays::chosen(double number) const {
  double left = number * all_;
  const WayShare* last = nullptr;
  double chance = 0;
  for (const WayShare& one : ways_.list()) {
    const double of_way = largest_colour(weight_ * one.share);
    if (!(of_way > 0)) continue;
    last = &one;
    chance = of_way / all_;
    if (left < of_way) break;
    left -= of_way;
  }
  return by(*last, chance);
}

Onward OnwardWays::by(const WayShare& way, double chance) const {
  Onward onward{.at = met_.at, .weight = weight_ * way.share / chance};
  const auto other_side = [&] { onward.at.normal = -onward.at.normal; };
  if (way.way == Way::diffuse) return onward;
  if (way.way == Way::diffuse_through) {
    other_side();
    return onward;
  }
  const Departure to = straight_departure(way.way, side_.optics, met_.front, met_.direction, normal_);
  onward.is_straight = true;
  onward.direction = to.direction;
  if (!to.same_side) other_side();
  if (way.way == Way::refracted) {
    const double ratio = refraction_ratio(side_.optics.refraction_index, met_.front);
    onward.compression = ratio * ratio;
    onward.weight *= onward.compression;
  }
  return onward;
}

}  // namespace fluxel
