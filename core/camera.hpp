#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>

namespace fluxel {

/// A pinhole camera in world coordinates.
struct Camera {
  glm::dvec3 eye{0, 0, 0};
  glm::dvec3 look_at{0, 0, -1};
  glm::dvec3 up{0, 1, 0};
  double fov = 45;  ///< vertical, full angle [degrees]
  int width = 256;  ///< [pixels]
  int height = 256;
  std::string name{};  ///< in the scene file; empty: none
};

/// Maps pixels to directions; row 0 is the top of the picture.
class PixelRays {
 public:
  /// `supersample` splits each pixel into that many rows and columns, each with a ray of its own.
  explicit PixelRays(const Camera& camera, int supersample = 1)
      : width_(camera.width * supersample), height_(camera.height * supersample) {
    const double half_height = std::tan(camera.fov * 0.5 * 3.14159265358979323846 / 180.0);
    const double half_width = half_height * camera.width / camera.height;
    forward_ = glm::normalize(camera.look_at - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward_, camera.up));
    right_ = right * half_width;
    up_ = glm::cross(right, forward_) * half_height;
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

  /// The direction through the centre of pixel (column, row), not normalised: its component along the view
  /// axis is 1, so that a ray's parameter is the depth [m].
  [[nodiscard]] glm::dvec3 direction(int column, int row) const { return towards(column + 0.5, row + 0.5); }

  /// The same through any point of the picture [pixels], from its upper left corner.
  [[nodiscard]] glm::dvec3 towards(double across, double down) const {
    const double x = 2.0 * across / width_ - 1.0;
    const double y = 1.0 - 2.0 * down / height_;
    return forward_ + x * right_ + y * up_;
  }

 private:
  int width_, height_;
  glm::dvec3 forward_{}, right_{}, up_{};
};

}  // namespace fluxel
