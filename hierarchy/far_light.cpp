#include "hierarchy/far_light.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hierarchy/far_light.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <hwy/highway.h>

#include <glm/geometric.hpp>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void add_far_light(const FlatShape& sender, const Rgb& B, double unit, PointGroup& points) {
  const hn::CappedTag<double, 8> d;
  const auto set = [d](double value) { return hn::Set(d, value); };
  const glm::dvec3 elongation = 2.0 * sender.moments.elongation;
  const double variance4 = 4 * sender.moments.minor_variance;
  const auto zero = hn::Zero(d);
  const auto centre_x = set(sender.centroid.x), centre_y = set(sender.centroid.y),
             centre_z = set(sender.centroid.z);
  const auto here_x = set(points.normal.x), here_y = set(points.normal.y), here_z = set(points.normal.z);
  const auto there_x = set(sender.normal.x), there_y = set(sender.normal.y), there_z = set(sender.normal.z);
  const auto long_x = set(elongation.x), long_y = set(elongation.y), long_z = set(elongation.z);
  // As in pair_rule's second order, of a point and a shape.
  const auto constant = set(variance4 - 0.5 * glm::dot(elongation, elongation));
  const auto of_variance = set(variance4), three = set(3.0);
  const auto normals = set(glm::dot(points.normal, sender.normal));
  const auto along_normal = set(glm::dot(elongation, points.normal));
  const auto scale = set(sender.area / std::numbers::pi);
  // What is added to a number of this size is rounded to whole units.
  const auto rounder = set(1.5 * 0x1p52 * unit);
  const auto red = set(B.r), green = set(B.g), blue = set(B.b);
  for (std::size_t k = 0; k < points.count; k += hn::Lanes(d)) {
    const auto x = hn::Sub(centre_x, hn::Load(d, &points.x[k]));
    const auto y = hn::Sub(centre_y, hn::Load(d, &points.y[k]));
    const auto z = hn::Sub(centre_z, hn::Load(d, &points.z[k]));
    const auto with = [&](auto a, auto b, auto c) {
      return hn::Add(hn::Add(hn::Mul(x, a), hn::Mul(y, b)), hn::Mul(z, c));
    };
    const auto inverse = hn::Div(set(1.0), with(x, y, z));
    const auto height = with(here_x, here_y, here_z), other = with(there_x, there_y, there_z);
    const auto along = with(long_x, long_y, long_z), bent = hn::Mul(of_variance, hn::Mul(other, other));
    const auto product = hn::Mul(height, other);
    // What is left of p q (c + 3/r^2 (a^2 - k)) + g k - q a b when the first shape is a point.
    const auto inner =
        hn::Add(constant, hn::Mul(hn::Mul(three, inverse), hn::Sub(hn::Mul(along, along), bent)));
    const auto second = hn::Sub(hn::Add(hn::Mul(product, inner), hn::Mul(normals, bent)),
                                hn::Mul(hn::Mul(other, along), along_normal));
    const auto kernel = hn::Neg(hn::Add(product, hn::Mul(second, inverse)));
    const auto faces = hn::And(hn::Gt(height, zero), hn::Lt(other, zero));
    const auto F =
        hn::IfThenElseZero(faces, hn::Mul(hn::Mul(scale, hn::Max(zero, kernel)), hn::Mul(inverse, inverse)));
    const auto add = [&](double* sum, auto colour) {
      const auto light = hn::Sub(hn::Add(hn::Mul(F, colour), rounder), rounder);
      hn::Store(hn::Add(hn::Load(d, sum), light), d, sum);
    };
    add(&points.red[k], red);
    add(&points.green[k], green);
    add(&points.blue[k], blue);
  }
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(add_far_light);

void add_far_light(const FlatShape& sender, const Rgb& B, double unit, PointGroup& points) {
  HWY_DYNAMIC_DISPATCH(add_far_light)(sender, B, unit, points);
}

}  // namespace fluxel

#endif  // HWY_ONCE
