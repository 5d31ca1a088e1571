#pragma once

#include "solver/cuda/row_view.hpp"

namespace fluxel::cuda {

/// What a rule needs to know of an element, as a device loads it best: in pieces of 16 bytes.
template <Rule rule>
struct alignas(16) ElementOf {
  Float3 centroid;
  float disc;  ///< of Rule::disc alone
  Float3 normal;
};
template <>
struct alignas(16) ElementOf<Rule::moments> {
  Float3 centroid;
  float constant;
  Float3 normal;
  float least_r2;
  Float3 elongation;
  float variance4;
};

template <Rule rule>
FLUXEL_PORTABLE inline ElementOf<rule> element_of(const RowView& view, std::uint32_t tile, std::uint32_t c) {
  const float* number = view.columns + std::size_t{tile} * kColumnLines * kTile + c;
  const auto vector = [number](std::uint32_t line) {
    return Float3{number[line * kTile], number[(line + 1) * kTile], number[(line + 2) * kTile]};
  };
  ElementOf<rule> element{};
  element.centroid = vector(kCentroidLine);
  element.normal = vector(kNormalLine);
  if constexpr (rule == Rule::disc) element.disc = number[kDiscLine * kTile];
  if constexpr (rule == Rule::moments) {
    element.elongation = vector(kElongationLine);
    element.variance4 = number[kVarianceLine * kTile];
    element.constant = number[kConstantLine * kTile];
    element.least_r2 = number[kMinR2Line * kTile];
  }
  return element;
}

/// A pair as the centroids see it: the way from row to column, its square, and the heights over both planes.
struct Pair {
  Float3 separation;
  float distance2;
  float row_height;     ///< > 0: the column is in front of the row
  float column_height;  ///< < 0: the row is in front of the column
};

template <class Element>
FLUXEL_PORTABLE inline Pair pair_of(const Element& row, const Element& column) {
  const Float3 separation = column.centroid - row.centroid;
  return {separation, fused_dot(separation, separation), fused_dot(row.normal, separation),
          fused_dot(column.normal, separation)};
}

/// An element's part of the second-order term.
FLUXEL_PORTABLE inline float moments_part(const ElementOf<Rule::moments>& of,
                                          const ElementOf<Rule::moments>& other, const Float3& separation,
                                          float height, float other_height, float w, float h) {
  const float along = fused_dot(of.elongation, separation);
  const float turned = std::fma(-(w * other_height), along, fused_dot(of.elongation, other.normal));
  return height * std::fma(-along, turned, of.variance4 * height * h);
}

/// pi F_ij / A_j by the moments, step by step as solver/pair_kernel has it, where the names are explained.
FLUXEL_PORTABLE inline float moments_factor(const ElementOf<Rule::moments>& row,
                                            const ElementOf<Rule::moments>& column, const Pair& pair) {
  const float p = pair.row_height, q = pair.column_height, product = p * q;
  const float inverse_r2 = 1.0f / std::fmax(pair.distance2, row.least_r2 + column.least_r2);
  const float w = 3.0f * inverse_r2;
  const float h = std::fma(-w, product, fused_dot(row.normal, column.normal));
  const float parts = moments_part(row, column, pair.separation, p, q, w, h) +
                      moments_part(column, row, pair.separation, q, p, w, h);
  const float second_order = std::fma(product, row.constant + column.constant, parts);
  const float bracket = std::fma(second_order, inverse_r2, product);
  return std::fmax(std::signbit(product) ? -bracket : bracket, 0.0f) * (inverse_r2 * inverse_r2);
}

/// pi F_ij / A_j. Divisions are exact ones, as on the CPU, because approximate reciprocals differ between
/// generations of devices; 1 / x takes a device less than y / x.
template <Rule rule, class Element>
FLUXEL_PORTABLE inline float pair_factor(const Element& row, const Element& column, const Pair& pair) {
  if constexpr (rule == Rule::moments) {
    return moments_factor(row, column, pair);
  } else {
    const float heights = std::fabs(pair.row_height * pair.column_height);
    float bounded = pair.distance2;
    if constexpr (rule == Rule::disc) bounded += std::fmax(row.disc, column.disc);
    return heights * (1.0f / (pair.distance2 * bounded));
  }
}

}  // namespace fluxel::cuda
