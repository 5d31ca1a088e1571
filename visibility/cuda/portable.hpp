#pragma once

// What host and device share is C++17 without libraries: nvcc compiles it for the device, any compiler for
// the host, and both must round alike. Products and sums are rounded each for itself (-ffp-contract=off and
// -fmad=false); where one rounding is wanted std::fma says so.

#include <cmath>
#include <cstdint>

#include "core/portable.hpp"

namespace fluxel::cuda {

template <class T>
struct Vector {
  T x, y, z;
};

using Float3 = Vector<float>;
using Double3 = Vector<double>;

template <class T>
FLUXEL_PORTABLE inline Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class T>
FLUXEL_PORTABLE inline Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class T>
FLUXEL_PORTABLE inline Vector<T> operator*(T a, const Vector<T>& b) {
  return {a * b.x, a * b.y, a * b.z};
}

template <class T>
FLUXEL_PORTABLE inline T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// With the roundings of visibility/facing and of solver/pair_kernel.
FLUXEL_PORTABLE inline float fused_dot(const Float3& a, const Float3& b) {
  return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z));
}

template <class T>
FLUXEL_PORTABLE inline Vector<T> cross(const Vector<T>& a, const Vector<T>& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

template <class T>
FLUXEL_PORTABLE inline T length(const Vector<T>& a) {
  return std::sqrt(dot(a, a));
}

template <class T>
FLUXEL_PORTABLE inline Vector<T> normalize(const Vector<T>& a) {
  return (1 / std::sqrt(dot(a, a))) * a;
}

FLUXEL_PORTABLE inline Double3 widen(const Float3& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

FLUXEL_PORTABLE inline Float3 narrow(const Double3& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

template <class T>
FLUXEL_PORTABLE inline T lesser(T a, T b) {
  return b < a ? b : a;
}

template <class T>
FLUXEL_PORTABLE inline T greater(T a, T b) {
  return a < b ? b : a;
}

}  // namespace fluxel::cuda
