#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/raster.hpp"
#include "hierarchy/hierarchy.hpp"
#include "method/problem.hpp"

namespace fluxel {

/// Pictures of what each round has come to, of every fourth pixel along each axis, by a few filtered rays.
class RoundPreview {
 public:
  /// `points` are those of the raster's pixels, which has `supersample` of them for one of the picture's
  /// along each axis. All must outlive this.
  RoundPreview(const Problem& problem, Hierarchy& hierarchy, const Raster& raster,
               std::span<const GatherPoint> points);

  /// Collective: where --preview or, meanwhile, SIGUSR1 on any rank asks for it, writes the picture, and says
  /// how far it is off, of which `discretisation` is known, if it is.
  void show(std::size_t round, double target, std::optional<double> discretisation);

 private:
  void make(std::size_t round, double target, std::optional<double> discretisation);

  const Problem& problem_;
  Hierarchy& hierarchy_;
  int width_ = 0, height_ = 0;
  std::vector<GatherPoint> points_;
};

}  // namespace fluxel
